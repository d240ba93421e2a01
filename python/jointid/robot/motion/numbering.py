"""The number of each row on an even clock, although stamps are late by chance and rows are lost.

Stamps keep their position within the sample period, even if rows are missing. A row has the number of the period that
contains its stamp. If a stamp is late by more than a period, the next rows and the positions decide.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_FEWEST = 200  # smallest number of rows
_BLOCK = 64  # rows for one value of the phase
_LOOKED_AT = 64  # blocks that are used to find the period
_SPREAD = 0.15  # of the usual step: largest difference of the period from it
_GROUP = 16  # number of blocks, then of groups of them, with compared phases
_FINE = 0.25  # largest error of a frequency at the end of a group, in periods
_COHERENT = 0.12  # least mean length of the phases' sum; it is 0 for random stamps
_BINS, _SMOOTH = 50, 5  # bins of the phases' histogram, and the width of its smoothing
_EDGE = 0.05  # of the histogram's height above its minimum: a period begins at this height
_EARLY = 0.5  # of a period: only a stamp at the end of a period may belong to the next one
_REACH = 4  # samples on both sides of an interval that give its speed
_NORMAL = 1.4826  # standard deviation over median deviation
_FINEST = 1e-6  # of the longest distance in an interval: smaller noise is not plausible
_CLEAR = 0.15  # periods: largest error of an interval's length from positions
_DENSE = 3  # largest ratio of periods to rows: over more periods, the speed changes
_NEAR = 12  # rows within which a misplaced jump is reversed


def row_numbers(time: Array, position: Array) -> Whole | None:
    """Return the number of each row on an even clock, starting at 0; None if the stamps show no such clock.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Stamps [s].
    position : ndarray, shape (n, joints)
    """
    if time.size < _FEWEST:
        return None
    cycles = _cycles(time - time[0])
    if cycles is None:
        return None
    within = cycles - _beginning(cycles % 1.0)
    number = np.floor(within).astype(np.int64)
    # A stamp that is too early for its row gets the number of the row before. Then the next number is free.
    early = (number[1:-1] <= number[:-2]) & (number[2:] >= number[1:-1] + 2)
    number[1:-1] += early & (within[1:-1] % 1.0 > _EARLY)
    # A stamp that is late by a period or more gets a number of the rows after it.
    index = np.arange(time.size)
    number = np.minimum.accumulate((number - index)[::-1])[::-1] + index
    number = _by_positions(number, position)
    return np.asarray(number - number[0])


def _cycles(time: Array) -> Array | None:
    """Return periods of the stamps' common clock since the first one; None if there is no such clock."""
    usual = float(np.median(np.diff(time)))
    blocks = time.size // _BLOCK
    table = time[: blocks * _BLOCK].reshape(blocks, _BLOCK)
    some = table[np.unique(np.linspace(0, blocks - 1, _LOOKED_AT).astype(int))]
    tolerance = _FINE / (_BLOCK * usual)
    count = int(np.ceil(_SPREAD / usual / tolerance))
    tried = 1.0 / usual + tolerance * np.arange(-count, count + 1)
    sums = [np.abs(np.exp(-2j * np.pi * each * some).sum(axis=1)).sum() for each in tried]
    frequency = float(tried[int(np.argmax(sums))])
    phases = np.exp(-2j * np.pi * frequency * table).sum(axis=1)
    centres = table.mean(axis=1)
    group = 1
    while group < blocks:
        group *= _GROUP
        edges = np.arange(0, blocks, group)
        tried = tolerance * np.linspace(-1.0, 1.0, 8 * _GROUP + 1)
        turned = phases * np.exp(-2j * np.pi * tried[:, None] * centres)
        sums = np.abs(np.add.reduceat(turned, edges, axis=1)).sum(axis=1)
        change = float(tried[int(np.argmax(sums))])
        frequency += change
        phases = phases * np.exp(-2j * np.pi * change * centres)
        tolerance *= 2.0 / _GROUP
    # If one clock drifts against the other: its phase over groups of blocks.
    edges = np.arange(0, blocks, _GROUP)
    drifting = np.add.reduceat(phases, edges)
    if np.abs(drifting).sum() < _COHERENT * table.size:
        return None
    centre = np.add.reduceat(centres, edges) / np.diff(np.append(edges, blocks))
    drift = np.unwrap(np.angle(drifting)) / (2.0 * np.pi)
    if np.abs(np.diff(drift)).max(initial=0.0) > _FINE:
        return None
    return np.asarray(frequency * time + np.interp(time, centre, drift))


