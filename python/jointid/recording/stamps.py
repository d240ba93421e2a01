"""Time stamps that a float cannot hold: ISO 8601, integers since an epoch, seconds with a column of nanoseconds."""

import re
from collections.abc import Iterable, Iterator, Sequence
from datetime import datetime
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.values import dataclass
from jointid.recording.headers import plain
from jointid.recording.signals import FloatArray
from jointid.recording.stamp_units import unit_of_stamps
from jointid.recording.units import UNITS, Unit

_ISO = r"(?i)(\d{4}-\d\d-\d\d)[T ](\d\d:\d\d:\d\d)(?:[.,](\d+))?\s*(Z|UTC|[+-]\d\d(?::?\d\d)?)?"
_CLOCK = r"(\d{1,2}:\d\d:\d\d)(?:[.,](\d+))?"
_DAY_FIRST = rf"(\d{{1,2}})([./])(\d{{1,2}})\2(\d{{4}}),?[T ]+{_CLOCK}"
_NUMBER = r"(-?\d+)(?:[.,](\d+))?"
_EPOCH = datetime(1970, 1, 1)
_LARGE = 10**12  # smaller integers are exact as floats of seconds
_LONGEST = 25  # digits: longer numbers are not stamps
_KNOWN = 10_000  # number of cached seconds
_WHOLE = r"(.*?)_?(tv_)?(?:secs?|seconds)"
_PARTS = (
    (r"(.*?)_?(tv_)?(?:n(?:ano)?secs?|nanoseconds)", 1e9),
    (r"(.*?)_?(tv_)?(?:u(?:s|sec)s?|microseconds)", 1e6),
)
_SECOND = 10**9
_DAY = 86400 * _SECOND


@dataclass(frozen=True, kw_only=True)
class Stamps:
    """Time stamps as seconds.

    Attributes
    ----------
    seconds : ndarray, shape (n,)
        Time since the first stamp [s], exact to 1 ns.
    first : str
        The first stamp in the form of the file.
    recognised : str
        Unit recognised from size and steps. Default: the file states the unit.
    """

    seconds: FloatArray
    first: str
    recognised: str = ""


def looks_exact(cell: str) -> bool:
    """Whether a cell is a stamp that a float would round, or a date with a time."""
    number = re.fullmatch(_NUMBER, cell.strip())
    if number is None:
        return any(re.fullmatch(each, cell.strip()) for each in (_ISO, _DAY_FIRST, _CLOCK))
    whole, fraction = len(number[1].lstrip("-")), len(number[2] or "")
    return 13 <= whole <= _LONGEST or (whole in (9, 10) and fraction > 0)


def stamps_of(cells: Sequence[str], unit: Unit | None, place: str = "") -> Stamps | None:
    """Return stamps as seconds since the first, or None for cells that are no such stamps.

    Stamps are subtracted as integers. In 01.11.2025 the day is first. 01/11/2025 is read only if month and day
    cannot be confused, or if all dates are equal. Clock times without a date continue after midnight.
    A time of day without a zone is taken as UTC.

    Parameters
    ----------
    cells : sequence of str
    unit : Unit or None
        Stated unit of numbers. None: recognised from size and steps.
    place : str
        File and column, for messages. Default: none.

    Raises
    ------
    InputError
        Two units are possible.

    Examples
    --------
    >>> stamps_of(["2024-05-01T12:00:00Z", "2024-05-01T14:00:00.001+02:00"], None).seconds.tolist()
    [0.0, 0.001]
    """
    if not cells:
        return None
    if looks_exact(cells[0]) and re.fullmatch(_NUMBER, cells[0].strip()) is None:
        nanoseconds = _of_any_dates(cells)
        if nanoseconds is None:
            return None
        return Stamps(
            seconds=_differences(nanoseconds) / _SECOND,
            first=cells[0].strip(),
        )
    numbers = _of_numbers(cells)
    if numbers is None:
        return None
    values, parts = numbers
    return _with_unit(
        _differences(values), parts, cells[0].strip(), float(values[0]) / parts, unit, place
    )


def stamps_of_integers(
    values: npt.NDArray[Any], unit: Unit | None, place: str = ""
) -> Stamps | None:
    """Return integers as seconds since the first, or None if floats hold them exactly.

    Parameters
    ----------
    values : ndarray of int, shape (n,)
    unit, place
        Same as in `stamps_of`.

    Raises
    ------
    InputError
        Same errors as `stamps_of`.

    Examples
    --------
    >>> stamps_of_integers(np.array([1729990799999000123, 1729990800000000123]), None).seconds.tolist()
    [0.0, 0.001]
    """
    if not len(values) or abs(int(values[0])) < _LARGE:
        return None
    if int(values.max()) - int(values.min()) >= 2**63 or int(values.max()) >= 2**63:
        values = values.astype(object)
    elif values.dtype != np.object_:
        values = values.astype(np.int64)
    differences = (values - values[0]).astype(np.float64)
    return _with_unit(differences, 1, str(values[0]), float(values[0]), unit, place)


def stamps_of_clock(values: npt.NDArray[Any]) -> Stamps:
    """Return dates with a time, or durations, as seconds since the first.

    Parameters
    ----------
    values : ndarray of datetime64 or timedelta64, shape (n,)
        Stamps without NaT; not empty.
    """
    nanoseconds = (values - values[0]).astype("m8[ns]").astype(np.int64)
    return Stamps(seconds=nanoseconds.astype(np.float64) / _SECOND, first=str(values[0]))


