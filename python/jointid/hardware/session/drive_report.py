"""Identity, settings and state of a drive. They are only read; nothing is changed."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

Value = float | int | str


@dataclass(frozen=True, slots=True, kw_only=True)
class Reported:
    """One value that a drive reported.

    Attributes
    ----------
    name : str
        Name in the drive's manual, e.g. "PL[1]" or "1016h:1".
    meaning : str
    value : float, int, str or None
        Reported value; None if the drive did not answer or does not have this entry.
    unit : str
        Unit of the value; empty for a plain number or a text.
    expected : float, int, str or None
        Value that a session needs; None if any value is allowed.
    kind : str
        "speed_limit" if the entry is the drive's own speed limit. Default: empty, for an entry that is only reported.
    output : float or None
        Speed limit at the joint's output [rad/s]. Default: not known.
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
        """Whether the value differs from the value that a session needs."""
        if self.expected is None:
            return False
        if isinstance(self.expected, float) and isinstance(self.value, int | float):
            return not math.isclose(self.value, self.expected, rel_tol=1e-3, abs_tol=1e-9)
        return self.value != self.expected

    @property
    def text(self) -> str:
        """Value with its unit."""
        return _text(self.value, self.unit)

    def __str__(self) -> str:
        """Return one line: name, meaning, value, and the expected value if it differs."""
        wanted = f"; expected: {_text(self.expected, self.unit)}" if self.differs else ""
        return f"{self.name} {self.meaning}: {self.text}{wanted}"


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveReport:
    """State and settings of a drive with its motor off.

    Attributes
    ----------
    drive : str
        Make and address of the drive.
    identity : tuple of Reported
        Vendor, product, revision, serial number and firmware.
    settings : tuple of Reported
        Operating mode and the drive's own limits.
    watchdog : tuple of Reported
        Watchdog settings, read back from the drive.
    serial : str
        Serial number; empty if not known.
    motor_on : bool or None
    trouble : str
        Reason that prevents operation; empty without such a reason.
    position, velocity : float
        Position [rad] and velocity [rad/s] at the output.
    reading : float
        Raw reading of the torque sensor, as in a `DriveSample`.
    current : float
        Active motor current [A].
    supply, temperature : float
        Supply voltage [V] and temperature [°C]. Unknown numbers are NaN.
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
        """Entries with a value that differs from the value that a session needs."""
        asked = (*self.identity, *self.settings, *self.watchdog)
        return tuple(each for each in asked if each.differs)

    def value(self, name: str) -> Value | None:
        """Return the value of the entry with this name; None without such an entry."""
        asked = (*self.identity, *self.settings, *self.watchdog)
        return next((each.value for each in asked if each.name == name), None)

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as JSON types; an unknown number is None."""
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
