"""The fields of a design, and the used share of its limits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from jointid import _core
from jointid.excitation.expected_error import ExpectedError
from jointid.excitation.motion_limits import MotionLimits
from jointid.joint.joint import Joint
from jointid.simulation.arguments import Controller
from jointid.simulation.peaks import Peaks
from jointid.simulation.trajectory import Trajectory

COMPLETE = "complete"
CRITERIA = ("worst", "determinant")


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignFields:
    """The fields of a `Design`."""

    status: str
    trajectory: Trajectory
    joint: Joint
    controller: Controller
    sensors: _core.Sensors
    limits: MotionLimits
    peaks: Peaks
    parameters: Mapping[str, ExpectedError]
    criterion: str
    joints: int
    evaluations: int
    seed: int
    duration: float
    weakest: str
    limited_by: str
    reference: Mapping[str, float] = field(default_factory=dict)
    believed: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    control_period: float = 1e-3
    reason: str = ""

    @property
    def shares(self) -> dict[str, float]:
        """Used share of each limit, by the limit's name; 1 means a reached limit."""
        limits, peaks = self.limits, self.peaks
        low, high = limits.position
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        used = {
            "position": max(abs(peaks.position[0] - middle), abs(peaks.position[1] - middle)) / half
        }
        for name, reached in (
            ("velocity", peaks.velocity),
            ("acceleration", peaks.acceleration),
            ("torque", peaks.torque),
            ("sensor_range", peaks.sensor_torque),
        ):
            allowed = getattr(limits, name)
            if allowed is not None and reached is not None:
                used[name] = reached / allowed
        return used
