"""Demonstration: joint 1 of a KUKA KR300, from a log that ships with the package."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from jointid.base.values import dataclass
from jointid.joint.joint import Joint
from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording

# Published with the log by its authors (Weigand et al.).
PUBLISHED = {"viscous": 2050.0, "coulomb": 355.0}
# Known signals of the log, from the authors' model of the whole robot. Gravity does not act on a vertical axis.
COLUMNS = {"coriolis": "model_coriolis_torque_Nm", "pose": "model_inertia_kgm2"}
TERMS = {"coriolis": "known", "pose": "inertia"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Demonstration:
    """Data of `jointid demo`.

    Attributes
    ----------
    recording : Recording
        Recording of joint 1 of a KUKA KR300. It includes the Coriolis torque and the inertia at each pose, from the
        authors' model.
    joint : Joint
        Joint with its known values and its model.
    published : mapping of str to float
        Parameter values that the authors of the log published (SI units).

    Examples
    --------
    >>> jid.demo().joint.name
    'KUKA KR300 R2500, joint 1'
    """

    recording: Recording
    joint: Joint
    published: Mapping[str, float]


def data_folder() -> Path:
    """Return the folder with the demonstration's recordings and joint files."""
    installed = Path(__file__).resolve().parents[1] / "data"
    if installed.is_dir():
        return installed
    return Path(__file__).resolve().parents[3] / "examples" / "data"  # run from the source folder


def demo() -> Demonstration:
    """Return the recording and the joint of ``jointid demo``.

    Returns
    -------
    Demonstration

    Examples
    --------
    >>> kuka = jid.demo()
    >>> estimate = jid.identify(kuka.recording, kuka.joint)
    >>> round(estimate["coulomb"].value), round(kuka.published["coulomb"])
    (366, 355)
    """
    recording = load(log_file(), extra=COLUMNS)
    return Demonstration(recording=recording, joint=known_joint(), published=dict(PUBLISHED))


def log_file() -> Path:
    """Return the path of the demonstration's log."""
    return data_folder() / "kr300_joint1.csv.gz"


def known_joint() -> Joint:
    """Return the known values of the demonstration's joint, and its model."""
    joint = Joint.load(data_folder() / "kr300_joint1.toml")
    return joint.replace(model=joint.model.replace(terms=TERMS))
