"""Result of a first motion: verdict, reason of a refusal, and unchecked items."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from jointid.hardware.session.watchdog import Watchdog

UNCHECKED = {
    "positive_direction": "if torque and encoder are both inverted, the motion looks correct: check in which direction "
    "the link moves",
    "encoder": "whether the encoder counts: no other sensor shows motion, and nobody turned the joint by hand with the "
    "motor off; the reported travel comes from the encoder alone",
    "homing": "the joint's zero, position_offset",
    "backlash": "the backlash: how far the motor turns while the output is at rest",
    "torque_constant": "the torque constant: the joint file states neither friction nor inertia for this check",
    "gear_ratio": "the gear ratio and the encoder's counts: there is no encoder at the output, and the joint file "
    "states no friction for this check",
    "inertia": "the joint's inertia: the joint file states no inertia, or the motion did not show the inertia",
    "sensor_sign": "the sign of the torque sensor: its signal hardly shows the joint's acceleration",
    "watchdog": "the drive's watchdog, which stops the motor if the host is gone: test it with --watchdog, or pull "
    "the plug once",
    "serial_number": "the drive's identity: the drive reports no serial number, so another drive of its type "
    "looks the same",
    "emergency_stop": "the emergency stop, the brake and the end stops",
    "control": "a motion under control: the inertia is not known",
}
"""Items that a first motion can leave unchecked, by code."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstMotion:
    """Result of a first motion.

    Attributes
    ----------
    passed : bool
    reason : str or None
        Code of the refusal, one of `refusal.REASONS` or the kind of a drive fault; None if passed.
    message : str
        One sentence about the refusal, with numbers; empty if passed.
    travel : float
        Largest distance from the start [rad], computed with the joint file's gear ratio.
    largest_torque : float
        Largest magnitude of the commanded torque [N·m], computed with the joint file's constants.
    breakaway : tuple of float or None
        Breakaway torque in the positive and the negative direction [N·m]; None if not found.
    signs : mapping
        Signs of "torque_and_encoder" and "sensor": 1 as in the joint file, -1 if inverted, None if not known.
    unchecked : tuple of str
        Codes of unchecked items, from `UNCHECKED`.
    inertia, stated_breakaway, stated_inertia : float or None
        Measured inertia [kg·m²], and breakaway torque [N·m] and inertia [kg·m²] in the joint file.
    watchdog : float or None
        Time from the host's last sign of life until the drive stopped its motor [s]; None if not tested, or if the
        motor was not stopped.
    drive_watchdog : Watchdog or None
        Watchdog that the drive declares; None if it declares none. A certificate needs a watchdog.
    sensor_zero : float or None
        Mean reading of the torque sensor at rest.
    duration : float
        Duration of the first motion [s].
    motor_off : bool or None
        Whether the drive confirmed that its motor is off.
    identity : mapping
        Identity that the drive reported.
    steps : tuple of str
        Lines of the report on tests and measurements, in order.
    """

    passed: bool
    reason: str | None = None
    message: str = ""
    travel: float = 0.0
    largest_torque: float = 0.0
    breakaway: tuple[float | None, float | None] = (None, None)
    signs: Mapping[str, int | None] = field(
        default_factory=lambda: {"torque_and_encoder": None, "sensor": None}
    )
    unchecked: tuple[str, ...] = ()
    inertia: float | None = None
    stated_breakaway: float | None = None
    stated_inertia: float | None = None
    watchdog: float | None = None
    drive_watchdog: Watchdog | None = None
    sensor_zero: float | None = None
    duration: float = 0.0
    motor_off: bool | None = None
    identity: Mapping[str, Any] = field(default_factory=dict)
    steps: tuple[str, ...] = ()

    @property
    def uncertified(self) -> str:
        """Reason why a passed first motion has no certificate; empty if it has one."""
        if self.drive_watchdog is None:
            return "the drive declares no watchdog"
        if not self.drive_watchdog.read_back and self.watchdog is None:
            return "the drive does not confirm its watchdog, and no test of the watchdog has passed: use --watchdog"
        return ""

    def to_dict(self) -> dict[str, Any]:
        """Return the output of `jointid first-motion --json` in JSON types."""
        return {
            "passed": self.passed,
            "reason": self.reason,
            "travel": self.travel,
            "largest_torque": self.largest_torque,
            "breakaway": list(self.breakaway),
            "signs": dict(self.signs),
            "unchecked": list(self.unchecked),
        }

    def report(self) -> str:
        """Return steps, verdict and remaining checks as text."""
        return "\n".join((*self.steps, self.verdict()))

    def verdict(self) -> str:
        """Return the verdict, its reason and remaining checks as text."""
        if self.passed:
            lines = [f"passed, in {self.duration:.1f} s of bench time"]
        else:
            lines = [f"REFUSED ({self.reason}): {self.message}"]
        if self.motor_off is False:
            lines.append("THE DRIVE DID NOT CONFIRM THAT THE MOTOR IS OFF")
        if self.unchecked:
            lines.append("not checked:")
            lines += [f"  {code}: {UNCHECKED.get(code, code)}" for code in self.unchecked]
        return "\n".join(lines)
