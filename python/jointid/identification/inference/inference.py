"""Results at the minimum of the penalty: free parameters, errors, statistics of the residuals, the joint."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.covariance import Covariance
from jointid.base.values import dataclass
from jointid.estimate.statistics import ParameterEstimate, ResidualStatistics
from jointid.estimate.student import limited_half_width, quantile
from jointid.identification.search.domain import SearchDomain
from jointid.joint.joint import Joint
from jointid.joint.parameters import Parameter
from jointid.problem.inner_products import inner
from jointid.problem.own_integrals import unit_of
from jointid.problem.problem import Problem
from jointid.problem.window_table import WindowTable, r_squared, relative_residual

Array = NDArray[np.float64]

_LIMITED = ("sampling",)  # errors with known limits instead of a standard error
# Errors that do not enter the intervals like random errors: those with limits, of a choice, and of given facts.
_APART = ("residual_side", "given", *_LIMITED)
_NORMAL = 1.959964  # standard errors of a 95 % interval


@dataclass(frozen=True, slots=True, kw_only=True)
class Freedom:
    """Free parameters, and those that ended on a bound.

    Attributes
    ----------
    indices : tuple of int
        Indices of the free parameters that are not at a bound.
    at_bound : tuple of str or None
        "min" or "max" for each parameter on a bound; None for the others.
    """

    indices: tuple[int, ...]
    at_bound: tuple[str | None, ...]


def freedom_of(domain: SearchDomain, best: Array, gradient: Array, alone: Array) -> Freedom:
    """Find the parameters on a bound: they are at the bound, and the penalty decreases beyond it.

    A parameter is at a bound if its distance is less than a thousandth of its error by noise alone. A share of the
    domain is no good measure, because with very wide bounds a small, correct value would seem to be at a bound.
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
        # A parameter on its bound cannot vary in both directions, so it has no standard error.
        if high > low and bound is None:
            free.append(index)
    return Freedom(indices=tuple(free), at_bound=tuple(at_bound))


def statistics_of(
    problem: Problem, penalty: _core.Penalty, table: WindowTable
) -> ResidualStatistics:
    """Return statistics of the window residuals."""
    residual = table.residual
    mean = residual / table.duration
    power = inner(residual, residual)
    intervals = penalty.total_samples - len(problem.recordings)
    return ResidualStatistics(
        windows=penalty.window_count,
        window_duration=penalty.window_duration,
        noise_share=penalty.noise_share,
        rms=math.sqrt(inner(mean, mean) / len(mean)),
        relative=relative_residual(table),
        r_squared=r_squared(table),
        autocorrelation=inner(residual[1:], residual[:-1]) / max(power, 1e-300),
        samples=penalty.total_samples,
        left_out=penalty.unusable_intervals / intervals,
        standing=penalty.standing_samples / penalty.total_samples,
    )


@functools.cache
def _shapes() -> Mapping[str, _core.Shape]:
    return {shape.name: shape for shape in _core.shapes()}


def _terms_and_shapes(penalty: _core.Penalty) -> dict[str, _core.Term | _core.Shape]:
    """Return terms and shapes by name; a shape follows the first term that contains it."""
    shapes = _shapes()
    known: dict[str, _core.Term | _core.Shape] = {}
    for name, term in zip(penalty.names, penalty.terms, strict=False):
        known[name] = term
        known.update({shape: shapes[shape] for shape in term.shapes if shape not in known})
    # Shapes that act on the sum of all terms belong to none of them.
    known.update({name: shapes[name] for name in penalty.names if name not in known})
    return known


def parameters_of(
    problem: Problem,
    penalty: _core.Penalty,
    domain: SearchDomain,
    best: Array,
    freedom: Freedom,
    spread: Covariance,
    parts: Mapping[str, Array],
    shifts: tuple[Array | None, Array | None],
    held: Mapping[int, tuple[float, float]] | None = None,
) -> dict[str, ParameterEstimate]:
    """Return every parameter of the penalty by name, with its error, interval and bounds.

    Parameters
    ----------
    parts : mapping of str to ndarray
        Systematic errors of every parameter, by the name of their cause.
    held : mapping of int to tuple of float
        Intervals of the parameters on a bound. Default: none.
    """
    errors = dict(zip(freedom.indices, spread.stderr.tolist(), strict=True))
    # Most parameters have the same degrees of freedom; all of them if the residuals are white.
    known = {f: quantile(0.975, f) for f in set(spread.freedom.tolist())}
    factors = dict(
        zip(freedom.indices, map(known.__getitem__, spread.freedom.tolist()), strict=True)
    )
    prismatic = problem.recordings[0].kind == "prismatic"
    own = problem.choice.model.resolved.terms
    values, lower, upper = best.tolist(), domain.lower.tolist(), domain.upper.tolist()
    sizes = {part: each.tolist() for part, each in parts.items()}
    moved = [None if shift is None else shift.tolist() for shift in shifts]
    result = {}
    for name, described in _terms_and_shapes(penalty).items():
        i = domain.names.index(name)
        value, error, vary = values[i], errors.get(i), not domain.fixed(name)
        systematic = {part: each[i] for part, each in sizes.items()}
        half = None if error is None else _half_width(factors[i] * error, systematic)
        halved, doubled = (None if each is None or not vary else each[i] for each in moved)
        result[name] = ParameterEstimate(
            name=name,
            meaning=described.meaning,
            unit=unit_of(described.name, own, problem.recordings[0])
            or (described.unit_prismatic if prismatic else described.unit),
            value=value,
            stderr=error,
            interval=(held or {}).get(i) if half is None else (value - half, value + half),
            min=lower[i],
            max=upper[i],
            vary=vary,
            at_bound=freedom.at_bound[i],
            shift_halved=halved,
            shift_doubled=doubled,
            systematic=systematic,
        )
    return result


def _half_width(chance: float, systematic: Mapping[str, float]) -> float:
    """Return half of the 95 % interval from random error, already at its quantile, and systematic errors.

    An error with known limits is in the worst case at a limit. The interval then covers the other errors there.
    """
    shown = (size for part, size in systematic.items() if part not in _APART)
    half = math.hypot(chance, _NORMAL * math.hypot(*shown))
    limit = sum(systematic.get(part, 0.0) for part in _LIMITED)
    return limited_half_width(half / _NORMAL, limit) if limit > 0.0 else half


def joint_of(problem: Problem, parameters: dict[str, ParameterEstimate]) -> Joint:
    """Return the joint with the estimated values in its parameter table; its known values do not change."""
    choice, recording = problem.choice, problem.recordings[0]
    base = problem.joint
    if base is None:
        base = Joint(
            name=recording.name,
            kind=recording.kind,
            sensor=choice.sensor,
            torque_offset="torque_offset" in choice.terms,
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
        # The estimate replaces the joint's own value, which is that of the drive alone.
        drive = inertia.value - (0.0 if base.sensor else base.link_inertia)
        if drive > 0.0:
            others = replace(base.tolerances, inertia=None, rotor_inertia=None)
            base = base.replace(inertia=drive, rotor_inertia=None, tolerances=others)
    model = choice.model.replace(per_recording=base.model.per_recording)
    return base.replace(parameters=table, model=model)
