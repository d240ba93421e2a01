"""An arm of seven joints, simulated by pinocchio's dynamics and a friction of our own; nothing of the package's core.

`random_arm` draws friction, rotors and couplings, `random_motion` a motion with many reversals, `run` lets a
controller follow it, and `recorded` is what sensors and a host make of that: a `jid.RobotRecording`.
"""

from simulated_arm.arm import JOINTS, URDF, Arm, Source, random_arm
from simulated_arm.motion import Motion, random_motion
from simulated_arm.running import Run, run
from simulated_arm.sensors import Sensors, recorded

__all__ = [
    "JOINTS",
    "URDF",
    "Arm",
    "Motion",
    "Run",
    "Sensors",
    "Source",
    "random_arm",
    "random_motion",
    "recorded",
    "run",
]
