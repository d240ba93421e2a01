"""Make an estimate from the minimum of the penalty: errors, correlations, statistics, findings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.covariance import Triangle, parameter_covariance
from jointid.estimate.causes import Cause, Causes
from jointid.estimate.delays import Delay
from jointid.estimate.estimate import Estimate
from jointid.estimate.statistics import Convergence, ResidualStatistics
from jointid.identification.causes.residual_test import correlated, suspicious, testable
from jointid.identification.inference.added_noise import Shifts
from jointid.identification.inference.bound_intervals import held_intervals
from jointid.identification.inference.inference import (
    freedom_of,
    joint_of,
    parameters_of,
    statistics_of,
)
from jointid.identification.inference.motion import Motion, motion_segments
from jointid.identification.inference.offset_or_asymmetry import divided, with_undivided
from jointid.identification.inference.own_noise import own_systematic
from jointid.identification.inference.purposes import Torques, within
from jointid.identification.inference.systematic import (
    admissible_shifts,
    lacking_torques,
    systematic_errors,
)
from jointid.identification.inference.velocity_noise import velocity_systematic
from jointid.identification.plain_least_squares import second_look
from jointid.identification.refinements.refinements import Refinements
from jointid.identification.search.domain import SearchDomain
from jointid.identification.search.run import Balance
from jointid.identification.warnings.diagnosis import diagnose
from jointid.identification.warnings.evidence import Evidence, regressor
from jointid.identification.warnings.inspection import inspect
from jointid.identification.warnings.poor_fit import POORLY_EXPLAINED
from jointid.problem.constant_torque import undivided
from jointid.problem.inner_products import column_sizes, columns_with, size
from jointid.problem.problem import Problem
from jointid.problem.window_table import WindowTable
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

# Smallest component of the weakest direction for which a parameter is named.
_NAMED = 0.3
# Largest unexplained share of the variance with a cause that makes a useless model useful.
_SOMETHING = 0.5


def infer(
    *,
    problem: Problem,
    penalty: _core.Penalty,
    domain: SearchDomain,
    best: Array,
    balance: Balance | None,
    shifts: Shifts,
    beside: Mapping[str, Array | None],
    convergence: Convergence | None,
    status: str,
    message: str,
    settings: dict[str, Any],
    seconds: float,
    refinements: Refinements,
    recordings: Sequence[Recording],
    known: tuple[Cause, ...] = (),
    attribute: bool = True,
) -> Estimate:
    """Return the estimate at a minimum.

    Parameters
    ----------
    balance : tuple or None
        Result of the penalty's `balance_at` at the minimum; None: computed here.
    shifts : tuple of ndarray or None
        Change of each parameter when the windows are halved and doubled.
    refinements : Refinements
        Corrections of the data before the search.
    recordings : sequence of Recording
        Recordings of the call, without corrections.
    beside : mapping of str to ndarray or None
        Change of each parameter by error sources that the residuals do not show.
    known : tuple of Cause
        Causes that were removed from the data before the fit.
    attribute : bool
        Whether to search for the causes of the residual. Default True.
    """
    threads = problem.threads
    # Arrays with one value per window are freed early, because a recording of an hour fills the memory.
    value, residual, jacobian, columns = balance or penalty.balance_at(best)
    sizes = column_sizes(jacobian)
    noise = size(residual) / np.sqrt(max(1, len(residual) - len(best)))
    # Error of each parameter if all others were known.
    alone = noise / np.where(sizes > 0.0, sizes, 1.0)
    freedom = freedom_of(domain, best, columns_with(jacobian, residual), alone)
    free = list(freedom.indices)
    table = problem.table(penalty, best, (residual, columns))
    names = list(domain.names)
    groups = undivided([names[index] for index in free])
    kept = divided(free, names, groups)
    free_jacobian = jacobian[:, kept]
    centre = _centre(penalty, columns, kept)
    apart = penalty.cumulative  # then the windows of the table differ from those of the penalty
    motion = Motion.of(problem, penalty) if apart else Motion.of_table(table)
    segments = motion_segments(motion)
    # One decomposition serves the covariance and all terms that the model may lack.
    lacking = lacking_torques(problem, penalty, best) if kept else {}
    triangle = Triangle(np.column_stack([free_jacobian, *lacking.values()]), threads)
    own = triangle.matrix[: len(kept), : len(kept)]
    spread = parameter_covariance(
        free_jacobian, residual, centre, own, threads=threads, segments=segments
    )
    divisible = spread
    torques = Torques.of(penalty, jacobian, best)
    spread = with_undivided(spread, kept, free, names, groups)
    held = held_intervals(
        jacobian,
        residual,
        kept,
        {
            index: float(best[index])
            for index, side in enumerate(freedom.at_bound[: penalty.coefficients])
            if side is not None
        },
        segments,
        threads,
    )
    del jacobian
    instant = refinements.sensor_instant
    unknown = 1.0 if instant is None else instant.unknown
    counted = admissible_shifts(penalty, shifts)
    parts = systematic_errors(kept, len(best), triangle, lacking, counted, unknown)
    del lacking
    lags = {each.signal: _unknown(each) for each in refinements.delays.values()}
    if any(lags.values()):
        from jointid.identification.inference.delay_errors import of_lags

        parts["lag"] = np.zeros(len(best))
        parts["lag"][kept] = of_lags(problem, penalty, best, free_jacobian, lags)
    effect = velocity_systematic(
        problem, penalty, best, domain.lower, domain.upper, counted, kept, segments
    )
    del motion, segments
    if effect is not None:
        parts["velocity"] = np.where(np.isin(np.arange(len(best)), free), effect.systematic, 0.0)
    own_noise = own_systematic(problem, penalty, best, domain.lower, domain.upper, counted)
    if own_noise is not None:
        moved_by = own_noise.effect.systematic
        parts["extra"] = np.where(np.isin(np.arange(len(best)), free), moved_by, 0.0)
    for noisy in (effect, None if own_noise is None else own_noise.effect):
        if noisy is not None and "windows" in parts:
            # Other windows have other noise at their edges. It is random, or already counted with the velocity.
            beyond = np.square(parts["windows"]) - np.square(noisy.of_windows)
            parts["windows"] = np.sqrt(np.maximum(0.0, beyond))
    parts |= {name: moved for name, moved in beside.items() if moved is not None}
    del free_jacobian
    if not penalty.is_linear:
        columns = penalty.linear_columns(best)
    at_best = regressor(penalty, columns, threads)
    del columns
    parameters = parameters_of(problem, penalty, domain, best, freedom, spread, parts, shifts, held)
    statistics = statistics_of(problem, penalty, table)
    named = sorted(zip(free, np.abs(spread.weakest), strict=True), key=lambda pair: -pair[1])
    weakest = tuple(domain.names[i] for i, share in named if share > _NAMED)
    torque_level = float(np.sqrt(np.mean((penalty.target / penalty.usable_duration) ** 2)))
    causes = None
    run = table.recording
    structured = is_misfit(table, statistics)
    # Running integrals of white noise are correlated.
    noise = not structured and testable(run) and not penalty.cumulative
    # If the sign of the gain is a guess, the residual need not come from the model.
    sought = structured and not domain.guessed_sign and not (penalty.cumulative or not free)
    if sought and attribute:
        from jointid.identification.causes.causes import find_causes

        causes = find_causes(
            problem,
            penalty,
            parameters,
            torque_level=torque_level,
            delays=refinements.delays,
        )
        if effect is not None:
            from jointid.identification.inference.velocity_residual import beyond_velocity_noise

            real = beyond_velocity_noise(problem, penalty, best, free, causes.found)
            causes = replace(causes, found=real)
        explained = statistics.r_squared >= 0.0 or (
            not any(freedom.at_bound)
            and (
                _explained_torque(penalty, table, best) > POORLY_EXPLAINED
                or _explains(causes, statistics.r_squared)
            )
        )
        if not explained:
            causes = None  # the fitted values are not an estimate
        elif not causes.found and testable(run) and not correlated(table.residual, run):
            # The residual is larger at low speed, but has no cause and no correlation: noise of velocity or reversals.
            causes, noise = None, True
    if known:
        more = causes or Causes(found=())
        causes = replace(more, found=(*known, *more.found))
    second = second_look(recordings, problem, penalty, parameters)
    findings = diagnose(
        Evidence(
            problem=problem,
            penalty=penalty,
            best=best,
            residual=residual,
            table=table,
            parameters=parameters,
            chance=dict(zip((domain.names[i] for i in free), spread.stderr, strict=True)),
            residuals=statistics,
            torque_level=torque_level,
            status=status,
            message=message,
            bounds_from_data=domain.from_data,
            guessed_sign=domain.guessed_sign,
            inspections=tuple(
                inspect(run, threads, mends)
                for run, mends in zip(problem.recordings, refinements.mends, strict=True)
            ),
            at_best=at_best,
            causes=causes,
            cause_of=partial(_cause_of, problem, penalty, parameters, torque_level),
            white=noise,
            velocity_effect=effect,
            own_noise=own_noise,
            correlations={
                (domain.names[free[i]], domain.names[free[j]]): float(spread.correlation[i, j])
                for i in range(len(free))
                for j in range(i)
            },
            delays=refinements.delays,
            slow_motion=refinements.slow_motion,
            cross_check=second,
            torques=torques,
        )
    )
    return Estimate(
        parameters=parameters,
        free=tuple(domain.names[i] for i in free),
        status=status,
        message=message,
        penalty=value,
        correlation=spread.correlation,
        condition=spread.condition,
        weakest=weakest,
        covariance=spread.matrix,
        information=spread.information,
        residuals=statistics,
        windows=table,
        convergence=convergence,
        findings=findings,
        joint=joint_of(problem, parameters),
        settings=settings,
        seconds=seconds,
        delays=refinements.delays,
        slow_motion=refinements.slow_motion,
        cross_check=second,
        within=within(parameters, [names[i] for i in kept], divisible, own.T @ own, torques),
    )


def is_misfit(table: WindowTable, statistics: ResidualStatistics) -> bool:
    """Return whether the residuals are more than noise, so that a search for their causes makes sense.

    Noise alone may be most of the measured torque. It is not a model error, and the standard errors contain it.
    """
    run = table.recording
    return suspicious(table.residual, run, table.duration, table.velocity) or (
        statistics.r_squared < POORLY_EXPLAINED and not testable(run)
    )


def _cause_of(*arguments: Any, **more: Any) -> Cause | None:
    """Return the cause that a check requests; imported here because most estimates need no search for causes."""
    from jointid.identification.causes.causes import cause_of

    return cause_of(*arguments, **more)


def _explains(causes: Causes, r_squared: float) -> bool:
    """Return whether the first cause explains enough variance to make a useless model useful."""
    left = (1.0 - causes.found[0].share if causes.found else 1.0) * (1.0 - r_squared)
    return left < _SOMETHING


def _explained_torque(penalty: _core.Penalty, table: WindowTable, best: Array) -> float:
    """Return the share of the torque's variance that the model explains.

    If the sensor reading hardly varies, the model may explain a smaller share of the reading.
    """
    names = list(penalty.names)
    gain = float(best[names.index("sensor_gain")]) if "sensor_gain" in names else 1.0
    torque = np.asarray(penalty.target) / table.duration
    spread = float(
        np.sum(table.duration * (torque - np.average(torque, weights=table.duration)) ** 2)
    )
    left = gain**2 * float(np.sum(table.residual**2 / table.duration))
    return 1.0 - left / spread if spread > 0.0 else 0.0


def _unknown(delay: Delay) -> float:
    """Return the uncertainty of a delay during the identification [s]."""
    if delay.certain:
        return float(np.hypot(delay.left, delay.stderr))
    return delay.stderr if delay.applied else 0.0


def _centre(
    penalty: _core.Penalty, columns: Array, free: list[int]
) -> tuple[int, int, float] | None:
    names = [penalty.names[i] for i in free]
    if not {"sensor_gain", "sensor_offset"} <= set(names):
        return None
    reading = columns[:, penalty.names.index("sensor_gain")].sum()
    mean = float(reading / penalty.usable_duration.sum())
    return names.index("sensor_gain"), names.index("sensor_offset"), mean
