"""Limits of a session."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields

from jointid.base.errors import InputError
from jointid.joint.checks import is_number
from jointid.joint.joint import Joint
from jointid.simulation.peaks import Peaks
from jointid.simulation.plant import torque_limit

_MEASURED_TORQUE, _TORQUE_DIFFERENCE = 1.2, 0.25  # share of the commanded limit
_WATCHDOG_SHARE, _LEAST_SHARE = 0.1, math.radians(2.0)  # share of the range; its minimum
_WITHOUT_WINDOW = math.radians(10.0)
_NO_WINDOW = (-math.pi, math.pi)
_ROUNDED = 1e-9  # relative; a torque that was cut at the limit may exceed it by rounding


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionLimits:
    """Limits of a session. A stop has the name of the limit that was exceeded.

    Attributes
    ----------
    position : tuple of float
        Lowest and highest output angle [rad]. Default ±π.
    velocity : float
        Largest speed, estimated from positions or measured by the drive [rad/s].
    torque : float
        Largest commanded torque at the output [N·m]. Default: no limit.
    torque_rate : float
        Largest change of the command from one cycle to the next [N·m/s]. Default: no limit.
    tracking_error : float
        Largest difference between reference and position [rad].
    measured_torque : float, optional
        Largest torque of the active motor current [N·m], if the drive reports this current. Default: 1.2 times
        `torque`.
    torque_difference : float, optional
        Largest difference between commanded and measured torque, averaged over ten samples [N·m].
        Default: a quarter of `torque`.
    saturated_samples : int
        Allowed total number of cycles in which the torque limit cuts the command.
    missed_deadlines : int
        Allowed number of successive cycles that end after the start of the next cycle.
    repeated_positions : int
        Allowed number of successive cycles with the same position after a motion or after a change of the torque.
        More such cycles show a frozen encoder or a blocked joint. The change of the torque must exceed `torque` and
        four times the joint file's breakaway torque. A change of 1.98 times `torque` is always enough.
    clipped_samples : int
        Allowed number of successive torque readings at the end of the sensor's range.
    late_samples : int
        Allowed number of successive cycles without a sample in time. In these cycles the last torque is held. The
        recording marks them (`Recording.late`).
    late_share : float
        Allowed share of cycles without a sample in time, in the last 5 s. Up to `late_samples` such cycles are always
        allowed.
    torque_envelope : float, optional
        Largest torque command that may last longer than 50 ms. The value is a multiple of the torque that the
        reference needs for the joint's friction, inertia and weight. A twentieth of `torque` is added to the limit.
        Default: off. `commission` uses 2 for runs with an identified joint.
    watchdog_travel : float, optional
        Largest travel [rad] from a failure of the program until the joint is at rest. Default: the travel if the
        motor goes off at once, plus `watchdog_share`.

    Raises
    ------
    InputError
        A value has the wrong type or is not above 0, or the position range is empty.
    """

    position: tuple[float, float] = _NO_WINDOW
    velocity: float = 10.0
    torque: float = math.inf
    torque_rate: float = math.inf
    tracking_error: float = 0.5
    measured_torque: float | None = None
    torque_difference: float | None = None
    saturated_samples: int = 20
    missed_deadlines: int = 5
    repeated_positions: int = 10
    clipped_samples: int = 5
    late_samples: int = 4
    late_share: float = 0.01
    torque_envelope: float | None = None
    watchdog_travel: float | None = None

    def __post_init__(self) -> None:
        window = tuple(self.position) if isinstance(self.position, Iterable) else ()
        finite = all(is_number(angle) and math.isfinite(angle) for angle in window)
        if not (len(window) == 2 and finite and window[0] < window[1]):
            raise InputError(
                "a lowest and a highest angle are expected",
                argument="position",
                value=self.position,
            )
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name == "position" or (value is None and field.default is None):
                continue
            if not is_number(value):
                raise InputError("a number is expected", argument=field.name, value=value)
            if not value > 0:
                raise InputError("more than 0 is expected", argument=field.name, value=value)

    @property
    def largest_measured(self) -> float:
        """Largest torque that may be measured [N·m]."""
        given = self.measured_torque
        return _MEASURED_TORQUE * self.torque if given is None else given

    @property
    def largest_difference(self) -> float:
        """Largest lasting difference between commanded and measured torque [N·m]."""
        given = self.torque_difference
        return _TORQUE_DIFFERENCE * self.torque if given is None else given

    @property
    def watchdog_share(self) -> float:
        """Default travel that the delay of the drive's watchdog may add [rad].

        This is a tenth of the position range, but at least 2°. Without a position range, this travel is 10°.
        """
        low, high = self.position
        if (low, high) == _NO_WINDOW:
            return _WITHOUT_WINDOW
        return max(_WATCHDOG_SHARE * (high - low), _LEAST_SHARE)

    def passed_by(self, peaks: Peaks) -> str:
        """Return a text on the limits of position, velocity and torque that a motion exceeds; empty if there are none.

        Parameters
        ----------
        peaks : Peaks
        """
        (low, high), (lowest, highest) = self.position, peaks.position
        sides = {
            "velocity": (peaks.velocity, self.velocity, "rad/s"),
            "torque": (peaks.torque, self.torque, "N·m"),
        }
        found = []
        if lowest < low or highest > high:
            found.append(
                f"from {lowest:.4f} to {highest:.4f} rad, outside the session's {low:.4f} to {high:.4f} rad"
            )
        found += [
            f"up to {reached:.4g} {unit}, more than the session's {name} of {allowed:.4g} {unit}"
            for name, (reached, allowed, unit) in sides.items()
            if reached > allowed * (1.0 + _ROUNDED)
        ]
        return ", and ".join(found)

    @classmethod
    def of(cls, joint: Joint, **changes: float | tuple[float, float] | None) -> SessionLimits:
        """Return a joint's limits with some changes.

        The torque limit is the joint's torque limit, or the torque at its current limit if this torque is smaller.
        """
        known = joint.limits
        values: dict[str, object] = {}
        if known.position is not None:
            values["position"] = known.position
        if known.velocity is not None:
            values["velocity"] = known.velocity
        torque = torque_limit(joint)
        if torque is not None:
            values["torque"] = torque
        return cls(**(values | changes))  # type: ignore[arg-type]