def _beginning(phase: Array) -> float:
    """Return the phase at which a period begins: before the most frequent phase, at the minimum of the histogram."""
    height = np.bincount((phase * _BINS).astype(int) % _BINS, minlength=_BINS).astype(float)
    smooth = sum(
        (np.roll(height, k) for k in range(-(_SMOOTH // 2), _SMOOTH // 2 + 1)), 0.0 * height
    )
    low = float(smooth.min())
    limit = low + _EDGE * (float(smooth.max()) - low)
    place = int(np.argmax(smooth))
    while smooth[place % _BINS] > limit:
        place -= 1
    while smooth[(place - 1) % _BINS] < smooth[place % _BINS]:
        place -= 1
    return (place + 0.5) / _BINS


def _by_positions(number: Whole, position: Array) -> Whole:
    """Return numbers with jumps moved by a few rows if the positions clearly show it."""
    passed, change = np.diff(number), np.zeros(number.size - 1, dtype=np.int64)
    steps = Steps.of(number, position)
    known = np.sum(steps.speed**2, axis=1)
    clear = known > 1.0 / _CLEAR**2
    seen = np.sum(steps.speed * steps.travel, axis=1) / np.where(clear, known, 1.0)
    wanted = np.maximum(np.rint(seen), 1.0).astype(np.int64)
    change[steps.rows] = np.where(clear, wanted - passed[steps.rows], 0)
    places = np.flatnonzero(change)
    if not places.size:
        return number
    event = np.concatenate([[0], np.cumsum(np.diff(places) > _NEAR)])
    total = np.bincount(event, change[places])
    change[places[total[event] != 0]] = 0
    return np.concatenate([number[:1], number[0] + np.cumsum(passed + change)])


def share_of_stamps(time: Array, number: Whole, position: Array) -> tuple[float, float]:
    """Return the weight of the stamps, against an even clock, in the samples' instants, and its standard error.

    1: samples were taken when their stamps say; 0: on the even clock. The error is infinite where nothing moves.
    """
    steps = Steps.of(number, position)
    period = float(np.polyfit(number, time, 1)[0])
    passed = np.diff(number)[steps.rows]
    late = np.diff(time)[steps.rows] / period - passed
    moved = (steps.speed * late[:, None]).ravel()
    beyond = (steps.travel - steps.speed * passed[:, None]).ravel()
    power = float(moved @ moved)
    if not power:
        return 0.0, np.inf
    share = float(moved @ beyond) / power
    rest = beyond - share * moved
    return share, float(np.sqrt((moved * rest) @ (moved * rest))) / power


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Steps:
    """Travel of moving joints from row to row, in units of its standard deviation: (intervals, joints)."""

    rows: Whole  # intervals without a long gap nearby
    travel: Array
    speed: Array  # per period, over some rows around the interval

    @classmethod
    def of(cls, number: Whole, position: Array) -> Self:
        """Return the travel for rows with these numbers."""
        wide = 2 * _REACH + 1
        periods = number[wide:] - number[:-wide]
        dense = np.flatnonzero(periods <= _DENSE * wide)
        speed = ((position[wide:] - position[:-wide]) / periods[:, None])[dense]
        rows = dense + _REACH
        travel = np.diff(position, axis=0)[rows]
        deviation = np.abs(travel - speed * np.diff(number)[rows, None])
        if not rows.size:
            return cls(rows=rows, travel=travel, speed=speed)
        noise = _NORMAL * np.median(deviation, axis=0) + _FINEST * np.abs(travel).max(axis=0)
        moved = noise > 0.0
        scale = noise[moved]
        return cls(rows=rows, travel=travel[:, moved] / scale, speed=speed[:, moved] / scale)
