"""Draw the picture of README.md from the recordings that ship with the package, and keep its numbers."""

import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib import pyplot

import jointid as jid
from jointid.plot import style

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "pictures"
SIMULATED = ROOT / "examples" / "data" / "well_excited.csv.gz"


def estimates() -> dict[str, jid.Estimate]:
    """Return the drawn estimates by the titles of their maps."""
    kuka = jid.demo()
    return {
        "KUKA KR300, joint 1 (measured)": jid.identify(kuka.recording, kuka.joint),
        "strain-wave joint (simulated)": jid.identify(jid.load(SIMULATED), jid.thesis_joint()),
    }


def numbers(estimate: jid.Estimate) -> list[list[float]]:
    """Return velocity and identified friction at five speeds of each direction, four digits each."""
    fastest = float(np.abs(estimate.windows.velocity).max())
    velocity = np.concatenate([-np.linspace(1.0, 0.2, 5), np.linspace(0.2, 1.0, 5)]) * fastest
    friction = estimate.friction(velocity).torque
    return [[float(f"{each:.4g}") for each in row] for row in (velocity, friction)]


def main() -> None:
    """Draw the maps, and write the drawn numbers."""
    found = estimates()
    with style():
        figure, axes = pyplot.subplots(1, len(found), figsize=(9.0, 3.6))
        for ax, (title, estimate) in zip(axes, found.items(), strict=True):
            jid.plot.friction_map(None, estimate, ax).set_title(title)
        figure.savefig(FOLDER / "friction_maps.png", dpi=130, metadata={"Software": None})
    drawn = {title: numbers(estimate) for title, estimate in found.items()}
    (FOLDER / "friction_maps.json").write_text(json.dumps(drawn, indent=1) + "\n", "utf-8")


if __name__ == "__main__":
    main()
