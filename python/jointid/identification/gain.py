"""Estimation of the sensor gain: by instrumental variables, or by a one-sided regression where they are weak."""

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
    """Return problem and penalty ready to search, with the reading projected on instruments if they suffice.

    Call this before the search domain is made: the domain takes the gain's sign and size from the projected reading.

    Gravity and inertia of a rigid link explain the reading. Noise of the reading and friction that the model lacks
    are not correlated with them. Two-stage least squares therefore avoids the bias of a one-sided regression.
    A vertical axis with free inertia, or a joint that hardly moves, has no such instruments. The reading is then
    regressed on the torque, because the torque has less noise.

    Parameters
    ----------
    problem : Problem
        Problem with the residual "instruments". Any other residual is left unchanged.
    penalty : Penalty
        Penalty over `windows`; its reading is projected.
    known : sequence of Parameter
        Value and bounds of each parameter, set by joint and call. A fixed parameter gives no instrument.
    windows : int, float, str, WindowOptions or None
    stated : bool
        Whether the caller set this residual. If so, it is not replaced.

    Raises
    ------
    InputError
        The caller set both residual "instruments" and friction that depends on the load.
    """
    if penalty.residual != _core.Residual.instruments:
        return problem, penalty
    reason = _CUMULATIVE if penalty.cumulative else ""
    if problem.choice.model.resolved.load_friction:
        reason = _LOADED
        if stated:
            raise InputError(
                "this residual cannot be combined with friction that depends on the sensed load",
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
    """Return the penalty for a search or a refit. The residual of the problem is already decided.

    Parameters
    ----------
    problem : Problem
    windows : int, float, str, WindowOptions or None
    domain : SearchDomain

    Raises
    ------
    InputError
        Windows that are invalid for these recordings.
    """
    penalty = problem.penalty(windows)
    if penalty.residual == _core.Residual.instruments:
        bounds = zip(domain.lower, domain.upper, strict=True)
        free = [index for index, (low, high) in enumerate(bounds) if low < high]
        penalty.project_reading(free, threads=problem.threads)
    return penalty
