"""Test whether a changed signal improves the prediction of the torque balance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.problem.block_sums import BlockSums
from jointid.problem.problem import Problem
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

# Stribeck speeds as shares of the peak speed, so dense that the error of any decay is smaller than that of a delay.
_DECAYS = (0.01, 0.02, 0.03, 0.045, 0.065, 0.1, 0.15, 0.25)


_BLOCKS = 40
SURE = 3.0  # standard errors of the difference over held-out blocks
_TINY = 1e-30  # share of the squared torque that is rounding


def fits_better(
    before: Problem, after: Problem, least: float, *, sure: float = SURE, reversals: bool = True
) -> bool:
    """Return whether the balance of `after` predicts held-out blocks clearly better than that of `before`.

    The sum of squares must decrease by more than `least`. Its logarithm over held-out blocks must decrease by more than
    `sure` standard errors.

    Parameters
    ----------
    before, after : Problem
        The second has the same recordings with a changed signal. Samples that it lacks are left out of both.
    least : float
        Smallest relative decrease of the sum of squares.
    sure : float
        Number of standard errors; 0: do not test held-out blocks. Default 3.
    reversals : bool
        Whether windows with a reversal count. Friction jumps there between two samples, which a smooth signal cannot
        show. Default True.
    """
    rows = tuple(
        rows_of(run, other) for run, other in zip(before.recordings, after.recordings, strict=True)
    )
    whole, missed = _missed(replace(before, recordings=rows), reversals)
    whole_without, without = _missed(after, reversals)
    if not whole_without < (1.0 - least) * whole:
        return False
    if sure == 0.0:
        return True
    # Ratios, because blocks with fast motion have a hundred times the squares of others.
    gain = np.log(np.maximum(missed, _TINY) / np.maximum(without, _TINY))
    return float(np.mean(gain)) > sure * float(np.std(gain, ddof=1) / np.sqrt(len(gain)))


def _missed(problem: Problem, reversals: bool) -> tuple[float, Array]:
    """Return the unexplained share of the torque's squares: in the fit, and in each held-out block."""
    terms = [_core.term(key) for key in problem.choice.terms]
    keys = tuple(term.key for term in terms if not term.shapes)
    decays = any(term.shapes for term in terms)
    if decays:
        keys = (*keys, "static")
    choice = replace(
        problem.choice,
        terms=tuple(term.key for term in _core.terms() if term.key in keys)
        + tuple(key for key in keys if key not in {term.key for term in _core.terms()}),
        residual="torque",
    )
    penalty = replace(problem, choice=choice).penalty(None)
    shapes = [(1.0 / (part * problem.peak_speed)) ** 2 for part in _DECAYS] if decays else []
    columns = np.asarray(penalty.columns(np.array(shapes[:1])))
    if decays:
        static = list(penalty.names).index("static")
        others = [np.asarray(penalty.columns(np.array([k])))[:, static] for k in shapes[1:]]
        columns = np.column_stack([columns, *others])
    weight = 1.0 / np.sqrt(np.asarray(penalty.usable_duration))
    if not reversals:
        weight = np.where(_in_one_direction(problem, penalty), weight, 0.0)
    rows = np.column_stack([columns, np.asarray(penalty.target)]) * weight[:, None]
    blocks = np.array_split(np.arange(len(rows)), min(_BLOCKS, len(rows)))
    sums = BlockSums.of(rows, blocks, problem.threads)
    fitted = sums.fitted(np.eye(rows.shape[1])[None])
    size = max(float(np.sum(sums.products[:, -1, -1])), 1e-300)
    return float(fitted.penalty[0]) / size, fitted.missed[0] / size


def _in_one_direction(problem: Problem, penalty: _core.Penalty) -> NDArray[np.bool_]:
    """Return which windows contain no reversal."""
    windows = np.asarray(penalty.windows, dtype=np.int64)
    run_of = np.asarray(penalty.recording_of, dtype=np.int64)
    found = np.empty(len(windows), dtype=bool)
    for index, run in enumerate(problem.recordings):
        direction = np.sign(run.velocity)
        changes = np.concatenate([[0], np.cumsum(direction[1:] != direction[:-1])])
        own = run_of == index
        found[own] = changes[windows[own, 1]] == changes[windows[own, 0]]
    return found


def rows_of(recording: Recording, other: Recording) -> Recording:
    """Return the samples of a recording at the times of the other recording."""
    kept = np.searchsorted(recording.time, other.time)
    if len(kept) == len(recording):
        return recording
    return recording.with_signals(rows=kept)
