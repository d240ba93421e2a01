"""How the sensor's gain is found: by instruments, or by regression on one side where they are weak."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from jointid import _core
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.identification.search.domain import SearchDomain
from jointid.joint.parameters import Parameter
from jointid.problem.problem import Problem
from jointid.problem.terms import WEAK_READING
from jointid.problem.windows import Windows

_CUMULATIVE = "running integrals, as in the thesis"
_LOADED = "friction depends on the sensed load"


def with_instruments(
    problem: Problem,
    penalty: _core.Penalty,
    known: Sequence[Parameter],
    windows: Windows,
    stated: bool,
) -> tuple[Problem, _core.Penalty]:
    """Return problem and penalty ready to search: the reading projected on instruments, if they suffice.

    Before the search domain, which takes the gain's sign and size from the projected reading.

    Gravity and inertia of a rigid link explain the reading, and neither the reading's noise nor friction
    that the model lacks is correlated with them: the gain by two-stage least squares is free of the bias
    that either side of a regression has. A vertical axis whose inertia is free, or one that hardly moves,
    has no such motion: then the reading is regressed on the torque, whose noise is the smaller one.

    Parameters
    ----------
    problem : Problem
        Its choice has the residual "instruments", or another one, which is left as it is.
    penalty : Penalty
        Over `windows`, of which it projects the reading.
    known : sequence of Parameter
        What joint and call state of each parameter of the penalty; one that is fixed is no instrument.
    windows : int, float, str, WindowOptions or None
    stated : bool
        Whether the caller asked for this residual, which then is not replaced.

    Raises
    ------
    InputError
        The caller asked for instruments and for friction that depends on the load.
    """
    if penalty.residual != _core.Residual.instruments:
        return problem, penalty
    reason = _CUMULATIVE if penalty.cumulative else ""
    if problem.choice.model.resolved.load_friction:
        reason = _LOADED
        if stated:
            raise InputError(
                "it cannot be combined with friction that depends on the sensed load",
                argument="residual",
                value="instruments",
                remedy=Action("call", {"residual": "sensor"}),
            )
    if stated or not reason:
        free = [index for index, each in enumerate(known) if each.vary]
        penalty.project_reading(free, threads=problem.threads)
        stage = penalty.first_stage
        reason = WEAK_READING if stage is not None and stage.weak else ""
    if stated or not reason:
        return problem, penalty
    choice = replace(problem.choice, residual="sensor", residual_reason=reason)
    problem = replace(problem, choice=choice)
    return problem, problem.penalty(windows)


def penalty_as_fitted(problem: Problem, windows: Windows, domain: SearchDomain) -> _core.Penalty:
    """Return the penalty of a problem whose residual is settled, as a search or a refit needs it.

    Parameters
    ----------
    problem : Problem
    windows : int, float, str, WindowOptions or None
    domain : SearchDomain

    Raises
    ------
    InputError
        Windows that cannot be cut.
    """
    penalty = problem.penalty(windows)
    if penalty.residual == _core.Residual.instruments:
        bounds = zip(domain.lower, domain.upper, strict=True)
        free = [index for index, (low, high) in enumerate(bounds) if low < high]
        penalty.project_reading(free, threads=problem.threads)
    return penalty
