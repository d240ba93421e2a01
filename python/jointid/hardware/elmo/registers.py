"""Read an Elmo drive's identity and limits, without changes."""

from __future__ import annotations

from dataclasses import replace

from jointid.base.errors import InputError
from jointid.hardware.can.canopen_frames import SdoAbortError, SdoRequest
from jointid.hardware.elmo.link import ElmoLink
from jointid.hardware.session.drive import DriveFaultError
from jointid.hardware.session.drive_report import Reported

_ANSWER = 0.05  # [s] to wait for a register; a drive without the register refuses at once

# Letters, index, meaning, unit (SimplIQ Command Reference).
_LIMITS = (
    ("PL", 1, "peak current", "A"),
    ("PL", 2, "longest time at peak current", "s"),
    ("CL", 1, "continuous current", "A"),
    ("CL", 2, "share of peak current above which a motor at rest counts as stuck", "%"),
    ("CL", 3, "speed below which the motor counts as being at rest", "count/s"),
    ("MC", 0, "the drive's own peak current", "A"),
    ("HL", 2, "highest speed of the motor", "count/s"),
    ("LL", 2, "lowest speed of the motor", "count/s"),
    ("HL", 3, "highest position of the motor", "count"),
    ("LL", 3, "lowest position of the motor", "count"),
    ("ER", 2, "largest speed error", "count/s"),
    ("ER", 3, "largest position error", "count"),
    ("XM", 1, "start of the counter's range", "count"),
    ("XM", 2, "end of the counter's range", "count"),
    ("BV", 0, "highest supply", "V"),
)
_SPEEDS = ("HL[2]", "LL[2]")
_COUNTS = ("CA", 18)
_SUPPLY, _TEMPERATURE = ("AN", 6), ("TI", 1)


def identity(link: ElmoLink) -> tuple[Reported, ...]:
    """Return vendor, product, revision and serial number (1018h), name and firmware, without those that are missing."""
    found = []
    for subindex, meaning in ((1, "vendor"), (2, "product"), (3, "revision"), (4, "serial")):
        value = read_object(link, 0x1018, subindex)
        if value is not None:
            shown = str(value) if meaning == "serial" else f"0x{value:X}"
            found.append(Reported(name=f"1018h:{subindex}", meaning=meaning, value=shown))
    for index, meaning in ((0x1008, "device"), (0x100A, "firmware")):
        text = _text(link, index)
        if text:
            found.append(Reported(name=f"{index:04X}h", meaning=meaning, value=text))
    return tuple(found)


def limits(link: ElmoLink, resolution: float) -> tuple[Reported, ...]:
    """Return the drive's limits from its registers, and rated current and torque (6075h, 6076h).

    Parameters
    ----------
    link : ElmoLink
    resolution : float
        Joint angle per encoder count [rad].
    """
    found = []
    for letters, index, meaning, unit in _LIMITS:
        name = f"{letters}[{index}]" if index else letters
        value = link.number(letters, _ANSWER, index)
        entry = Reported(name=name, meaning=meaning, value=value, unit=unit)
        if name in _SPEEDS and value is not None:
            entry = replace(entry, kind="speed_limit", output=value * resolution)
        found.append(entry)
    continuous, rated = found[2].value, read_object(link, 0x6075, 0)
    found += [
        Reported(
            name="6075h",
            meaning="reference current of the measured torque 6077h",
            value=rated,
            unit="mA",
            # The measured current is taken as per mille of CL[1].
            expected=round(1e3 * continuous)
            if isinstance(continuous, float) and rated is not None
            else None,
        ),
        Reported(
            name="6076h",
            meaning="rated torque of the motor",
            value=read_object(link, 0x6076, 0),
            unit="mN·m",
        ),
    ]
    return tuple(found)


def counts_per_turn(link: ElmoLink) -> float | None:
    """Return the drive's counts per motor revolution; None without an answer."""
    return link.number(_COUNTS[0], _ANSWER, _COUNTS[1])


def supply(link: ElmoLink) -> float | None:
    """Return the supply voltage [V]; None without an answer."""
    return link.number(_SUPPLY[0], _ANSWER, _SUPPLY[1])


def temperature(link: ElmoLink) -> float | None:
    """Return the temperature of the drive [°C]; None without an answer."""
    return link.number(_TEMPERATURE[0], _ANSWER, _TEMPERATURE[1])


def read_object(link: ElmoLink, index: int, subindex: int) -> int | None:
    """Return the value of an object; None when the drive does not have it."""
    try:
        return link.transfer(SdoRequest(index=index, subindex=subindex))
    except SdoAbortError:
        return None


def _text(link: ElmoLink, index: int) -> str:
    try:
        return link.upload(index, 0).decode("latin-1").strip("\0 ")
    except (SdoAbortError, InputError, DriveFaultError):
        return ""
