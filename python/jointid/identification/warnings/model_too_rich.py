"""A Stribeck model on data that do not determine it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from jointid import _core
from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import percent, rounded, two_digits
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.model_advice import simpler_model
from jointid.identification.warnings.motion_advice import DESIGNED, other_motion
from jointid.problem.inner_products import inner

MODEL_TOO_RICH = FindingType(
    code="model_too_rich",
    meaning="the data do not determine the Stribeck model. Static friction is zero or not significant, is "
    "determined by only three windows, or is extrapolated from faster motion. Or a shape parameter of the Stribeck "
    "curve ended on a bound",
    advice="use the model coulomb_viscous if the log shows no static friction, or record slow motion through zero speed"
    f"{DESIGNED}",
    picture="friction-map",
)

STATIC = ("static", "static_positive", "static_negative")
SHAPES = ("stribeck", "stribeck_velocity", "stribeck_exponent")
_LACKED = (*STATIC, *SHAPES)
_SIGNIFICANT = 0.5  # standard error over value
_PLAIN = 4.0  # standard errors of a static excess with a fixed shape
_FEW = 3  # windows: a passage through low speed
_SHOWN = 0.2  # of static friction: smallest share that acts in the slowest window; with less, the value is extrapolated
_COULOMB = ("coulomb", "coulomb_positive", "coulomb_negative")


def richness(evidence: Evidence) -> tuple[str, dict[str, Measured]] | None:
    """Return why the data do not determine a static excess, and the numbers; None if they do."""
    found = evidence.parameters
    static = [found[name] for name in STATIC if name in found and found[name].vary]
    if not static:
        return None
    for p in (*static, *(found[name] for name in _COULOMB if name in found)):
        if p.at_bound == "min":
            return f"{p.name} ended at its lower bound", {f"{p.name}.min": Measured(p.min, p.unit)}
    for p in static:
        if p.stderr is not None and p.stderr > _SIGNIFICANT * abs(p.value):
            shown = f"{rounded(p.value, p.stderr)} ± {two_digits(p.stderr)} {p.unit}"
            return (
                f"{p.name} is {shown}"
                if math.isfinite(p.stderr)
                else f"{p.name} has no finite error",
                {
                    p.name: Measured(p.value, p.unit),
                    f"{p.name}.stderr": Measured(p.stderr, p.unit),
                },
            )
    for p in static:
        few = _seen_in_few(evidence, p)
        if few is not None:
            return few
    for name in SHAPES:
        if name in found and found[name].at_bound is not None and name in evidence.bounds_from_data:
            return f"{name} ended on a bound that comes from the data", {
                name: Measured(found[name].value, found[name].unit)
            }
    return None


def _seen_in_few(
    evidence: Evidence, p: ParameterEstimate
) -> tuple[str, dict[str, Measured]] | None:
    """Return why too few windows show static friction, or show too little of it; None if they are enough."""
    regressor, penalty = evidence.at_best, evidence.penalty
    if p.name not in regressor.names or (p.stderr is None and p.at_bound is None):
        return None
    columns = penalty.linear_columns(evidence.best)
    place = regressor.names.index(p.name)
    shown = float(np.max(np.abs(columns[:, place]) / penalty.usable_duration))
    if shown < _SHOWN:
        return (
            f"no window shows more than {percent(shown)} of {p.name}",
            {p.name: Measured(p.value, p.unit), f"{p.name}.shown": Measured(shown)},
        )
    if p.stderr is None:
        return None
    free = [
        k
        for k, other in enumerate(regressor.names)
        if k != place and other in evidence.parameters and evidence.parameters[other].vary
    ]
    own = columns[:, place]
    if free:
        own = own - columns[:, free] @ regressor.triangle.solve(free, place, rcond=1e-10)[0]
    missed = np.asarray(penalty.target) - columns @ evidence.best[: columns.shape[1]]
    most = np.argsort(-(own**2))[:_FEW]
    total = inner(own, own)
    left = max(total - inner(own[most], own[most]), 1e-9 * total)
    value = p.value - inner(own[most], missed[most]) / left
    error = p.stderr * math.sqrt(total / left)
    if error <= _SIGNIFICANT * value:
        return None
    return (
        f"only {_FEW} of {len(own)} windows determine {p.name}",
        {
            f"{p.name}.elsewhere": Measured(value, p.unit),
            f"{p.name}.elsewhere_stderr": Measured(error, p.unit),
            "windows": Measured(float(len(own))),
            "windows_that_show_it": Measured(float(_FEW)),
        },
    )


def _beyond(measured: Mapping[str, Measured]) -> str:
    """Return the static friction without the few windows that show it, or that no window shows it."""
    for name, error in measured.items():
        static, _, kind = name.partition(".")
        if kind == "elsewhere_stderr":
            value = measured[f"{static}.elsewhere"].value
            shown = f"{rounded(value, error.value)} ± {two_digits(error.value)} {error.unit}"
            return f"without these windows, {static} is {shown}"
        if kind == "shown":
            found = measured[static]
            return f"{static} is {found.value:.3g} {found.unit}, extrapolated from faster motion"
    return ""


def _without(evidence: Evidence) -> str:
    """Return the arguments to remove from the call, because the simpler model refuses parameters that it lacks."""
    stated = [
        name
        for name, found in evidence.parameters.items()
        if name.partition("[")[0] in _LACKED and _stated_by_call(evidence, found)
    ]
    return f"without the values and bounds of {' and '.join(stated)}" if stated else ""


def _stated_by_call(evidence: Evidence, found: ParameterEstimate) -> bool:
    """Return whether the call states its bounds or fixed value: they are neither the joint's nor from the recording."""
    of_joint = evidence.joint.parameters.get(found.name) if evidence.joint is not None else None
    if not found.vary:
        return of_joint is None or of_joint.vary or of_joint.value != found.value
    if of_joint is None:
        return found.name not in evidence.bounds_from_data
    given = ((of_joint.min, found.min), (of_joint.max, found.max))
    return any(own is not None and own != used for own, used in given)


