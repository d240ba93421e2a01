"""Slow motion (creep) that contradicts the friction of faster motion, and its exclusion.

A joint that creeps for a long time below a few percent of its peak speed shows friction that depends on position and
history. A motion that only passes through low speeds contains little creep, and nothing is excluded.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.estimate.slow_motion import SlowMotion
from jointid.problem.problem import Problem

Array = NDArray[np.float64]

_SPEEDS = (0.01, 0.015, 0.02, 0.025, 0.03, 0.04, 0.05)  # shares of the peak speed
_DWELL = 3.0  # multiple of the time share that a sinusoidal motion spends below a speed
_LEAST_SHARE, _LARGEST_SHARE = 0.05, 0.35  # shares of the time
_CONTRADICTS = 3.0  # standard errors of independent windows
_WEIGHTY = 0.25  # share of the dry friction


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
    """Return the disagreement of windows slower than a speed with the faster ones; None if too few are slow.

    This is a least-squares fit over all windows with a separate dry friction for the slow ones.

    Parameters
    ----------
    columns : ndarray, shape (windows, p)
        Window integrals of the terms, at the estimated shapes.
    target : ndarray, shape (windows,)
        Integrals of the torque.
    velocity : ndarray, shape (windows,)
        Mean velocity of each window.
    duration : ndarray, shape (windows,)
        Integrated time [s].
    one_way : ndarray of bool, shape (windows,)
        Windows without a reversal; only these can be slow.
    speed : float
        Speed limit [rad/s or m/s].
    coulomb : int
        Column of the dry friction.
    """
    slow = one_way & (np.abs(velocity) < speed)
    if np.count_nonzero(slow) < 3 or np.count_nonzero(~slow) < columns.shape[1] + 3:
        return None
    weight = 1.0 / np.sqrt(duration)
    own = np.where(slow, np.sign(velocity) * duration, 0.0)
    # Least squares needs only the triangle. BLAS on tall matrices changes the last bits with its threads.
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
    """Return the contradicting slow motion at the lowest speed that shows it; None if there is none.

    Slow motion contradicts if two conditions hold. The joint moves slowly three times longer than a sinusoidal motion
    does. The dry friction differs from that of the faster windows by more than three standard errors and by more
    than a quarter. Models with friction terms for slow motion, and cumulative windows, are not tested.
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
