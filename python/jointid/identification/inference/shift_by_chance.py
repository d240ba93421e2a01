"""How much of a shift of the parameters is chance: what it owes to each segment of the motion tells.

A derived velocity that is measured once more is smoothed once more, and loses some of the noise that it had. That
moves the parameters by chance, in every draw alike, and the standard errors know of it already. But each segment of
the motion then moves them its own way, while a bias moves them the same way in all.

That holds of what is linear in the velocity. Friction that is curved at low speed is biased at each reversal, and by
more at one than at another: there the spread over segments is no chance, and nothing is taken off.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.segments import Segments
from jointid.identification.inference.motion import Motion
from jointid.problem.problem import Problem

Array = NDArray[np.float64]


def variance_over_segments(
    problem: Problem,
    other: Problem,
    penalty: _core.Penalty,
    best: Array,
    free: Sequence[int],
    segments: Segments,
) -> Array:
    """Return the variance by chance of the parameters' change from one problem's velocities to another's.

    Parameters
    ----------
    problem, other : Problem
    penalty : Penalty
        The first one's.
    best : ndarray, shape (p,)
        Its minimum.
    free : sequence of int
    segments : Segments
        Segments of its motion.

    Returns
    -------
    ndarray, shape (p,)
        To first order; 0 for what is not free, and for friction that is not linear in the velocity.

    Raises
    ------
    InputError
        With the other velocities the joint seems to stand still.
    """
    chosen = list(free)
    options = _core.WindowOptions(
        duration=penalty.window_duration, cumulative=bool(penalty.cumulative)
    )
    there = other.penalty(options)
    if penalty.residual == _core.Residual.instruments:
        there.project_reading(chosen, threads=problem.threads)
    before, square = _scores(penalty, best, chosen)
    after, _ = _scores(there, best, chosen)
    size = np.sqrt(np.diag(square))
    size = np.where(size > 0.0, size, 1.0)
    inverse = np.linalg.pinv(square / np.outer(size, size), rcond=1e-10) / np.outer(size, size)
    # Standing still is seen elsewhere, and windows are not quite the same: they are found by their time.
    clocks = [_clock(each, made) for each, made in ((problem, penalty), (other, there))]
    found = np.zeros((len(segments.cuts), len(best)))
    for row, cuts in zip(found, segments.cuts, strict=True):
        sums = np.zeros((2, len(cuts) - 1, len(chosen)))
        for each, clock, scores in zip(sums, clocks, (before, after), strict=True):
            place = np.searchsorted(clocks[0][cuts[:-1]], clock, side="right") - 1
            np.add.at(each, np.maximum(place, 0), scores)
        moved = -np.einsum("sp,pq->sq", sums[1] - sums[0], inverse)
        count = len(moved)
        row[chosen] = np.var(moved, axis=0) * count**2 / max(1, count - 1)
    return np.asarray(np.where(_is_curved(penalty), 0.0, found.mean(axis=0)))


def _is_curved(penalty: _core.Penalty) -> NDArray[np.bool_]:
    """Which parameters belong to friction of a shape: its coefficients and the shape itself."""
    curved = [bool(term.friction and term.shapes) for term in penalty.terms]
    return np.array(curved + [True] * (len(penalty.names) - len(curved)))


def _scores(penalty: _core.Penalty, best: Array, free: list[int]) -> tuple[Array, Array]:
    """Each window's pull at the parameters, and the product of the Jacobian with itself."""
    _, residual, jacobian = penalty.linearised(best)
    columns = jacobian[:, free]
    return columns * residual[:, None], np.einsum("ni,nj->ij", columns, columns)


def _clock(problem: Problem, penalty: _core.Penalty) -> Array:
    """Beginnings of the windows, one recording after the other."""
    motion = Motion.of(problem, penalty)
    first = np.array([run.time[0] for run in problem.recordings])
    lasting = np.array(
        [run.time[-1] - run.time[0] + run.sample_period for run in problem.recordings]
    )
    begin = np.concatenate([[0.0], np.cumsum(lasting)])[:-1]
    return np.asarray(motion.start + (begin - first)[motion.recording])
