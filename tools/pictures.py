"""Draw the pictures that README.md shows, from the recordings that ship with the package."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot

import jointid as jid
from jointid.plot import style

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "pictures"
SIMULATED = ROOT / "examples" / "data" / "well_excited.csv.gz"


def main() -> None:
    """Draw and save them."""
    kuka = jid.demo()
    robot = jid.identify(kuka.recording, kuka.joint)
    simulated = jid.identify(jid.load(SIMULATED), jid.thesis_joint())
    with style():
        figure, (left, right) = pyplot.subplots(1, 2, figsize=(9.0, 3.6))
        jid.plot.friction_map(None, robot, left).set_title("KUKA KR300, joint 1 (measured)")
        jid.plot.friction_map(None, simulated, right).set_title("strain-wave joint (simulated)")
        figure.savefig(FOLDER / "friction_maps.png", dpi=130, metadata={"Software": None})


if __name__ == "__main__":
    main()
