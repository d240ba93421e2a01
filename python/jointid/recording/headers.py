"""Headers: the signal and the unit that they name."""

import re
from functools import lru_cache

from jointid.base.values import dataclass
from jointid.recording.header_words import OF_A_JOINT, PLAIN, WORDS, Meaning, meaning_of
from jointid.recording.known_products import Documented, documented
from jointid.recording.signals import dimensions
from jointid.recording.units import Unit, find_unit, is_mega

ALIASES: dict[str, str] = {
    alias: signal
    for signal, aliases in {
        "time": "time t",
        "position": "position pos angle q",
        "velocity": "velocity vel speed",
        "torque": "torque tau effort force motor_force motor_torque_output output_torque",
        "sensor": "sensor sensor_raw torque_sensor",
        "reference": "reference position_ref position_reference goal_position",
        "link_position": "link_position",
        "temperature": "temperature",
        "motor_torque": "motor_torque",
        "current": "current motor_current",
        "late": "late late_cycles",
    }.items()
    for alias in aliases.split()
}


_AXIS = r"(?i)(?:axis|joint|motor|servo|id)[ _]?(\d+)"
_INDEX = r"(?<=[\w\]])\[(\d+)\]"
_SYMBOL = r"(?i)(?<![^\W_])i(?![^\W_])"  # symbol of a current


@dataclass(frozen=True, slots=True)
class Header:
    """The parts of a header and their meaning.

    Attributes
    ----------
    name : str
        The name in lower case, without unit.
    unit : Unit or None
    unknown : str
        Text at the unit's place that is no known unit. Default: none.
    meaning : Meaning or None
        The signal that the header names. Default: none is recognised.
    documented : Documented or None
        The product's documentation of this name. Default: no known product.
    """

    name: str
    unit: Unit | None
    unknown: str = ""
    meaning: Meaning | None = None
    documented: Documented | None = None


LONGEST = 300  # characters of a header that are examined: name and unit are at its end


@lru_cache(maxsize=4096)
def understood(header: str) -> Header:
    """Return the parts and the meaning of a header."""
    header = header[-LONGEST:]
    text, unit, unknown = _divided(header)
    meaning = _meaning(text)
    whole = re.sub(r"\s*[\[(][^\[\]()]*[\])]\s*$", "", header)
    if meaning is None or (unit and unit.dimension not in dimensions(meaning.signal, None)):
        # tau_m is no torque in metres: the last word belongs to the name.
        other = None if text == whole or unit is None else _meaning(whole)
        if other is not None:
            return Header(plain(whole), None, "", other)
    if meaning is None and unit and unit.dimension == "current":  # "i" alone may be an index
        meaning = _meaning(re.sub(_SYMBOL, "current", text))
    known = documented(text)
    if known is not None and (meaning is None or meaning.rank == OF_A_JOINT):
        axis = re.search(_AXIS, text)
        meaning = Meaning(known.signal, OF_A_JOINT if axis else WORDS, axis[1] if axis else "")
    return Header(plain(text), unit, unknown, meaning, known)


def _meaning(text: str) -> Meaning | None:
    name = plain(text)
    return Meaning(ALIASES[name], PLAIN) if name in ALIASES else meaning_of(text.lstrip("%#"))


def parsed(header: str) -> tuple[str, Unit | None, str]:
    """Return a header's plain name, its unit, and text at the unit's place that is no unit."""
    header = header[-LONGEST:]
    text, unit, unknown = _divided(header)
    return plain(text), unit, unknown


def _divided(header: str) -> tuple[str, Unit | None, str]:
    """Return name, unit, and text at the unit's place that is no unit."""
    if re.search(r"\((\d+,:|:,\d+)\)$", header):  # part of a matrix: the brackets hold no unit
        return header, None, ""
    header = re.sub(_INDEX, r"_\1", header)  # position[0] is a number, not a unit
    bracketed = re.fullmatch(r"(.*?)\s*[\[(]([^\[\]()]*)[\])]\s*", header)
    if bracketed and bracketed[2].strip():
        unit = find_unit(bracketed[2])
        return bracketed[1], unit, "" if unit else bracketed[2].strip()
    text = (bracketed[1] if bracketed else header).strip()
    parts = re.split(r"([_\s,]+)", text)
    for first in range(2, len(parts), 2):  # the longest unit: rad_s before s
        suffix = "_".join(parts[first::2])
        if suffix.casefold() == "min":
            break  # minimum value; minutes are [min]
        unit = find_unit(suffix) if suffix and not suffix[0].isdigit() else None
        if suffix and is_mega(suffix):
            return "".join(parts[: first - 1]), None, suffix
        if unit:
            return "".join(parts[: first - 1]), unit, ""
    return text, None, ""


def plain(name: str) -> str:
    """Return a name in lower case, its words joined by single underscores."""
    return re.sub(r"[\s_.-]+", "_", name.strip().casefold())