def _plain_excess(evidence: Evidence) -> bool:
    """Return whether friction clearly increases at low speed, although its shape is not determined.

    Without static terms, the other terms absorb their effect, and the simpler model is worse at all speeds.
    """
    regressor, found = evidence.at_best, evidence.parameters
    free = [name for name in regressor.names if name in found and found[name].vary]
    static = [name for name in free if name.partition("[")[0] in STATIC]
    others = [regressor.names.index(name) for name in free if name not in static]
    residual = evidence.residual
    if evidence.penalty.residual == _core.Residual.sensor and "sensor_gain" in found:
        residual = residual * found["sensor_gain"].value
    correlation = min(max(evidence.residuals.autocorrelation, 0.0), 0.99)
    noise = inner(residual, residual) / max(1, residual.size) * (1.0 + correlation)
    noise /= 1.0 - correlation
    for name in static:
        own = regressor.triangle.solve(others, regressor.names.index(name), rcond=1e-10)[1]
        if abs(found[name].value) * own > _PLAIN * math.sqrt(noise):
            return True
    return False


def _find(evidence: Evidence) -> Iterator[Finding]:
    reason = richness(evidence)
    if reason is not None:
        text, measured = reason
        named = (*_COULOMB, *STATIC, *SHAPES)
        advice = [other_motion(evidence, "slow motion through zero speed")]
        seen = not any(name.endswith((".shown", ".elsewhere")) for name in measured)
        if not (seen and _plain_excess(evidence)):
            simpler = Action("call", {"model": simpler_model(evidence)}, _without(evidence))
            advice.insert(0, simpler)
        yield MODEL_TOO_RICH.finding(
            f"the model {evidence.model} is too rich: {text}",
            *advice,
            details=_beyond(measured),
            evidence=measured,
            parameters=tuple(name for name in named if name in evidence.parameters),
        )


CHECK = Check(_find, (MODEL_TOO_RICH,))
