"""Units that a header or `units` may name, their conversion to SI, and the unit that values suggest."""

import math
import re

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.base.values import dataclass

_BLANKS = str.maketrans("", "", "·⋅*. \u00a0")
_SPELLINGS = {"°": "deg", "º": "deg", "µ": "u", "μ": "u", "/": "_", "_per_": "_"}
_PER_TIME = r"(?i)(?<=[a-z°º])_?(s|min)(?:\^?-1|⁻¹)$"
_HYPHEN = r"(?<=[^\W\d_])-(?=[^\W\d_])"  # between letters: N-m, oz-in


@dataclass(frozen=True, kw_only=True)
class Unit:
    """A unit of measurement.

    Attributes
    ----------
    name : str
        Name as in a header, e.g. ``"rad_s"``.
    dimension : str
        Physical quantity: ``"angle"``, ``"torque"``, ...
    factor : float
        Factor to SI. Default 1.
    offset : float
        Offset in SI units, added after the factor. Default 0; only temperatures have one.
    """

    name: str
    dimension: str
    factor: float = 1.0
    offset: float = 0.0

    def to_si(self, values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Return the values in SI units (temperatures in °C); SI values are returned unchanged."""
        if self.factor == 1.0 and self.offset == 0.0:
            return values
        parts = round(1.0 / self.factor)
        # An overflow becomes inf, which the recording refuses with the signal's name.
        with np.errstate(over="ignore", under="ignore"):
            if parts > 1 and self.factor == 1.0 / parts:
                # NOTE: 9 ms / 1000 is the double 0.009, 9 ms * 1e-3 is its neighbour.
                return values / parts + self.offset
            return values * self.factor + self.offset


_TURN = 2.0 * math.pi
_POUND = 0.45359237 * 9.80665  # N, by definition

UNITS: dict[str, Unit] = {
    name: Unit(name=name, dimension=dimension, factor=factor, offset=offset)
    for name, dimension, factor, offset in [
        ("rad", "angle", 1.0, 0.0),
        ("mrad", "angle", 1e-3, 0.0),
        ("deg", "angle", math.pi / 180.0, 0.0),
        ("rev", "angle", _TURN, 0.0),
        ("m", "length", 1.0, 0.0),
        ("cm", "length", 1e-2, 0.0),
        ("mm", "length", 1e-3, 0.0),
        ("um", "length", 1e-6, 0.0),
        ("s", "time", 1.0, 0.0),
        ("ms", "time", 1e-3, 0.0),
        ("us", "time", 1e-6, 0.0),
        ("ns", "time", 1e-9, 0.0),
        ("min", "time", 60.0, 0.0),
        ("rad_s", "angular velocity", 1.0, 0.0),
        ("mrad_s", "angular velocity", 1e-3, 0.0),
        ("deg_s", "angular velocity", math.pi / 180.0, 0.0),
        ("rev_s", "angular velocity", _TURN, 0.0),
        ("rpm", "angular velocity", _TURN / 60.0, 0.0),
        ("m_s", "linear velocity", 1.0, 0.0),
        ("cm_s", "linear velocity", 1e-2, 0.0),
        ("mm_s", "linear velocity", 1e-3, 0.0),
        ("Nm", "torque", 1.0, 0.0),
        ("mNm", "torque", 1e-3, 0.0),
        ("kNm", "torque", 1e3, 0.0),
        ("Ncm", "torque", 1e-2, 0.0),
        ("Nmm", "torque", 1e-3, 0.0),
        ("kgfm", "torque", 9.80665, 0.0),
        ("kgfcm", "torque", 9.80665e-2, 0.0),
        ("ozfin", "torque", _POUND / 16 * 0.0254, 0.0),
        ("lbfin", "torque", _POUND * 0.0254, 0.0),
        ("lbfft", "torque", _POUND * 0.3048, 0.0),
        ("N", "force", 1.0, 0.0),
        ("mN", "force", 1e-3, 0.0),
        ("kN", "force", 1e3, 0.0),
        ("kgf", "force", 9.80665, 0.0),
        ("lbf", "force", _POUND, 0.0),
        ("A", "current", 1.0, 0.0),
        ("mA", "current", 1e-3, 0.0),
        ("degC", "temperature", 1.0, 0.0),
        ("K", "temperature", 1.0, -273.15),
        ("V", "voltage", 1.0, 0.0),
        ("mV", "voltage", 1e-3, 0.0),
        ("raw", "raw reading", 1.0, 0.0),
        ("lerobot", "raw reading", 1.0, 0.0),
    ]
}

_ALIASES: dict[str, str] = {
    alias: name
    for name, aliases in {
        "rad": "radian radians",
        "deg": "degree degrees",
        "rev": "turn turns revolution revolutions rotation rotations",
        "m": "metre meter metres meters",
        "s": "sec secs second seconds sekunden",
        "ms": "msec msecs millis millisec millisecond milliseconds millisekunden",
        "us": "usec usecs micros microsec microsecond microseconds mikrosekunden",
        "ns": "nsec nsecs nanos nanosec nanosecond nanoseconds nanosekunden",
        "min": "minute minutes",
        "rad_s": "rads",
        "deg_s": "degs dps",
        "rev_s": "rps turn_s turns_s rotations_s rotationspersecond",
        "rpm": "rev_min r_min u_min 1_min min^-1 min-1 min⁻¹",
        "Nm": "n_m",
        "mNm": "mn_m",
        "kNm": "kn_m",
        "Ncm": "n_cm",
        "Nmm": "n_mm",
        "kgfm": "kgf_m",
        "kgfcm": "kgf_cm kgcm kg_cm",
        "ozfin": "ozf_in ozin oz_in",
        "lbfin": "lbf_in lbin lb_in inlb in_lb inlbf in_lbf",
        "lbfft": "lbf_ft lbft lb_ft ftlb ft_lb ftlbf ft_lbf",
        "degC": "celsius",
        "K": "kelvin",
        "raw": "1 - count counts cnt inc increments ticks lsb",
    }.items()
    for alias in aliases.split()
}
_PLURALS = {"degs": "deg", "rads": "rad"}  # per second for velocities; otherwise a plural
_BY_FOLDED: dict[str, Unit] = {name.casefold(): unit for name, unit in UNITS.items()}


def find_unit(text: str) -> Unit | None:
    """Return the unit that a text names (`rad_s`, `rad/s`, `N·m`, `°`; any case), or None."""
    name = _plain(text)
    if name in UNITS:
        return UNITS[name]
    return None if is_mega(text) else _folded(name)


def is_mega(text: str) -> bool:
    """Whether a text is a unit's name with the prefix mega: MNm, Mrad/s. In capitals only (MNM), M is milli.

    A time is never in megaseconds: Msec means ms.
    """
    name = _plain(text)
    unit = _folded(name)
    milli = unit is not None and unit.name.startswith("m") and unit.factor < 1.0
    if not milli or unit is None or unit.dimension == "time":
        return False
    return name.startswith("M") and name != name.upper() and len(name) > 2


def _plain(text: str) -> str:
    """Return a unit's name without blanks and dots, `/` as `_`."""
    name = re.sub(_HYPHEN, "", re.sub(_PER_TIME, r"_\1", text.strip().translate(_BLANKS)))
    for spelling, plain in _SPELLINGS.items():
        name = name.replace(spelling, plain)
    return name


def _folded(name: str) -> Unit | None:
    folded = name.casefold()
    return _BY_FOLDED.get(folded) or UNITS.get(_ALIASES.get(folded, ""))


def unit_named(
    text: str, *, dimensions: tuple[str, ...] = (), argument: str = "unit", place: str = ""
) -> Unit:
    """Return the unit that a text names, or raise an error with the known units.

    Parameters
    ----------
    text : str
        A unit's name.
    dimensions : tuple of str
        Dimensions of the units that an error lists. Default: all.
    argument : str
        Argument that contains the text. Default ``"unit"``.
    place : str
        The file, for messages. Default: none.

    Raises
    ------
    InputError
        The unit is unknown, or it is `degs` or `rads` where no velocity is expected.
    """
    unit = find_unit(text) if isinstance(text, str) else None
    meant = _PLURALS.get(text.strip().casefold()) if isinstance(text, str) else None
    if unit and meant and dimensions and unit.dimension not in dimensions:
        raise InputError(
            f"this is not a known unit; did you mean {meant}?",
            argument=argument,
            value=text,
            place=place,
        )
    if unit is None and isinstance(text, str) and is_mega(text):
        raise InputError(
            f"the prefix M means mega; milli is m{text.strip()[1:]}",
            argument=argument,
            value=text,
            place=place,
        )
    if unit is None:
        raise InputError(
            f"unknown unit; choose one of {', '.join(unit_names(dimensions))}",
            argument=argument,
            value=text,
            place=place,
        )
    return unit


def unit_names(dimensions: tuple[str, ...] = ()) -> tuple[str, ...]:
    """Return the names of the units of these dimensions. Default: of all dimensions."""
    return tuple(
        name for name, unit in UNITS.items() if not dimensions or unit.dimension in dimensions
    )


# Usual sizes of a revolute joint's signals.
WIDE = 4.0 * math.pi  # [rad]: two turns from zero; few joints move further
WIDEST = 3.0 * 360.0  # [deg]
LARGEST = {
    "current": (100.0, "A", "mA"),
    "torque": (5000.0, "N·m", "mNm"),
}  # largest usual values of a joint's drive


def likely_unit(signal: str, largest: float) -> str | None:
    """Return the unit that makes the largest value of a revolute joint's signal plausible; None if SI is plausible."""
    if signal == "position":
        return "deg" if WIDE < largest <= WIDEST else None
    limit, _, smaller = LARGEST.get(signal, (math.inf, "", ""))
    return smaller if largest > limit else None
