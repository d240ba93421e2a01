"""Slow motion that contradicts the friction of faster motion: creep, and what to leave out of it.

A joint that creeps for long below a few per cent of its peak speed shows friction that varies by position and
history. A motion that only passes through slow speeds holds little of it, and keeps it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.estimate.slow_motion import SlowMotion
from jointid.problem.problem import Problem

Array = NDArray[np.float64]

_SPEEDS = (0.01, 0.015, 0.02, 0.025, 0.03, 0.04, 0.05)  # of the peak speed
_DWELL = 3.0  # times the share of time that an oscillation spends below a speed
_LEAST_SHARE, _LARGEST_SHARE = 0.05, 0.35  # of the time
_CONTRADICTS = 3.0  # standard errors of independent windows
_WEIGHTY = 0.25  # of the dry friction


def slow_disagreement(
    columns: Array,
    target: Array,
    *,
    velocity: Array,
    duration: Array,
    one_way: NDArray[np.bool_],
    speed: float,
    coulomb: int,
) -> SlowMotion | None:
    """Return how windows slower than a speed disagree with the faster ones; None if none are slow.

    Least squares over all windows, in which the slow ones have a dry friction of their own.

    Parameters
    ----------
    columns : ndarray, shape (windows, p)
        Window integrals of the terms, at the shapes of the estimate.
    target : ndarray, shape (windows,)
        Integrals of the torque.
    velocity : ndarray, shape (windows,)
        Mean velocity of each window.
    duration : ndarray, shape (windows,)
        Integrated time [s].
    one_way : ndarray of bool, shape (windows,)
        Windows without a reversal: only these can be slow.
    speed : float
        [rad/s or m/s]
    coulomb : int
        Column of the dry friction.
    """
    slow = one_way & (np.abs(velocity) < speed)
    if np.count_nonzero(slow) < 3 or np.count_nonzero(~slow) < columns.shape[1] + 3:
        return None
    weight = 1.0 / np.sqrt(duration)
    own = np.where(slow, np.sign(velocity) * duration, 0.0)
    # The triangle has all that least squares needs; BLAS on tall matrices changes the last bits with its threads.
    tall = np.column_stack([columns, own, target]) * weight[:, None]
    both = np.asarray(_core.triangle(tall))
    sizes = np.linalg.norm(both[:, :-1], axis=0)
    rows, wanted = both[:, :-1] / np.where(sizes > 0.0, sizes, 1.0), both[:, -1]
    found, _, rank, _ = np.linalg.lstsq(rows, wanted, rcond=1e-10)
    missed = wanted - rows @ found
    variance = float(missed @ missed) / max(1, len(target) - int(rank))
    others, _ = np.linalg.qr(rows[:, :-1])
    alone = rows[:, -1] - others @ (others.T @ rows[:, -1])
    size = float(alone @ alone)
    if size < 1e-12:
        return None
    return SlowMotion(
        speed=speed,
        excess=float(found[-1] / sizes[-1]),
        stderr=float(np.sqrt(variance / size) / sizes[-1]),
        level=float(found[coulomb] / max(sizes[coulomb], 1e-300)),
        share=float(duration[slow].sum() / duration.sum()),
        applied=False,
    )


def contradicting(problem: Problem, penalty: _core.Penalty) -> SlowMotion | None:
    """Return the slow motion that contradicts, at the least speed that holds it; None if there is none.

    Slow motion contradicts when the joint dwells in it, three times longer than an oscillation does, and its
    dry friction differs by more than three standard errors and a quarter of that of the faster windows.
    Models whose friction depends on slow motion, and cumulative windows, are not asked.
    """
    names = list(penalty.names)
    if len(names) > penalty.coefficients or penalty.cumulative or "coulomb" not in names:
        return None
    bounds, run = np.asarray(penalty.windows), np.asarray(penalty.recording_of)
    duration = np.asarray(penalty.usable_duration)
    velocity, one_way = np.zeros(len(run)), np.zeros(len(run), dtype=bool)
    for number, recording in enumerate(problem.recordings):
        mine = slice(*np.searchsorted(run, (number, number + 1)))
        first, last = bounds[mine, 0], bounds[mine, 1]
        moved = recording.position[last] - recording.position[first]
        velocity[mine] = moved / (recording.time[last] - recording.time[first])
        sign = np.sign(recording.velocity)
        turned = np.concatenate([[0], np.cumsum(sign[1:] != sign[:-1])])
        one_way[mine] = turned[last] == turned[first]
    peak = problem.peak_speed
    total = float(duration.sum())
    columns = None
    for part in _SPEEDS:
        slow = one_way & (np.abs(velocity) < part * peak)
        share = float(duration[slow].sum()) / total
        if not max(_LEAST_SHARE, _DWELL * 2.0 / np.pi * part) < share < _LARGEST_SHARE:
            continue
        if columns is None:
            columns = np.asarray(penalty.columns(np.zeros(0)))
        found = slow_disagreement(
            columns,
            np.asarray(penalty.target),
            velocity=velocity,
            duration=duration,
            one_way=one_way,
            speed=part * peak,
            coulomb=names.index("coulomb"),
        )
        if (
            found is not None
            and abs(found.excess) > _CONTRADICTS * found.stderr
            and abs(found.excess) > _WEIGHTY * abs(found.level)
        ):
            return replace(found, applied=True)
    return None
