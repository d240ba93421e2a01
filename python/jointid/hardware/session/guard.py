"""Checks of a session's measurements and commands against its limits, cycle by cycle."""

from __future__ import annotations

import math
from collections import deque

from jointid.hardware.session.drive import DriveSample
from jointid.hardware.session.foresight import Foresight
from jointid.hardware.session.lateness import Lateness
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.stop import LimitError

# Number of samples in the mean difference, because a drive is one or two cycles behind its command.
_COMPARED = 10
# A drive with a mantissa of four bits rounds a command by up to an eighth. A smaller value was limited.
_WHOLE = 0.875 - 1e-9
_ROUNDING = 1e-6  # relative, of a 32-bit float
# Encoder counts in a cycle. From this speed no friction stops a joint within the next cycle.
_MOVING = 20
# At a reversal the torque changes by twice the breakaway torque at rest. The stated value may be wrong by 2.
_BELIEVED = 2.0
# Multiple of the torque limit. A joint at rest during a larger change has no torque left to move it.
_NEARLY_ALL = 1.98

_WHY_CUT = (
    "likely: a torque limit or PL[1] of the drive that is too small for this motion; a wrong torque_constant or "
    "gear_ratio; a closed brake, a blocked joint, or an encoder that hangs"
)
_WHY_FAST = (
    "; likely: a jump of the command after late or lost cycles; [session.limits] torque_rate too small for the "
    "step of the friction compensation at a reversal; gains too high for the encoder's resolution"
)
_WHY_STANDING = (
    "; the joint file states no friction ([parameters] coulomb, static): if the breakaway torque is more than half "
    "the torque limit, a joint without a fault also rests this long at a slow reversal"
)


