"""How parameters change when windows are halved and doubled."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.identification.inference.measuring_again import Shifts
from jointid.identification.search.domain import SearchDomain
from jointid.problem.constant_torque import with_fixed_offset
from jointid.problem.problem import Problem
from jointid.problem.windows import Windows

Array = NDArray[np.float64]


def other_windows(
    problem: Problem, penalty: _core.Penalty, domain: SearchDomain, windows: Windows, best: Array
) -> Callable[[], Shifts]:
    """Begin to look for the minima with other windows; what is returned waits for them, and returns the changes.

    Of windows halved and of windows doubled; None where there are no such windows.
    """
    lower, upper = with_fixed_offset(domain.names, domain.lower, domain.upper, best)
    if penalty.cumulative or not penalty.is_linear:  # their rows are no sums
        found = _refitted(problem, penalty, windows, lower, upper, best)
        return lambda: found
    work = _core.window_shifts(
        penalty,
        recordings=problem.in_core,
        terms=list(problem.choice.terms),
        mask_standstill=problem.mask_standstill,
        gear_ratio=problem.choice.gear_ratio,
        per_recording=list(problem.choice.per_recording),
        lower=lower,
        upper=upper,
        best=best,
        threads=problem.threads,
    )

    def changes() -> Shifts:
        halved, doubled = work.result()
        return (
            None if halved is None else halved - best,
            None if doubled is None else doubled - best,
        )

    return changes


def _refitted(
    problem: Problem,
    penalty: _core.Penalty,
    windows: Windows,
    lower: Array,
    upper: Array,
    best: Array,
) -> Shifts:
    """Return the same by windows that are cut anew."""
    options = problem.window_options(windows)
    changes: list[Array | None] = []
    for factor in (0.5, 2.0):
        try:
            other = problem.parts(options.replace(factor=options.factor * factor))
        except InputError:  # fewer windows than parameters, or longer than the recording
            changes.append(None)
            continue
        if other.window_count == penalty.window_count:
            changes.append(None)
            continue
        found = other.refit(lower, upper, best, threads=problem.threads)
        changes.append(found - best)
    return changes[0], changes[1]
