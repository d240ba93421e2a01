"""Preparation of an identification before its search: recordings, terms, windows and search domain."""

from __future__ import annotations

import functools
import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.base.argument_checks import whole_number
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.estimate.causes import Cause
from jointid.estimate.estimate import Estimate
from jointid.estimate.prediction import FittedModel
from jointid.estimate.selection import Selection
from jointid.identification.chosen_model import chosen_without_delays
from jointid.identification.conclusion import infer, is_misfit
from jointid.identification.drift import may_drift, without_drift
from jointid.identification.follow_up import EstimateSource
from jointid.identification.gain import penalty_as_fitted, with_instruments
from jointid.identification.inference.fact_tolerances import of_given_facts
from jointid.identification.inference.offset_or_asymmetry import of_symmetry
from jointid.identification.inference.own_noise import measured_once_more
from jointid.identification.inference.residual_side import of_residual_side
from jointid.identification.inference.systematic import other_windows
from jointid.identification.refinements.refinements import (
    Refinements,
    without_creep,
    without_delays,
)
from jointid.identification.refinements.sensor_instant import (
    SensorInstant,
    without_early_reading,
)
from jointid.identification.search.domain import SearchDomain, domain_for
from jointid.identification.search.run import Outcome, run_search
from jointid.identification.search.search import Search
from jointid.identification.search.stated_bounds import known_parameters
from jointid.joint.joint import Joint
from jointid.joint.model import AUTO
from jointid.joint.own_terms import INERTIA
from jointid.problem.constant_torque import balanced
from jointid.problem.problem import Problem
from jointid.problem.settings import USUAL, Settings
from jointid.problem.terms import Request, TermChoice, choose_terms
from jointid.recording.corrections import Mend, mended
from jointid.recording.motion import raise_if_hardly_moving, raise_if_still
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_STEADIER = 0.7  # largest residual of a second fit without the drift, relative to the first fit


