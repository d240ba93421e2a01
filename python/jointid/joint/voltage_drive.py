"""A drive with a voltage as input: a servo that logs a duty instead of a torque."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, fields
from types import MappingProxyType
from typing import Any

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import (
    check_mapping,
    finite_number,
    not_negative,
    positive_number,
    set_numbers,
    suggestion,
)

SIGNALS = ("duty", "supply", "driven", "gain")
"""Extra signals of a servo's recording: duty [1], supply [V], whether the motor is driven, loop gain."""

INPUTS = ("torque", "voltage")
"""Values of `input` in a joint file's [drive]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PositionLoop:
    """The servo's position loop: duty = gain · (reference - position), limited to the saturation.

    Parameters
    ----------
    gain : float
        Duty per position error [1/rad]; if a signal "gain" is recorded, also per unit of this signal.
    saturation : float
        Largest magnitude of the duty. Default 1.
    delay : float
        Delay from the error to the duty [s]. Default 0.

    Raises
    ------
    InputError
        A value is not finite, the saturation is not positive, or the delay is negative.
    """

    gain: float
    saturation: float = 1.0
    delay: float = 0.0

    def __post_init__(self) -> None:
        place = "drive.position_loop"
        set_numbers(self, place, ("gain",), finite_number)
        set_numbers(self, place, ("saturation",), positive_number)
        set_numbers(self, place, ("delay",), not_negative)
        if self.gain == 0.0:
            raise InputError(
                "a value other than 0 is expected", argument="gain", value=0, place=place
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class VoltageDrive:
    """A motor with a voltage as input: torque = (k_t / R) · duty · supply - (k_t² / R) · velocity, at the output.

    k_t is the joint's `torque_constant` times its gear ratio. Unknown constants are identified.

    Parameters
    ----------
    resistance : float, optional
        Resistance of the winding [Ω]. Default: identified, if the motor turns freely in parts of a recording.
    supply : float, optional
        Supply voltage [V]. Default: the recording's signal "supply".
    duty_scale : float
        Duty per unit of the logged signal "duty", e.g. 1/885. Default 1.
    position_loop : PositionLoop or mapping, optional
        Position loop, which computes an unlogged duty and closes the loop in a rollout. Default: not known.
    signals : mapping of str to str
        Headers of the extra signals "duty", "supply", "driven" (0 while the motor turns freely) and "gain". Default:
        none; the command line then uses columns with these names.

    Raises
    ------
    InputError
        A value is invalid.

    Examples
    --------
    >>> loop = PositionLoop(gain=0.0028774)
    >>> VoltageDrive(supply=7.3, position_loop=loop, signals={"gain": "firmware_kp"}).supply
    7.3
    """

    resistance: float | None = None
    supply: float | None = None
    duty_scale: float = 1.0
    position_loop: PositionLoop | None = None
    signals: Mapping[str, str] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        place = "drive"
        set_numbers(self, place, ("resistance", "supply"), positive_number)
        set_numbers(self, place, ("duty_scale",), finite_number)
        if self.duty_scale == 0.0:
            raise InputError(
                "a value other than 0 is expected", argument="duty_scale", value=0, place=place
            )
        if isinstance(self.position_loop, Mapping):
            loop = _checked_keys(self.position_loop)
            object.__setattr__(self, "position_loop", PositionLoop(**loop))
        if not isinstance(self.position_loop, PositionLoop | None):
            raise InputError(
                "a PositionLoop is expected",
                argument="position_loop",
                value=self.position_loop,
                place=place,
            )
        check_mapping(place, "signals", self.signals)
        for name, column in self.signals.items():
            if name not in SIGNALS:
                raise InputError(
                    f"there is no such signal; {suggestion(name, SIGNALS)}",
                    argument=str(name),
                    place="drive.signals",
                )
            if not isinstance(column, str) or not column:
                raise InputError(
                    "the header of a column is expected",
                    argument=name,
                    value=column,
                    place="drive.signals",
                )
        object.__setattr__(self, "signals", MappingProxyType(dict(self.signals)))

    def __reduce__(self) -> tuple[Any, ...]:
        # A read-only mapping cannot be pickled.
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        return _rebuilt, ({**values, "signals": dict(self.signals)},)


def _rebuilt(values: dict[str, Any]) -> VoltageDrive:
    return VoltageDrive(**values)


KEYS = ("input", *(item.name for item in fields(VoltageDrive)))
"""Keys of a joint file's [drive] that describe the input."""


def voltage_of(table: dict[str, Any]) -> VoltageDrive | None:
    """Remove the input's keys from a joint file's table [drive], and return the voltage drive that they describe.

    Raises
    ------
    InputError
        The input is unknown, or there are keys of a voltage drive without ``input = "voltage"``.
    """
    given = {key: table.pop(key) for key in KEYS if key in table}
    kind = given.pop("input", "torque")
    if kind not in INPUTS:
        raise InputError(f"it is unknown; {suggestion(kind, INPUTS)}", argument="input", value=kind)
    if kind == "torque":
        for key, value in given.items():
            raise InputError(
                'only a drive with input = "voltage" has this key', argument=key, value=value
            )
        return None
    loop = given.get("position_loop")
    if loop is not None:
        check_mapping("drive", "position_loop", loop)
        given["position_loop"] = PositionLoop(**_checked_keys(loop))
    return VoltageDrive(**given)


def drive_keys(voltage: VoltageDrive | None) -> dict[str, Any]:
    """Return the keys of a joint file's [drive] that describe a voltage drive; none for a torque."""
    if voltage is None:
        return {}
    usual = VoltageDrive()
    keys: dict[str, Any] = {"input": "voltage"}
    for item in fields(voltage):
        value = getattr(voltage, item.name)
        if value != getattr(usual, item.name):
            keys[item.name] = value
    if voltage.position_loop is not None:
        loop = voltage.position_loop
        keys["position_loop"] = {item.name: getattr(loop, item.name) for item in fields(loop)}
    if voltage.signals:
        keys["signals"] = dict(voltage.signals)
    return keys


def _checked_keys(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields of a position loop; the gain is required."""
    known = [item.name for item in fields(PositionLoop)]
    place = "drive.position_loop"
    for key in given:
        if key not in known:
            raise InputError(
                f"there is no such key; {suggestion(key, known)}", argument=str(key), place=place
            )
    if "gain" not in given:
        raise InputError("it is missing", argument="gain", place=place)
    return dict(given)
