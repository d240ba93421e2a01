"""Whether the torque balance fits better with a signal shifted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.problem.problem import Problem
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

# Stribeck speeds, of the peak speed: so dense that what they leave of any decay is less than a delay.
_DECAYS = (0.01, 0.02, 0.03, 0.045, 0.065, 0.1, 0.15, 0.25)


def fits_better(before: Problem, after: Problem, least: float, *, reversals: bool = True) -> bool:
    """Whether the sum of squared residuals falls by more than a share from one problem to the other.

    Parameters
    ----------
    before, after : Problem
        The second has the same recordings with a signal shifted; samples that it lacks are left out of both.
    least : float
        The share.
    reversals : bool
        Whether windows with a reversal count. Friction jumps there between two samples: no signal that is smooth
        has anything to say to it.
    """
    rows = tuple(
        _rows_of(run, other) for run, other in zip(before.recordings, after.recordings, strict=True)
    )
    without = _misfit(after, reversals)
    return without < (1.0 - least) * _misfit(replace(before, recordings=rows), reversals)


def _misfit(problem: Problem, reversals: bool) -> float:
    """Share of the torque's integrals that the terms do not explain, whatever their coefficients."""
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
    columns, target = columns * weight[:, None], np.asarray(penalty.target) * weight
    # The triangle has all that least squares needs; BLAS on tall matrices changes the last bits with its threads.
    both = np.asarray(_core.triangle(np.column_stack([columns, target]), threads=problem.threads))
    columns, target = both[:, :-1], both[:, -1]
    sizes = np.linalg.norm(columns, axis=0)
    columns = columns / np.where(sizes > 0.0, sizes, 1.0)
    found = np.linalg.lstsq(columns, target, rcond=1e-10)[0]
    missed = target - columns @ found
    return float(missed @ missed) / max(float(target @ target), 1e-300)


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
