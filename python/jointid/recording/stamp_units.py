"""The unit of stamps for which none is stated: their size and their steps decide together."""

from collections.abc import Sequence

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.order_statistics import median
from jointid.recording.plausibility import slow_stamps
from jointid.recording.signals import FloatArray
from jointid.recording.units import UNITS, Unit

FILE_TIME = Unit(name="100 ns", dimension="time", factor=1e-7)  # of Windows: since 1601
_EXAMINED = 100_000  # stamps
_STEPS = (4.5e-5, 0.11)  # s: from 9 Hz to 22 kHz
_DATES = (978_307_200.0, 4_102_444_800.0)  # s since 1970: 2001 to 2100
_UPTIME = 1e8  # s: no clock runs for three years since it was switched on
_FILE_TIMES = (1.2e17, 1.5e17)  # 1981 to 2076
_ETHERCAT = (5e17, 9e17)  # ns since 2000: 2015 to 2028
_COUNTED = Action("call", {"sample_period": ...}, "if they count the rows", "load")
_HOPELESS = 1e10  # a step that is long in every unit


def unit_of_stamps(first: float, since: FloatArray, place: str) -> Unit | None:
    """Return the unit that stamps without a stated one are in.

    A unit is likely where the stamps are then a date between 2001 and 2100, or the time since a start less than
    three years ago, and their steps between 45 µs and 110 ms. Digits alone do not tell: 13 of them are
    milliseconds since 1970, or nanoseconds since a start half an hour ago.

    Parameters
    ----------
    first : float
        The first stamp, in the file's unit.
    since : ndarray, shape (n,)
        Stamps less the first.
    place : str
        For messages.

    Returns
    -------
    Unit or None
        None: seconds may be assumed, no date confirms them.

    Raises
    ------
    InputError
        Two units are as likely, or none is; the remedies name them.

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
    # A count of rows has the steps of milliseconds, too.
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
    """The units in which a stamp is a date, or a time since a start."""
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
    """The two units whose steps are nearest to those of a recording, the nearest first."""
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
        f"{reason}: {' and '.join(shown)}" if units else f"{reason}, which is too long in any unit",
        argument="time",
        place=place,
        remedy=tuple(remedies) or "choose another column",
    )
