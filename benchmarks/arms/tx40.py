"""Staubli TX40: its log, its couplings, and its published friction."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from arms.classical import Array, Source, joint_sources

JOINTS = 6
GEAR_RATIOS = (32.0, 32.0, 45.0, -48.0, 45.0, 32.0)
# Motor 6 turns with joints 5 and 6.
COUPLINGS = np.diag(GEAR_RATIOS)
COUPLINGS[5, 4] = 32.0
# Zero of the log in angles of the URDF [rad]: the log begins with the arm upright.
ZEROS = (0.0, -np.pi / 2.0, np.pi / 2.0, 0.0, 0.0, 0.0)
MOVING = (0.02, 7.5)  # [s]; then it stands still
# The authors left out slower samples [rad/s].
LEAST = (0.05, 0.05, 0.075, 0.072, 0.056, 0.122)
MOTOR_6 = "motor 6"

# At the joints [N·m·s/rad], [N·m]. The authors' viscous friction of joints 5 and 6 includes motor 6's.
VISCOUS = {"1": 8.05, "2": 5.53, "3": 1.97, "4": 1.11, "5": 1.86, "6": 0.65, MOTOR_6: 0.616}
COULOMB = {"1": 7.14, "2": 8.26, "3": 6.34, "4": 2.48, "5": 3.03, "6": 0.282, MOTOR_6: 1.95}


def sources() -> list[Source]:
    """Return the friction of the six joints, and of motor 6 at the speed of joints 5 and 6 together."""
    wrist = Source(name=MOTOR_6, speed=(0.0, 0.0, 0.0, 0.0, 1.0, 1.0), least=0.1)
    return [*joint_sources(JOINTS, LEAST), wrist]


def log(folder: Path) -> tuple[Array, Array, Array]:
    """Return time, positions in the URDF's angles, torques at the joints, and the raw log at the motors."""
    raw = np.loadtxt(folder / "tx40.csv.gz", delimiter=",", skiprows=1)
    position = np.linalg.solve(COUPLINGS, raw[:, 1:7].T).T + np.array(ZEROS)
    return raw[:, 0], position, raw[:, 7:13] @ COUPLINGS


def urdf(folder: Path) -> Any:
    """Return the arm as pinocchio reads it."""
    import pinocchio

    return pinocchio.buildModelFromUrdf(str(folder / "tx40.urdf"))


def as_published(values: dict[str, float]) -> dict[str, float]:
    """Return viscous friction of joints 5 and 6 with motor 6's, by name ``"viscous 5"``."""
    shown = dict(values)
    for joint in ("5", "6"):
        shown[f"viscous {joint}"] += values[f"viscous {MOTOR_6}"]
    return shown
