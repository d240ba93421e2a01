"""From the minimum of the penalty to an estimate: errors, correlations, statistics, warnings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.estimate.estimate import Estimate
from jointid.estimate.findings import (
    Convergence,
    ParameterEstimate,
    ResidualStatistics,
    WindowTable,
)
from jointid.estimate.student import quantile
from jointid.identification.covariance import Covariance, parameter_covariance, widened
from jointid.identification.diagnosis import diagnose
from jointid.identification.facts import Facts, regressor
from jointid.identification.inner_products import columns_with, inner, size
from jointid.identification.inspection import inspect
from jointid.identification.problem import Problem
from jointid.identification.search_domain import SearchDomain
from jointid.identification.systematic import systematic_errors
from jointid.joint.joint import Joint
from jointid.joint.parameters import Parameter

Array = NDArray[np.float64]

# Components of the weakest direction below this share are not worth naming.
_NAMED = 0.3


@dataclass(frozen=True, slots=True, kw_only=True)
class Freedom:
    """Which parameters were really free, and which ended on a bound."""

    indices: tuple[int, ...]
    at_bound: tuple[str | None, ...]


def infer(
    *,
    problem: Problem,
    penalty: _core.Penalty,
    domain: SearchDomain,
    best: Array,
    shifts: tuple[Array | None, Array | None],
    convergence: Convergence | None,
    status: str,
    message: str,
    settings: dict[str, Any],
    seconds: float,
) -> Estimate:
    """The estimate at a minimum.

    Parameters
    ----------
    shifts : tuple of ndarray or None
        How each parameter moves when the windows are halved and doubled.
    """
    threads = problem.threads
    # Before anything of a window's size is held, and all of that no longer than needed: an hour's
    # recording leaves no room for more.
    inspections = tuple(inspect(run, threads) for run in problem.recordings)
    value, residual, jacobian = penalty.linearised(best)
    columns = penalty.columns(best[penalty.coefficients :])
    sizes = np.linalg.norm(jacobian, axis=0)
    noise = size(residual) / np.sqrt(max(1, len(residual) - len(best)))
    alone = noise / np.where(
        sizes > 0.0, sizes, 1.0
    )  # each parameter's error if it were the only one
    freedom = freedom_of(domain, best, columns_with(jacobian, residual), alone)
    free = list(freedom.indices)
    table = problem.table(penalty, best, (residual, columns))
    freely = jacobian[:, free]
    del jacobian
    centre = _centre(penalty, columns, free)
    by_chance = parameter_covariance(freely, residual, centre, threads=threads)
    systematic = systematic_errors(problem, penalty, best, free, freely, columns, shifts)
    del freely
    spread = widened(by_chance, systematic)
    at_best = regressor(penalty, columns, threads)
    del columns
    parameters = parameters_of(
        problem, penalty, domain, best, freedom, spread, len(residual), shifts
    )
    statistics = _statistics(problem, penalty, table)
    named = sorted(zip(free, np.abs(spread.weakest), strict=True), key=lambda pair: -pair[1])
    weakest = tuple(domain.names[i] for i, share in named if share > _NAMED)
    torque_level = float(np.sqrt(np.mean((penalty.target / penalty.usable_duration) ** 2)))
    warnings = diagnose(
        Facts(
            problem=problem,
            penalty=penalty,
            best=best,
            residual=residual,
            table=table,
            parameters=parameters,
            chance=dict(zip((domain.names[i] for i in free), by_chance.stderr, strict=True)),
            residuals=statistics,
            torque_level=torque_level,
            status=status,
            message=message,
            bounds_from_data=domain.from_data,
            guessed_sign=domain.guessed_sign,
            inspections=inspections,
            at_best=at_best,
            correlations={
                (domain.names[free[i]], domain.names[free[j]]): float(spread.correlation[i, j])
                for i in range(len(free))
                for j in range(i)
            },
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
        residuals=statistics,
        windows=table,
        convergence=convergence,
        warnings=warnings,
        joint=joint_of(problem, parameters),
        settings=settings,
        seconds=seconds,
    )


def r_squared(table: WindowTable) -> float:
    """Share of the variance of the measured window means that the model explains, weighted by duration.

    Means, because integrals of a constant signal vary with the windows' unequal durations.
    """
    mean = table.measured / table.duration
    level = float(np.average(mean, weights=table.duration))
    total = float(np.sum(table.duration * (mean - level) ** 2))
    left = float(np.sum(table.residual**2 / table.duration))
    return 1.0 - left / total if total > 1e-18 * level**2 * float(table.duration.sum()) else 0.0


def relative_residual(table: WindowTable) -> float:
    """Norm of the residuals over the norm of the measured integrals; infinite when nothing was measured."""
    measured = size(table.measured)
    return size(table.residual) / measured if measured > 0.0 else float("inf")


def freedom_of(domain: SearchDomain, best: Array, gradient: Array, alone: Array) -> Freedom:
    """Which parameters a bound holds: they lie on it, and the penalty would fall beyond it.

    On it means nearer than a thousandth of what the parameter could move by noise alone, not a share
    of the domain: under very wide bounds a small right value is no bound.
    """
    at_bound: list[str | None] = []
    free = []
    for index in range(len(domain.names)):
        low, high = domain.lower[index], domain.upper[index]
        near = min(max(1e-3 * alone[index], 1e-14 * (high - low)), 1e-6 * (high - low))
        bound = None
        if high > low and best[index] - low <= near and gradient[index] >= 0.0:
            bound = "min"
        elif high > low and high - best[index] <= near and gradient[index] <= 0.0:
            bound = "max"
        at_bound.append(bound)
        # On its bound a parameter is not free to vary: an error would not be a standard error.
        if high > low and bound is None:
            free.append(index)
    return Freedom(indices=tuple(free), at_bound=tuple(at_bound))


def _centre(
    penalty: _core.Penalty, columns: Array, free: list[int]
) -> tuple[int, int, float] | None:
    names = [penalty.names[i] for i in free]
    if not {"sensor_gain", "sensor_offset"} <= set(names):
        return None
    reading = columns[:, penalty.names.index("sensor_gain")].sum()
    mean = float(reading / penalty.usable_duration.sum())
    return names.index("sensor_gain"), names.index("sensor_offset"), mean


def _statistics(problem: Problem, penalty: _core.Penalty, table: WindowTable) -> ResidualStatistics:
    residual = table.residual
    intervals = penalty.total_samples - len(problem.recordings)
    return ResidualStatistics(
        windows=penalty.window_count,
        window_duration=penalty.window_duration,
        noise_share=penalty.noise_share,
        rms=float(np.sqrt(np.mean((residual / table.duration) ** 2))),
        relative=relative_residual(table),
        r_squared=r_squared(table),
        autocorrelation=inner(residual[1:], residual[:-1]) / max(inner(residual, residual), 1e-300),
        samples=penalty.total_samples,
        left_out=penalty.unusable_intervals / intervals,
        standing=penalty.standing_samples / penalty.total_samples,
    )


def _facts(penalty: _core.Penalty) -> dict[str, _core.Term | _core.Shape]:
    """Name to term or shape, a shape behind the first term that it bends."""
    shapes = {shape.name: shape for shape in _core.shapes()}
    facts: dict[str, _core.Term | _core.Shape] = {}
    for name, term in zip(penalty.names, penalty.terms, strict=False):
        facts[name] = term
        facts.update({shape: shapes[shape] for shape in term.shapes if shape not in facts})
    return facts


def parameters_of(
    problem: Problem,
    penalty: _core.Penalty,
    domain: SearchDomain,
    best: Array,
    freedom: Freedom,
    spread: Covariance,
    windows: int,
    shifts: tuple[Array | None, Array | None],
) -> dict[str, ParameterEstimate]:
    """Every parameter of the penalty by name, with its error, interval and bounds."""
    factor = quantile(0.975, max(1, windows - len(freedom.indices)))
    errors = dict(zip(freedom.indices, spread.stderr.tolist(), strict=True))
    prismatic = problem.recordings[0].kind == "prismatic"
    result = {}
    for name, fact in _facts(penalty).items():
        i = domain.names.index(name)
        value, error, vary = float(best[i]), errors.get(i), not domain.fixed(name)
        halved, doubled = (None if s is None or not vary else float(s[i]) for s in shifts)
        result[name] = ParameterEstimate(
            name=name,
            meaning=fact.meaning,
            unit=fact.unit_prismatic if prismatic else fact.unit,
            value=value,
            stderr=error,
            interval=None if error is None else (value - factor * error, value + factor * error),
            min=float(domain.lower[i]),
            max=float(domain.upper[i]),
            vary=vary,
            at_bound=freedom.at_bound[i],
            shift_halved=halved,
            shift_doubled=doubled,
        )
    return result


def joint_of(problem: Problem, parameters: dict[str, ParameterEstimate]) -> Joint:
    """The joint with the estimated values in its parameter table; what it knew for a fact stays a fact."""
    choice, recording = problem.choice, problem.recordings[0]
    base = problem.joint
    if base is None:
        base = Joint(
            name=recording.name,
            kind=recording.kind,
            sensor=choice.sensor,
            torque_offset=None if choice.asymmetric else "torque_offset" in choice.terms,
        )
    table = dict(base.parameters)
    for name, found in parameters.items():
        known = table.get(name)
        if known is None and not found.vary and (name == "inertia" or name.startswith("gravity")):
            continue
        low = None if known is None or known.min is None else min(known.min, found.value)
        high = None if known is None or known.max is None else max(known.max, found.value)
        vary = found.vary if known is None else known.vary
        table[name] = Parameter(name=name, value=found.value, min=low, max=high, vary=vary)
    inertia = parameters.get("inertia")
    if inertia is not None and inertia.vary and base.reflected_inertia is not None:
        # What was found takes the place of what was believed.
        base = base.replace(inertia=inertia.value, rotor_inertia=None)
    return base.replace(
        parameters=table,
        friction=choice.model,
        asymmetric=choice.asymmetric,
        ripple=choice.ripple,
        harmonics=choice.harmonics,
        load_friction=choice.load_friction,
    )