@dataclass(frozen=True, slots=True, kw_only=True)
class Prepared:
    """Penalty to minimize and domain to search.

    Attributes
    ----------
    problem : Problem
    penalty : Penalty
        Direct sum over the windows.
    domain : SearchDomain
    settings : Settings
        Settings of the call.
    given : tuple of Recording
        Recordings of the call. Those of `problem` may be shifted.
    refinements : Refinements
        Corrections of the data, with their reasons.
    selection : Selection or None
        Choice of the model; None if the caller named it.
    """

    problem: Problem
    penalty: _core.Penalty
    domain: SearchDomain
    settings: Settings
    given: tuple[Recording, ...]
    refinements: Refinements
    selection: Selection | None = None

    def estimate(
        self,
        search: Search,
        outcome: Outcome,
        started: float,
        attribute: bool = True,
    ) -> Estimate:
        """Return the estimate from the outcome of a search: intervals, checks, findings.

        Parameters
        ----------
        search : Search
        outcome : Outcome
        started : float
            Reading of `time.perf_counter` at the start of the identification.
        attribute : bool
            Whether to search for the causes of the residual. If not, the estimate's source finds them later. If a
            drift may have to be removed, the search takes place in any case. Default True.
        """
        estimate = self._inferred(search, outcome, started, attribute)
        left = not attribute and is_misfit(estimate.windows, estimate.residuals)
        if left and may_drift(self.problem, self.penalty, estimate.parameters):
            return self.estimate(search, outcome, started)
        steady = without_drift(self.problem, self.penalty, estimate)
        fitted = self
        known: tuple[Cause, ...] = ()
        if steady is not None:
            problem, drift = steady
            penalty = penalty_as_fitted(problem, self.settings.windows, self.domain)
            other = replace(self, problem=problem, penalty=penalty)
            found = run_search(search, other.penalty, other.domain)
            again = other._inferred(search, found, started, known=(drift,))
            if again.residuals.rms < _STEADIER * estimate.residuals.rms:
                estimate, fitted, known = again, other, (drift,)
        source = EstimateSource(
            problem=fitted.problem,
            given=self.given,
            known=known,
            domain=self.domain,
            windows=self.settings.windows,
            search=search,
            again=functools.partial(self._again, search),
            attributed=functools.partial(self.estimate, search, outcome, started) if left else None,
        )
        return replace(estimate, follow_up=source, selection=self.selection)

    def fitted(self, search: Search, outcome: Outcome) -> FittedModel:
        """Return the fitted model for predictions, without intervals and findings.

        Parameters
        ----------
        search : Search
        outcome : Outcome
        """
        domain = self.domain
        best = balanced(domain.names, domain.lower, domain.upper, outcome.best)
        values = dict(zip(domain.names, best.tolist(), strict=True))
        return FittedModel(settings=self._choices(search), joint=self.problem.joint, values=values)

    def _inferred(
        self,
        search: Search,
        outcome: Outcome,
        started: float,
        attribute: bool = True,
        known: tuple[Cause, ...] = (),
    ) -> Estimate:
        """Return the estimate at one minimum; `known` are causes that were removed before the fit."""
        domain = self.domain
        best = balanced(domain.names, domain.lower, domain.upper, outcome.best)
        known_there = outcome.balance if np.array_equal(best, outcome.best) else None
        return infer(
            problem=self.problem,
            penalty=self.penalty,
            domain=domain,
            best=best,
            balance=known_there,
            shifts=other_windows(self.problem, self.penalty, domain, self.settings.windows, best),
            beside={
                "residual_side": of_residual_side(
                    self.problem, self.settings.windows, domain, best
                ),
                "given": of_given_facts(self.problem, self.settings.windows, domain, best),
                "symmetry": of_symmetry(self.problem.joint, domain, best),
            },
            convergence=outcome.convergence,
            status=outcome.status,
            message=outcome.message,
            settings=self._settings(search)
            | {f"{each.name}_removed": each.detail for each in known},
            seconds=time.perf_counter() - started,
            refinements=self.refinements,
            recordings=self.given,
            known=known,
            attribute=attribute,
        )

    def _again(self, search: Search, recordings: tuple[Recording, ...]) -> Estimate:
        """Return the estimate from other recordings with the same terms, windows and domain."""
        started = time.perf_counter()
        problem = replace(self.problem, recordings=recordings)
        penalty = penalty_as_fitted(problem, self.settings.windows, self.domain)
        refinements = replace(self.refinements, mends=((),) * len(recordings))
        other = replace(self, problem=problem, penalty=penalty, refinements=refinements)
        quick = Search("separable", seed=search.seed, threads=search.threads)
        return other.estimate(quick, run_search(quick, other.penalty, other.domain), started)

    def _settings(self, search: Search) -> dict[str, Any]:
        runs = [{"name": run.name, "fingerprint": run.fingerprint} for run in self.given]
        return {**self._choices(search), "recordings": runs}

    def _choices(self, search: Search) -> dict[str, Any]:
        """Return the settings without the recordings, because a fingerprint reads every byte."""
        problem, penalty, choice = self.problem, self.penalty, self.problem.choice
        return {
            "version": _core.__version__,
            "kind": self.given[0].kind,
            "method": search.chosen_method,
            "model": str(choice.model.resolved),
            "terms": list(choice.terms),
            "dropped": choice.dropped,
            **_of_own_inertia(problem),
            "residual": choice.residual,
            **_of_gain(choice, penalty),
            "windows": penalty.window_duration,
            "cumulative": penalty.cumulative,
            **problem.settings.kept,
            **_of_instant(self.refinements.sensor_instant),
            "seed": search.seed,
            "ga": None if search.chosen_method == "separable" else search.genetic.asdict(),
            "bounds_from_data": list(self.domain.from_data),
        }


def _of_instant(instant: SensorInstant | None) -> dict[str, Any]:
    """Return, as a setting, the share of half a torque step that was added to the reading."""
    return (
        {"sensor_before_step": instant.applied} if instant is not None and instant.applied else {}
    )


def _of_own_inertia(problem: Problem) -> dict[str, Any]:
    """Return the mean of each inertia signal, for users of the joint without the recordings."""
    means = {
        own.signal: float(np.mean([np.mean(run.extra[own.signal]) for run in problem.recordings]))
        for own in problem.choice.model.resolved.terms.each
        if own.kind in INERTIA and not own.rate
    }
    return {"mean_inertia": means} if means else {}