class Guard:
    """Checks of a session's measurements and commands against its limits.

    Parameters
    ----------
    limits : SessionLimits
    period : float
        Period of the cycles [s].
    resolution : float
        Output angle of an encoder count [rad].
    foresight : Foresight, optional
        Checks that need the joint's values. Default: none.
    breakaway : float, optional
        Expected breakaway torque of the joint [N·m]. Default: not known.
    doubt_of_gains : str
        Warning about the controller's gains at this period. Default: none.

    Attributes
    ----------
    lateness : Lateness
        Counter of the cycles without a sample.
    """

    def __init__(
        self,
        limits: SessionLimits,
        period: float,
        resolution: float,
        foresight: Foresight | None = None,
        breakaway: float | None = None,
        doubt_of_gains: str = "",
    ) -> None:
        self._foresight, self._doubt_of_gains = foresight, doubt_of_gains
        self._limits, self._period = limits, period
        self.lateness = Lateness(limits, period)
        self._largest_measured = limits.largest_measured
        self._largest_difference = limits.largest_difference
        self._moving = _MOVING * resolution / period
        self._friction_known = breakaway is not None
        swing = min(2.0 * _BELIEVED * (breakaway or 0.0), _NEARLY_ALL * limits.torque)
        self._largest_swing = max(limits.torque, swing)
        self._last = 0.0  # command of the controller; enabling commands zero
        self._cut = 0  # number of commands that the drive accepted only in part
        self._accepted = 0.0  # torque accepted by the drive
        self._differences: deque[float] = deque((0.0,) * _COMPARED, maxlen=_COMPARED)
        self._difference = 0.0  # their sum
        self._missed = self._clipped = self._repeated = 0
        self._place = math.nan
        self._speed_there = self._accepted_there = 0.0

    def measured(self, sample: DriveSample, velocity: float, error: float | None) -> None:
        """Check a sample.

        Parameters
        ----------
        sample : DriveSample
        velocity : float
            Estimated or measured velocity; the larger of the two [rad/s].
        error : float or None
            Position minus reference [rad]; None without feedback.

        Raises
        ------
        LimitError
        """
        limits = self._limits
        low, high = limits.position
        position = sample.position
        if not low <= position <= high:
            raise LimitError(
                "position",
                f"{position:.4f} rad, outside {low:.4f} to {high:.4f} rad",
                measured=position,
                allowed=low if position < low else high,
            )
        _hold("velocity", velocity, limits.velocity, "rad/s")
        if error is not None:
            _hold("tracking_error", error, limits.tracking_error, "rad")
        if self._foresight is not None:
            self._foresight.driven(position, velocity, self._accepted)
            self._foresight.moving(position, velocity, self._accepted)
        self._read(sample)
        self._repeats(position, velocity)
        if not math.isnan(sample.torque):
            self._felt(sample.torque)

    def unseen(self, age: float) -> None:
        """Check a cycle without a sample. `age` is the time since the last sample [s].

        Raises
        ------
        LimitError
        """
        if self._foresight is not None:
            self._foresight.unseen(age, self._accepted)

    def commanded(
        self,
        torque: float,
        saturations: int,
        wanted: tuple[float, float, float] | None = None,
    ) -> None:
        """Check the torque that the controller requests [N·m] before it is commanded.

        Parameters
        ----------
        torque : float
        saturations : int
            Total number of saturations in the controller.
        wanted : tuple of float, optional
            Position, velocity and acceleration of the reference. Default: no reference.

        Raises
        ------
        LimitError
        """
        limits = self._limits
        if not math.isfinite(torque):
            raise LimitError("torque", f"the controller requests {torque}, which is not finite")
        # The controller limits its torque itself; a rounding error is no violation.
        if abs(torque) > limits.torque * (1.0 + 1e-9):
            _hold("torque", torque, limits.torque, "N·m")
        rate = (torque - self._last) / self._period
        _hold("torque_rate", rate, limits.torque_rate, "N·m/s", _WHY_FAST)
        self._last = torque
        cut = saturations + self._cut
        if cut > limits.saturated_samples:
            why = self._doubt_of_gains or _WHY_CUT
            raise LimitError(
                "saturated_samples",
                f"the torque limit cut the command {cut} times, more than {limits.saturated_samples}; {why}",
                measured=cut,
                allowed=limits.saturated_samples,
            )
        if self._foresight is not None and wanted is not None:
            self._foresight.commanded(torque, *wanted)

    def accepted(self, asked: float, accepted: float) -> None:
        """Check the accepted torque against the requested torque [N·m], because the drive has its own limits.

        Raises
        ------
        LimitError
        """
        if not abs(accepted) <= self._limits.torque * (1.0 + _ROUNDING):
            _hold("torque", accepted, self._limits.torque, "N·m")
        if abs(accepted) < _WHOLE * abs(asked):
            self._cut += 1
        self._accepted = accepted

    def timed(self, late: float) -> None:
        """Check the end of a cycle against the start of the next one. `late` [s] is negative if it was in time.

        Raises
        ------
        LimitError
        """
        self._missed = self._missed + 1 if late > 0.0 else 0
        if self._missed > self._limits.missed_deadlines:
            raise LimitError(
                "missed_deadlines",
                f"{self._missed} cycles in a row ended late, the last one by {1e3 * late:.2f} ms",
                measured=self._missed,
                allowed=self._limits.missed_deadlines,
            )

    def _read(self, sample: DriveSample) -> None:
        """Check the torque sensor."""
        if not math.isfinite(sample.reading):
            raise LimitError(
                "sensor", f"the torque sensor reads {sample.reading}, which is not finite"
            )
        self._clipped = self._clipped + 1 if sample.clipped else 0
        if self._clipped > self._limits.clipped_samples:
            raise LimitError(
                "clipped_samples",
                f"the torque sensor is at the end of its range for {self._clipped} samples",
                measured=self._clipped,
                allowed=self._limits.clipped_samples,
            )

    def _repeats(self, position: float, velocity: float) -> None:
        """Check for a frozen encoder: equal counts in each cycle although speed or torque contradict them."""
        if position != self._place:
            self._place, self._repeated = position, 0
            self._speed_there, self._accepted_there = velocity, self._accepted
            return
        self._repeated += 1
        if self._repeated <= self._limits.repeated_positions:
            return
        change = abs(self._accepted - self._accepted_there)
        doubt = ""
        if abs(self._speed_there) > self._moving:
            reason = f"the speed was {abs(self._speed_there):.3f} rad/s before"
        elif change > self._largest_swing:
            reason = f"the torque has changed by {change:.0f} N·m during these cycles"
            if not self._friction_known:
                doubt = _WHY_STANDING
        else:
            return
        raise LimitError(
            "repeated_positions",
            f"the joint has been at {position:.6f} rad for {self._repeated} cycles, although {reason}: the "
            f"encoder hangs, or the joint is blocked{doubt}",
            measured=self._repeated,
            allowed=self._limits.repeated_positions,
        )

    def _felt(self, torque: float) -> None:
        """Check the torque of the active current."""
        if abs(torque) > self._largest_measured:
            _hold("measured_torque", torque, self._largest_measured, "N·m")
        difference = torque - self._accepted
        self._difference += difference - self._differences[0]
        self._differences.append(difference)
        mean = abs(self._difference) / _COMPARED
        if mean > self._largest_difference:
            raise LimitError(
                "torque_difference",
                f"the measured torque is {torque:.1f} N·m, but {self._accepted:.1f} N·m is commanded; the mean "
                f"difference over {_COMPARED} samples is {mean:.1f} N·m, more than {self._largest_difference:g} N·m",
                measured=mean,
                allowed=self._largest_difference,
            )


def _hold(limit: str, value: float, allowed: float, unit: str, why: str = "") -> None:
    """Raise if a value exceeds its limit or is not finite."""
    if not abs(value) <= allowed:
        raise LimitError(
            limit,
            f"{value:.4g} {unit}, more than {allowed:g} {unit}{why}",
            measured=value,
            allowed=allowed,
        )