def _with_unit(
    differences: FloatArray, parts: int, shown: str, first: float, unit: Unit | None, place: str
) -> Stamps:
    found = unit or unit_of_stamps(first, differences / parts, place) or UNITS["s"]
    scale = parts * round(1.0 / found.factor) if found.factor <= 1.0 else parts / found.factor
    return Stamps(seconds=differences / scale, first=shown, recognised="" if unit else found.name)


def fraction_of(headers: Sequence[str], whole: int) -> tuple[int, float] | None:
    """Return the column with the fraction of a column of whole seconds, and its units per second.

    Examples
    --------
    >>> fraction_of(("header.stamp.secs", "header.stamp.nsecs"), 0)
    (1, 1000000000.0)
    """
    name = re.fullmatch(_WHOLE, plain(headers[whole]))
    if name is None:
        return None
    for index, header in enumerate(headers):
        for pattern, parts in _PARTS:
            other = re.fullmatch(pattern, plain(header))
            if index != whole and other and other.groups() == name.groups():
                return index, parts
    return None


def fractions(headers: Sequence[str]) -> frozenset[int]:
    """Return the columns that hold the fraction of another column's seconds."""
    found = (fraction_of(headers, k) for k, each in enumerate(headers) if "sec" in each.casefold())
    return frozenset(each[0] for each in found if each)


def with_fraction(whole: FloatArray, fraction: FloatArray, parts: float) -> FloatArray | None:
    """Return seconds since the first stamp; None if the seconds are not whole, or the fraction is out of range."""
    with np.errstate(invalid="ignore"):
        plain_parts = (fraction >= 0.0) & (fraction < parts) & (whole == np.floor(whole))
    if len(whole) != len(fraction) or not len(whole) or not plain_parts.all():
        return None
    return np.asarray((whole - whole[0]) + (fraction - fraction[0]) / parts)


def _differences(values: Sequence[int]) -> FloatArray:
    first = values[0]
    return np.fromiter((each - first for each in values), dtype=np.float64, count=len(values))


def _of_any_dates(cells: Sequence[str]) -> list[int] | None:
    if re.fullmatch(_ISO, cells[0].strip()):
        return _of_dates(cells)
    if re.fullmatch(_CLOCK, cells[0].strip()):
        return _of_clocks(cells)
    points = True
    for cell in cells:
        match = re.fullmatch(_DAY_FIRST, cell.strip())
        if match is None:
            return None
        points = points and match[2] == "."
    day_first = _of_dates(_iso(cells, 1, 3))
    if points:
        return day_first
    month_first = _of_dates(_iso(cells, 3, 1))
    if day_first is None or month_first is None:
        return day_first or month_first
    same = all(
        mine - day_first[0] == other - month_first[0]
        for mine, other in zip(day_first, month_first, strict=True)
    )
    return day_first if same else None


def _iso(cells: Iterable[str], day: int, month: int) -> Iterator[str]:
    """Yield dates with the year last as ISO 8601, up to the first cell that is not such a date."""
    for cell in cells:
        match = re.fullmatch(_DAY_FIRST, cell.strip())
        if match is None:
            return
        date = f"{match[4]}-{int(match[month]):02d}-{int(match[day]):02d}"
        yield f"{date} {match[5]:0>8}.{match[6] or 0}"


def _on_one_day(cells: Iterable[str]) -> Iterator[str]:
    """Yield clock times as dates, up to the first cell that is not a clock time."""
    for cell in cells:
        match = re.fullmatch(_CLOCK, cell.strip())
        if match is None:
            return
        yield f"1970-01-01 {match[1]:0>8}.{match[2] or 0}"


def _of_clocks(cells: Sequence[str]) -> list[int] | None:
    found = _of_dates(_on_one_day(cells))
    if found is None or len(found) < len(cells):
        return None
    days, before = 0, found[0]
    for k, each in enumerate(found):
        if each < before - _DAY // 2:  # midnight; a clock adjustment goes back less
            days += 1
        before = each
        found[k] = each + days * _DAY
    return found


def _of_dates(cells: Iterable[str]) -> list[int] | None:
    seconds: dict[str, int] = {}  # cache by date and time without fraction, which many stamps share
    zones: dict[str, int] = {"": 0}
    found = []
    for cell in cells:
        stamp = re.fullmatch(_ISO, cell.strip())
        if stamp is None:
            return None
        day, clock, fraction, zone = stamp[1], stamp[2], stamp[3] or "0", stamp[4] or ""
        whole = seconds.get(base := f"{day} {clock}")
        if whole is None:
            try:
                since = datetime.fromisoformat(base) - _EPOCH
            except ValueError:  # 30 February
                return None
            if len(seconds) == _KNOWN:
                seconds.clear()
            whole = seconds[base] = (since.days * 86400 + since.seconds) * _SECOND
        if zone not in zones:
            zones[zone] = _zone(zone)
        found.append(whole + int(fraction[:9].ljust(9, "0")) - zones[zone])
    return found


def _zone(text: str) -> int:
    """Return the offset of a zone from UTC [ns]."""
    digits = re.sub(r"\D", "", text)
    if not digits:
        return 0
    minutes = int(digits[:2]) * 60 + int(digits[2:] or 0)
    return (-minutes if text.startswith("-") else minutes) * 60 * _SECOND


def _of_numbers(cells: Sequence[str]) -> tuple[list[int], int] | None:
    """Return numbers as scaled integers, and the scale: integers per unit of the file."""
    digits = 0
    for cell in cells:
        match = re.fullmatch(_NUMBER, cell.strip())
        if match is None:
            return None
        digits = max(digits, len(match[2] or ""))
        if digits > _LONGEST or len(match[1]) > _LONGEST:
            return None
    parts = (cell.strip().replace(",", ".").partition(".") for cell in cells)
    return [int(whole + fraction.ljust(digits, "0")) for whole, _, fraction in parts], 10**digits
