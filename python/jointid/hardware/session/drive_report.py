"""What a drive is, how it is set and how it stands now: read from it, nothing is changed."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

Value = float | int | str


@dataclass(frozen=True, slots=True, kw_only=True)
class Reported:
    """One thing that a drive was asked for.

    Attributes
    ----------
    name : str
        As the drive's manual has it, e.g. "PL[1]" or "1016h:1".
    meaning : str
    value : float, int, str or None
        None: the drive did not answer, or does not have it.
    unit : str
        Empty for a bare number or a text.
    expected : float, int, str or None
        What a session needs; None: any value will do.
    kind : str
        "speed_limit": the drive's own. Default: nothing that a session looks at.
    output : float or None
        Of a number with a kind: what it is at the joint's output [rad/s]. Default: not known.
    """

    name: str
    meaning: str
    value: Value | None
    unit: str = ""
    expected: Value | None = None
    kind: Literal["", "speed_limit"] = ""
    output: float | None = None

    @property
    def differs(self) -> bool:
        """Whether it is not what a session needs."""
        if self.expected is None:
            return False
        if isinstance(self.expected, float) and isinstance(self.value, int | float):
            return not math.isclose(self.value, self.expected, rel_tol=1e-3, abs_tol=1e-9)
        return self.value != self.expected

    @property
    def text(self) -> str:
        """The value with its unit."""
        return _text(self.value, self.unit)

    def __str__(self) -> str:
        """One line: name, meaning, value, and what is expected where that differs."""
        wanted = f"; expected: {_text(self.expected, self.unit)}" if self.differs else ""
        return f"{self.name} {self.meaning}: {self.text}{wanted}"


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveReport:
    """A drive as it was found, its motor off.

    Attributes
    ----------
    drive : str
        Its make, and where it is.
    identity : tuple of Reported
        Vendor, product, revision, serial number, firmware.
    settings : tuple of Reported
        Mode, and the drive's own limits.
    watchdog : tuple of Reported
        What makes the drive stop when the host is gone, read back from it.
    serial : str
        The serial number; empty when it is not known.
    motor_on : bool or None
    trouble : str
        What keeps the drive from working; empty when nothing does.
    position, velocity : float
        At the output [rad], [rad/s].
    reading : float
        Raw, of the torque sensor, as in a `DriveSample`.
    current : float
        Active, in the motor [A].
    supply, temperature : float
        [V], [°C]. Each number is not a number when it is not known.
    """

    drive: str
    identity: tuple[Reported, ...] = ()
    settings: tuple[Reported, ...] = ()
    watchdog: tuple[Reported, ...] = ()
    serial: str = ""
    motor_on: bool | None = None
    trouble: str = ""
    position: float = field(default=math.nan)
    velocity: float = field(default=math.nan)
    reading: float = field(default=math.nan)
    current: float = field(default=math.nan)
    supply: float = field(default=math.nan)
    temperature: float = field(default=math.nan)

    @property
    def differences(self) -> tuple[Reported, ...]:
        """All that is not what a session needs."""
        asked = (*self.identity, *self.settings, *self.watchdog)
        return tuple(each for each in asked if each.differs)

    def value(self, name: str) -> Value | None:
        """Return the value of the entry with this name; None when there is none."""
        asked = (*self.identity, *self.settings, *self.watchdog)
        return next((each.value for each in asked if each.name == name), None)

    def to_dict(self) -> dict[str, Any]:
        """The fields, of JSON's types: a number that is not known is None."""
        found: dict[str, Any] = asdict(self)
        for name, value in found.items():
            if isinstance(value, float) and not math.isfinite(value):
                found[name] = None
        return found


def _text(value: Value | None, unit: str) -> str:
    if value is None:
        return "no answer"
    shown = f"{value:.6g}" if isinstance(value, float) else str(value)
    return f"{shown} {unit}".rstrip()
