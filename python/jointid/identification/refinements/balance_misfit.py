"""Whether the torque balance predicts better with a signal changed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.identification.selection.block_sums import BlockSums
from jointid.problem.problem import Problem
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

# Stribeck speeds, of the peak speed: so dense that what they leave of any decay is less than a delay.
_DECAYS = (0.01, 0.02, 0.03, 0.045, 0.065, 0.1, 0.15, 0.25)


_BLOCKS = 40
SURE = 3.0  # standard errors of the difference over held-out blocks
_TINY = 1e-30  # a share of the torque's square: rounding


def fits_better(
    before: Problem, after: Problem, least: float, *, sure: float = SURE, reversals: bool = True
) -> bool:
    """Whether one problem's balance predicts held-out blocks clearly better than another's.

    Their sum of squares falls by more than a share, and its logarithm by some standard errors over the blocks.

    Parameters
    ----------
    before, after : Problem
        The second has the same recordings with a signal changed; samples that it lacks are left out of both.
    least : float
        The share.
    sure : float
        Standard errors. Default 3.
    reversals : bool
        Whether windows with a reversal count. Friction jumps there between two samples: no signal that is smooth
        has anything to say to it.
    """
    rows = tuple(
        _rows_of(run, other) for run, other in zip(before.recordings, after.recordings, strict=True)
    )
    missed = _missed(replace(before, recordings=rows), reversals)
    without = _missed(after, reversals)
    if not float(np.sum(without)) < (1.0 - least) * float(np.sum(missed)):
        return False
    # Of ratios: blocks of lively motion have a hundred times the misfit of others.
    gain = np.log(np.maximum(missed, _TINY) / np.maximum(without, _TINY))
    return float(np.mean(gain)) > sure * float(np.std(gain, ddof=1) / np.sqrt(len(gain)))


def _missed(problem: Problem, reversals: bool) -> Array:
    """Share of the torque's integrals in each block that the terms, fitted to all others, do not explain."""
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
    missed = sums.fitted(np.eye(rows.shape[1])[None]).missed[0]
    return np.asarray(missed / max(float(np.sum(sums.products[:, -1, -1])), 1e-300))


def _in_one_direction(problem: Problem, penalty: _core.Penalty) -> NDArray[np.bool_]:
    """Windows in which the joint does not turn round."""
    windows = np.asarray(penalty.windows, dtype=np.int64)
    run_of = np.asarray(penalty.recording_of, dtype=np.int64)
    found = np.empty(len(windows), dtype=bool)
    for index, run in enumerate(problem.recordings):
        direction = np.sign(run.velocity)
        changes = np.concatenate([[0], np.cumsum(direction[1:] != direction[:-1])])
        own = run_of == index
        found[own] = changes[windows[own, 1]] == changes[windows[own, 0]]
    return found


def _rows_of(recording: Recording, other: Recording) -> Recording:
    """The samples of a recording at the other's times."""
    kept = np.searchsorted(recording.time, other.time)
    if len(kept) == len(recording):
        return recording
    return recording.with_signals(rows=kept)
