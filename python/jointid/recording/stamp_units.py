"""The unit of stamps without a stated unit, from their size and their steps."""

from collections.abc import Sequence

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.order_statistics import median
from jointid.recording.plausibility import slow_stamps
from jointid.recording.signals import FloatArray
from jointid.recording.units import UNITS, Unit

FILE_TIME = Unit(name="100 ns", dimension="time", factor=1e-7)  # Windows file time, since 1601
_EXAMINED = 100_000  # stamps
_STEPS = (4.5e-5, 0.11)  # s: from 9 Hz to 22 kHz
_DATES = (978_307_200.0, 4_102_444_800.0)  # s since 1970: 2001 to 2100
_UPTIME = 1e8  # s, three years: no clock runs longer after power-on
_FILE_TIMES = (1.2e17, 1.5e17)  # 1981 to 2076
_ETHERCAT = (5e17, 9e17)  # ns since 2000: 2015 to 2028
_COUNTED = Action("call", {"sample_period": ...}, "if the stamps count the rows", "load")
_HOPELESS = 1e10  # a step that is too long in every unit


def unit_of_stamps(first: float, since: FloatArray, place: str) -> Unit | None:
    """Return the unit of stamps without a stated unit.

    A unit is likely if it meets two conditions. The stamps are a date between 2001 and 2100, or a time since a
    start less than three years ago. Their steps are between 45 µs and 110 ms. The number of digits is not enough:
    13 digits are milliseconds since 1970, or nanoseconds since a start half an hour ago.

    Parameters
    ----------
    first : float
        The first stamp, in the file's unit.
    since : ndarray, shape (n,)
        Stamps minus the first one, in the file's unit.
    place : str
        File and column, for messages.

    Returns
    -------
    Unit or None
        None: seconds may be assumed, but no date confirms them.

    Raises
    ------
    InputError
        Two units are equally likely, or none is likely; the remedies name them.

    Examples
    --------
    >>> unit_of_stamps(2e15, 250_000.0 * np.arange(9), "run.csv").name
    'ns'
    """
    with np.errstate(all="ignore"):
        steps = np.diff(since[:_EXAMINED])
        steps = steps[(steps > 0.0) & np.isfinite(steps)]
        usual = since[:_EXAMINED][np.isfinite(since[:_EXAMINED])]
        size = first + median(usual) if len(usual) else first
        step = median(steps) if len(steps) else 0.0
    fitting = _of_size(size)
    second = UNITS["s"]
    if step <= _STEPS[1] and (second in fitting or not fitting):
        return second if _dated(size) else None
    likely = [unit for unit in fitting if _STEPS[0] <= step * unit.factor <= _STEPS[1]]
    # A row counter has the same steps as milliseconds.
    if [unit.name for unit in likely] == ["ms"] and second in fitting:
        likely = [UNITS["ms"], second]
    if len(likely) == 1:
        return likely[0]
    if not likely and len(fitting) == 1:
        return fitting[0]
    raise _undecided(step, likely or _nearest(fitting, step), place)


def _dated(size: float) -> bool:
    """Whether a number of seconds is a date since 1970."""
    return _DATES[0] <= size <= _DATES[1]


def _of_size(size: float) -> list[Unit]:
    """Return the units in which a stamp is a date, or a time since a start."""
    fitting = [
        unit
        for unit in (UNITS[name] for name in ("s", "ms", "us", "ns"))
        if size * unit.factor <= _UPTIME or _dated(size * unit.factor)
    ]
    if _FILE_TIMES[0] < size < _FILE_TIMES[1]:
        return [FILE_TIME]
    if _ETHERCAT[0] < size < _ETHERCAT[1]:
        return [UNITS["ns"]]
    return fitting


def _nearest(units: Sequence[Unit], step: float) -> list[Unit]:
    """Return the two units with steps nearest to usual sample periods, nearest first."""
    if step > _HOPELESS:
        return []
    middle = float(np.log(_STEPS).mean())
    return sorted(units, key=lambda unit: abs(np.log(max(step, 1e-30) * unit.factor) - middle))[:2]


def _undecided(step: float, units: Sequence[Unit], place: str) -> InputError:
    shown = [
        f"{step * unit.factor:.6g} s if they are in {unit.name}"
        for unit in sorted(units, key=lambda unit: unit.factor)
    ]
    reason = f"no unit is stated, and the stamps are {step:.6g} apart"
    usual = [unit for unit in units if slow_stamps(step * unit.factor) is None] or units
    remedies = [
        Action("call", {"units": {"time": unit.name}}, function="load")
        for unit in sorted(usual, key=lambda unit: unit.factor)
    ]
    if units and step == 1.0:
        remedies.append(_COUNTED)
    return InputError(
        f"{reason}: {' and '.join(shown)}"
        if units
        else f"{reason}; this step is too long in any unit",
        argument="time",
        place=place,
        remedy=tuple(remedies) or "choose another column",
    )
