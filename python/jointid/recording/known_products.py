"""Names of values in one product or standard, with the documented units."""

from __future__ import annotations

import math
import re

import numpy as np

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.signals import FloatArray
from jointid.recording.table import Table
from jointid.recording.units import UNITS, Unit

_STEP = 2.0 * math.pi / 4096.0
_RPM = UNITS["rpm"].factor
_ALIKE = 1.5  # factor between alike speeds; the documented units differ by a factor of 3 or more
_OWNER = r"^((odrv|axis|joint|motor|servo|drive|encoder|id)_?\d*_)+"
_OLDER = 1024  # counts per 300°, of older servos with the same names


@dataclass(frozen=True, slots=True)
class Documented:
    """A value in a product's documentation.

    Attributes
    ----------
    signal : str
        ``"position"``, ...
    source : str
        The product or standard.
    units : tuple of Unit
        Possible units. Several: the position's rate of change selects one. Empty: the name states no unit.
    whole : bool
        Whether the product's values are whole numbers; other values were converted before.
    asked : str
        Description of the unit, if the user must state it. Default: none.
    factor : str
        Formula of the factor to SI. Default: none.
    """

    signal: str
    source: str
    units: tuple[Unit, ...] = ()
    whole: bool = True
    asked: str = ""
    factor: str = ""


def _speed(name: str, factor: float) -> Unit:
    return Unit(name=name, dimension="angular velocity", factor=factor)


_COUNTS = Unit(name="1/4096 rev", dimension="angle", factor=_STEP)
_SPEEDS = (
    _speed("0.229 rpm", 0.229 * _RPM),
    _speed("0.732 rpm", 0.732 * _RPM),
    _speed("1/4096 rev/s", _STEP),
)
_SERVOS, _DRIVES = "Dynamixel X and Feetech STS", "CiA 402"

PRODUCTS: dict[str, Documented] = {
    # docs.odriverobotics.com, API reference, firmware 0.5 and later
    "pos_estimate": Documented("position", "ODrive", (UNITS["rev"],), whole=False),
    "vel_estimate": Documented("velocity", "ODrive", (UNITS["rev_s"],), whole=False),
    "iq_measured": Documented("current", "ODrive", (UNITS["A"],), whole=False),
    # CiA 402 (IEC 61800-7-201), objects 6064h, 606Ch, 6077h, 6078h
    "position_actual_value": Documented(
        "position",
        _DRIVES,
        asked="in counts (6064h)",
        factor="2π divided by the counts per revolution",
    ),
    "velocity_actual_value": Documented(
        "velocity", _DRIVES, asked="in the drive's own unit (606Ch)", factor="the unit in rad/s"
    ),
    "torque_actual_value": Documented(
        "torque",
        _DRIVES,
        asked="per mille of the motor's rated torque (6077h, 6076h)",
        factor="the rated torque in N·m divided by 1000, times the gear ratio",
    ),
    "current_actual_value": Documented(
        "current",
        _DRIVES,
        asked="per mille of the motor's rated current (6078h, 6075h)",
        factor="the rated current in A divided by 1000",
    ),
    # emanual.robotis.com, control tables of the X series; Feetech's memory tables of STS servos
    "present_position": Documented("position", _SERVOS, (_COUNTS,)),
    "present_velocity": Documented("velocity", _SERVOS, _SPEEDS),
    "present_speed": Documented("velocity", _SERVOS, _SPEEDS),
    "present_current": Documented(
        "current",
        _SERVOS,
        asked="in a unit that depends on the servo's model",
        factor="0.00269 for XM, XH and XW; 0.001 for XL330 and XC330; 0.0065 for STS",
    ),
}
"""Plain name → its documentation."""


def documented(name: str) -> Documented | None:
    """Return the documentation of a header without its unit; None if no known product uses this name.

    Parameters
    ----------
    name : str
        The name, with or without an object's path: ``"axis0.encoder.pos_estimate"``.
    """
    last = re.split(r"[./:]", name.strip())[-1]
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", last)
    return PRODUCTS.get(re.sub(_OWNER, "", re.sub(r"[\s_-]+", "_", words).casefold()))


def unit_in_table(known: Documented, table: Table, index: int) -> Unit | None:
    """Return the unit of a column with a documented name; None if its numbers do not fit the product.

    For a raw reading the user must state the unit, because the name does not.
    """
    if not known.whole:
        return known.units[0]
    try:
        (values,) = table.numbers([index])
    except InputError:
        return None
    values = values[np.isfinite(values)]
    if not len(values) or not float(np.ptp(values)) > 0.0 or not (values == np.rint(values)).all():
        return None
    older = known.units == (_COUNTS,) and 0.0 <= float(values.min()) <= float(values.max()) < _OLDER
    return UNITS["raw"] if older or not known.units else known.units[0]


def speed_unit(time: FloatArray, position: FloatArray, velocity: FloatArray) -> Unit | None:
    """Return the documented unit of a servo's velocity that agrees with the position's rate; None if none fits.

    Parameters
    ----------
    time, position : ndarray, each of shape (n,)
        Time [s] and position [rad].
    velocity : ndarray, shape (n,)
        Velocity in the servo's own unit.
    """
    square = float(velocity @ velocity)
    if len(time) < 2 or not square > 0.0:
        return None
    with np.errstate(all="ignore"):
        factor = float(np.gradient(position, time) @ velocity) / square
    fitting = [unit for unit in _SPEEDS if 1.0 / _ALIKE < factor / unit.factor < _ALIKE]
    return fitting[0] if fitting else None
