"""What a session must not exceed, and the stop that follows when it does."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from jointid.errors import InputError
from jointid.joint.joint import Joint


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionLimits:
    """Limits of a session; each is a stop with a name.

    Attributes
    ----------
    position : tuple of float
        Lowest and highest output angle [rad].
    velocity : float
        [rad/s]
    torque : float
        Commanded, at the output [N·m].
    torque_rate : float
        Of the command from one cycle to the next [N·m/s].
    tracking_error : float
        [rad]
    saturated_samples : int
        Cycles in which the torque limit cut the command, in all; the thesis stops beyond 20.
    missed_deadlines : int
        Cycles in a row that ended after the next had to begin.
    clipped_samples : int
        Readings in a row at the end of the sensor's range.
    """

    position: tuple[float, float] = (-math.pi, math.pi)
    velocity: float = 10.0
    torque: float = math.inf
    torque_rate: float = math.inf
    tracking_error: float = math.inf
    saturated_samples: int = 20
    missed_deadlines: int = 5
    clipped_samples: int = 5

    def __post_init__(self) -> None:
        low, high = self.position
        if not (math.isfinite(low) and math.isfinite(high) and low < high):
            raise InputError(
                f"SessionLimits: position is {self.position!r}; a lowest and a highest angle are expected"
            )
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name != "position" and not value > 0:
                raise InputError(
                    f"SessionLimits: {field.name} is {value!r}; more than 0 is expected"
                )

    @classmethod
    def of(cls, joint: Joint, **changes: float | tuple[float, float]) -> SessionLimits:
        """What a joint's own limits give, and some changes."""
        known = joint.limits
        values: dict[str, object] = {}
        if known.position is not None:
            values["position"] = known.position
        if known.velocity is not None:
            values["velocity"] = known.velocity
        if known.torque is not None:
            values["torque"] = known.torque
        elif known.current is not None and joint.torque_constant is not None:
            values["torque"] = known.current * joint.torque_constant * abs(joint.gear_ratio)
        return cls(**(values | changes))  # type: ignore[arg-type]


@dataclass(frozen=True, slots=True, kw_only=True)
class Stop:
    """Why a session ended before its time.

    Attributes
    ----------
    limit : str
        Its name: a field of SessionLimits, or "stale_position", "drive_fault", "emergency",
        "heartbeat_lost", "bus", "user", "error".
    phase : str
        "check", "enable", "move", "settle" or "run".
    time : float
        Since the phase began [s].
    message : str
        What happened, by how much.
    """

    limit: str
    phase: str
    time: float
    message: str

    def __str__(self) -> str:
        return f"stopped by {self.limit} after {self.time:.3f} s of {self.phase}: {self.message}"


class LimitError(RuntimeError):
    """A limit was passed.

    Parameters
    ----------
    limit, message : str
    """

    def __init__(self, limit: str, message: str) -> None:
        super().__init__(message)
        self.limit = limit


class Guard:
    """Holds what a session measures and commands against its limits.

    Parameters
    ----------
    limits : SessionLimits
    period : float
        [s]
    """

    def __init__(self, limits: SessionLimits, period: float) -> None:
        self._limits, self._period = limits, period
        self._last: float | None = None
        self._missed = self._clipped = 0

    def measured(
        self, position: float, velocity: float, error: float | None, *, clipped: bool
    ) -> None:
        """Look at what was measured.

        Raises
        ------
        LimitError
        """
        limits = self._limits
        low, high = limits.position
        if not low <= position <= high:
            raise LimitError("position", f"{position:.4f} rad, outside {low:.4f} to {high:.4f} rad")
        if not abs(velocity) <= limits.velocity:
            raise LimitError(
                "velocity", f"{velocity:.3f} rad/s, more than {limits.velocity:g} rad/s"
            )
        if error is not None and not abs(error) <= limits.tracking_error:
            raise LimitError(
                "tracking_error", f"{error:.4f} rad, more than {limits.tracking_error:g} rad"
            )
        self._clipped = self._clipped + 1 if clipped else 0
        if self._clipped > limits.clipped_samples:
            raise LimitError(
                "clipped_samples",
                f"the torque sensor is at the end of its range for {self._clipped} samples",
            )

    def commanded(self, torque: float, saturations: int) -> None:
        """Look at what is to be commanded.

        Raises
        ------
        LimitError
        """
        limits = self._limits
        if not math.isfinite(torque):
            raise LimitError("torque", f"the controller asks for {torque}, which is no number")
        if abs(torque) > limits.torque * (1.0 + 1e-9):
            raise LimitError("torque", f"{torque:.2f} N·m, more than {limits.torque:g} N·m")
        if self._last is not None:
            rate = abs(torque - self._last) / self._period
            if rate > limits.torque_rate:
                raise LimitError(
                    "torque_rate", f"{rate:.0f} N·m/s, more than {limits.torque_rate:g} N·m/s"
                )
        self._last = torque
        if saturations > limits.saturated_samples:
            raise LimitError(
                "saturated_samples",
                f"the torque limit cut the command {saturations} times, more than "
                f"{limits.saturated_samples}",
            )

    def timed(self, late: float) -> None:
        """Look at how late a cycle ended against the next one's begin [s]; negative: in time.

        Raises
        ------
        LimitError
        """
        self._missed = self._missed + 1 if late > 0.0 else 0
        if self._missed > self._limits.missed_deadlines:
            raise LimitError(
                "missed_deadlines",
                f"{self._missed} cycles in a row were not done in time, the last one by {1e3 * late:.2f} ms",
            )
