"""The demonstration: identify joint 1 of a KUKA KR300 from its log, which ships with the package."""

from pathlib import Path

from jointid.base.values import dataclass
from jointid.estimate.estimate import Estimate
from jointid.identification.identification import identify
from jointid.joint.joint import Joint
from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording

# Published beside the log by its authors (Weigand et al.).
NOMINAL = {"viscous": 2050.0, "coulomb": 355.0}
# Known signals of the log, from the authors' model of the whole robot. Gravity does not act on a vertical axis.
COLUMNS = {"coriolis": "model_coriolis_torque_Nm", "pose": "model_inertia_kgm2"}
TERMS = {"coriolis": "known", "pose": "inertia"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Demonstration:
    """Result of the demonstration: the estimate, its recording, and the values published by the authors."""

    estimate: Estimate
    recording: Recording
    nominal: dict[str, float]


def data_folder() -> Path:
    """Folder with the demonstration's recordings and joint files."""
    installed = Path(__file__).resolve().parents[1] / "data"
    if installed.is_dir():
        return installed
    return Path(__file__).resolve().parents[3] / "examples" / "data"  # run from the source folder


def demonstrate() -> Demonstration:
    """Identify the robot's joint 1, with the inertia over its pose and the Coriolis torque of its authors' model."""
    folder = data_folder()
    recording = load(folder / "kr300_joint1.csv.gz", extra=COLUMNS)
    joint = Joint.load(folder / "kr300_joint1.toml")
    estimate = identify(recording, joint, terms=TERMS)
    return Demonstration(estimate=estimate, recording=recording, nominal=dict(NOMINAL))
