"""Random part of a parameter shift, estimated from the contributions of the motion's segments.

A derived velocity that is measured again is also smoothed again and loses part of its original noise. This shifts the
parameters randomly, but equally in every draw. The standard errors already contain this shift. It differs between
segments of the motion, while a bias is the same in all segments.

This is true for terms that are linear in the velocity. Friction that is nonlinear at low speed has a bias that differs
between reversals. There the spread over segments is not random, and nothing is subtracted.
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
    """Return the random variance of the parameters' change from one problem's velocities to another's.

    Parameters
    ----------
    problem, other : Problem
        Problems with different velocities.
    penalty : Penalty
        Penalty of the first problem.
    best : ndarray, shape (p,)
        Minimum of this penalty.
    free : sequence of int
        Indices of the free parameters.
    segments : Segments
        Segments of the first problem's motion.

    Returns
    -------
    ndarray, shape (p,)
        Variance to first order; 0 for fixed parameters and for friction that is not linear in the velocity.

    Raises
    ------
    InputError
        With the other velocities, the joint seems to stand still.
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
    # The other velocities may have other standstills and other windows, so windows are matched by their time.
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
    """Return which parameters belong to friction with a shape: its coefficients and the shape."""
    curved = [bool(term.friction and term.shapes) for term in penalty.terms]
    return np.array(curved + [True] * (len(penalty.names) - len(curved)))


def _scores(penalty: _core.Penalty, best: Array, free: list[int]) -> tuple[Array, Array]:
    """Return each window's gradient by the free parameters, and the Jacobian's Gram matrix."""
    _, residual, jacobian = penalty.linearised(best)
    columns = jacobian[:, free]
    return columns * residual[:, None], np.einsum("ni,nj->ij", columns, columns)


def _clock(problem: Problem, penalty: _core.Penalty) -> Array:
    """Return the start of each window on one clock, with the recordings one after the other [s]."""
    motion = Motion.of(problem, penalty)
    first = np.array([run.time[0] for run in problem.recordings])
    lasting = np.array(
        [run.time[-1] - run.time[0] + run.sample_period for run in problem.recordings]
    )
    begin = np.concatenate([[0.0], np.cumsum(lasting)])[:-1]
    return np.asarray(motion.start + (begin - first)[motion.recording])