def _of_gain(choice: TermChoice, penalty: _core.Penalty) -> dict[str, Any]:
    """Return the estimation method of the sensor gain, as settings."""
    if choice.residual_reason:
        return {"residual_reason": choice.residual_reason}
    stage = penalty.first_stage
    if stage is None:
        return {}
    return {"instruments": {"acceleration": stage.acceleration, "strength": stage.strength}}


def prepare(
    given: tuple[Recording, ...],
    joint: Joint | None,
    settings: Settings = USUAL,
    *,
    threads: int = 0,
    choose: bool = False,
    unfit: Mapping[str, str] | None = None,
    on_time: bool = False,
    measure: bool = True,
    instant: bool = True,
) -> Prepared:
    """Return an identification ready to search.

    Parameters
    ----------
    given : tuple of Recording
        Checked recordings, as `listed` returns them.
    choose : bool
        Whether to choose an unnamed model from the recordings. Default False: the model is coulomb_viscous,
        and the name "auto" is refused.
    unfit : mapping of str to str, optional
        Models that must not be chosen, with the reason. Default: none.
    on_time : bool
        Whether all signals are known to have no delay, as in a simulation. If not, delays are estimated.
        Default False.
    measure : bool
        Whether to estimate delays in addition to those of `shift`. Default True.
    instant : bool
        Whether to estimate the sampling instant of the sensor relative to the steps of a held torque. Default True.

    Raises
    ------
    InputError
        Invalid input.
    """
    raise_if_still(given)
    runs, mends = zip(*(mended(run) for run in given), strict=True)
    require_joint(joint)
    stated, windows = settings.model, settings.windows
    merged = stated if joint is None else stated.over(joint.model)
    if merged.name == AUTO and not choose:
        raise InputError(
            "only identify can choose a model; state the model's name here",
            argument="model",
            value=str(merged),
            remedy=Action("call", {"model": "stribeck"}),
        )
    if joint is not None and stated.stated():
        # Parameters that are separate for each recording of this call do not become a property of the joint.
        joint = joint.replace(model=merged.replace(per_recording=joint.model.per_recording))
    request = Request(model=stated, residual=settings.residual)
    problem = Problem(
        recordings=runs,
        joint=joint,
        choice=choose_terms(runs, joint, request),
        settings=replace(settings, shift={}, min_speed=0.0),  # both are applied below
        threads=whole_number("threads", threads, 0, 1024),
    )
    selection = None
    try:
        if choose and not merged.named:
            problem, delays, selection = chosen_without_delays(
                problem, request, settings, unfit or {}
            )
        elif on_time:
            delays = {}
        else:
            problem, delays = without_delays(problem, settings.shift, measure=measure)
        if problem.settings.torque_hold != settings.torque_hold:
            mends = tuple(
                (*found, Mend(code="held_torque", count=len(run), size=run.sample_period))
                for found, run in zip(mends, runs, strict=True)
            )
        problem, penalty, slow_motion = without_creep(problem, windows, settings.min_speed)
        sensor_instant = None
        if instant:
            problem, penalty, sensor_instant = without_early_reading(problem, penalty, windows)
        known = known_parameters(tuple(penalty.names), problem.joint, settings.parameters)
        problem, penalty = with_instruments(
            problem, penalty, known, windows, settings.residual is not None
        )
        domain = domain_for(penalty, problem.joint, settings.parameters, problem.peak_speed, known)
        own = problem.choice.model.resolved.terms
        if own.each:
            from jointid.identification.search.own_duplicates import refuse_duplicates

            refuse_duplicates(penalty, domain, own, functools.partial(measured_once_more, problem))
    except InputError as error:
        if error.place == "parameters":  # the motion does not excite a parameter
            raise_if_hardly_moving(runs)
        elif not error.argument:  # according to the velocity, the joint stands still
            from jointid.identification.warnings.velocity import raise_if_far_off

            raise_if_far_off(runs)
        raise
    return Prepared(
        problem=problem,
        penalty=penalty,
        domain=domain,
        settings=settings,
        given=given,
        refinements=Refinements(
            mends=mends, delays=delays, slow_motion=slow_motion, sensor_instant=sensor_instant
        ),
        selection=selection,
    )


def require_joint(joint: object) -> None:
    """Refuse a value that is neither a joint nor None."""
    if joint is not None and not isinstance(joint, Joint):
        raise InputError(
            "a Joint is expected; Joint.load reads a joint file", argument="joint", value=joint
        )
