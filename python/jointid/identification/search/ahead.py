"""The penalty of a search and its compressed form, begun while delays are still looked for.

Most recordings have no delay that is taken away: then what was begun is what is searched. Else it is let go of.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import cast

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.identification.search.computed_bounds import shape_range
from jointid.identification.search.domain import SearchDomain
from jointid.identification.search.stated_bounds import known_parameters
from jointid.joint.parameters import Parameter
from jointid.problem.problem import Problem
from jointid.problem.recordings import raise_if_slowly_sampled
from jointid.problem.windows import Windows

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Ahead:
    """What was begun, and what it was begun for.

    Attributes
    ----------
    problem : Problem
    names : tuple of str
        The penalty's parameters.
    known : list of Parameter
        What joint and call state of each.
    lower, upper : ndarray, shape (p,)
        The shapes' bounds; 0 for the coefficients, whose bounds a compressed penalty does not depend on.
    work : Beside
        Finds the penalty, then its compressed form.
    """

    problem: Problem
    names: tuple[str, ...]
    known: list[Parameter]
    lower: Array
    upper: Array
    work: _core.Beside

    @classmethod
    def begin(
        cls,
        problem: Problem,
        windows: Windows,
        changes: Mapping[str, float | Mapping[str, object] | Parameter] | None,
    ) -> Ahead | None:
        """Begin; None where that would not be beside the interpreter, and for input that cannot be used.

        Parameters
        ----------
        problem : Problem
        windows : int, float, str, WindowOptions or None
        changes : mapping or None
            Argument `parameters` of the call.
        """
        choice = problem.choice
        if len(problem.recordings) > 1 or choice.model.resolved.load_friction:
            return None
        names, coefficients = _parameters(choice.terms)
        lower, upper = np.zeros((2, len(names)))
        try:
            known = known_parameters(names, problem.joint, changes)
            for index, each in enumerate(known[coefficients:], coefficients):
                lower[index], upper[index] = shape_range(each, problem.peak_speed)
            if np.count_nonzero(lower < upper) > 1:
                return None  # all threads make a table of two shapes sooner
            free = [index for index, each in enumerate(known) if each.vary]
            work = problem.begin_search(windows, free, lower, upper)
        except InputError:
            return None  # it is raised where the same is done again
        if work is None:
            return None
        return cls(problem=problem, names=names, known=known, lower=lower, upper=upper, work=work)

    def penalty(self, problem: Problem, windows: Windows) -> _core.Penalty:
        """Return the problem's penalty over the windows that it was begun with, its reading projected if it can be.

        Raises
        ------
        InputError
            Windows that cannot be cut.
        """
        if problem is not self.problem:
            return problem.penalty(windows)
        try:
            return cast(_core.Penalty, self.work.result())
        except InputError:
            raise_if_slowly_sampled(problem.recordings)
            raise

    def compressed(
        self, penalty: _core.Penalty, domain: SearchDomain
    ) -> _core.CompressedPenalty | None:
        """Return the penalty's compressed form over a domain; None if that is not what was begun."""
        shapes = slice(penalty.coefficients, None)
        begun = (self.lower[shapes].tolist(), self.upper[shapes].tolist())
        if begun != (domain.lower[shapes].tolist(), domain.upper[shapes].tolist()):
            return None
        try:
            if penalty is not self.work.result():
                return None
        except InputError:
            return None  # of the windows without a shift; with it they could be cut
        return cast(_core.CompressedPenalty, self.work.further())


@functools.lru_cache(maxsize=32)
def _parameters(terms: tuple[str, ...]) -> tuple[tuple[str, ...], int]:
    """Return a penalty's parameters, and how many of them are coefficients."""
    rows = [_core.term(key) for key in terms]
    shapes = [name for row in rows for name in row.shapes]
    return tuple(dict.fromkeys([*(row.name for row in rows), *shapes])), len(rows)
