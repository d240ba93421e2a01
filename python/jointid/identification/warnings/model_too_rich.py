"""A Stribeck model on data that do not determine it."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.model_advice import simpler_model

MODEL_TOO_RICH = FindingType(
    code="model_too_rich",
    meaning="the static term ended at zero or is not significant, or its shape ended on a bound: the data do not "
    "determine the Stribeck model",
    advice="use the model coulomb_viscous, or record slow motion through zero speed",
    picture="friction-map",
)

STATIC = ("static", "static_positive", "static_negative")
SHAPES = ("stribeck", "stribeck_velocity", "stribeck_exponent")
_LACKED = (*STATIC, *SHAPES)
_COULOMB = ("coulomb", "coulomb_positive", "coulomb_negative")


def richness(evidence: Evidence) -> tuple[str, dict[str, Measured]] | None:
    """Why the data do not determine a static excess, and the numbers; None when they do."""
    found = evidence.parameters
    static = [found[name] for name in STATIC if name in found and found[name].vary]
    if not static:
        return None
    for p in (*static, *(found[name] for name in _COULOMB if name in found)):
        if p.at_bound == "min":
            return f"{p.name} friction ended at its lower bound", {
                f"{p.name}.min": Measured(p.min, p.unit)
            }
    for p in static:
        if p.stderr is not None and p.stderr > 0.5 * abs(p.value):
            share = p.stderr / abs(p.value)
            return (
                f"{p.name} friction is {p.value:.3g} with a standard error of {percent(share)}",
                {
                    p.name: Measured(p.value, p.unit),
                    f"{p.name}.stderr": Measured(share),
                },
            )
    for name in SHAPES:
        if name in found and found[name].at_bound is not None and name in evidence.bounds_from_data:
            return f"the shape {name} ended on the bound of what the data can show", {
                name: Measured(found[name].value, found[name].unit)
            }
    return None


def _without(evidence: Evidence) -> str:
    """What to take away from the call: the simpler model refuses parameters that it lacks."""
    stated = [
        name
        for name, found in evidence.parameters.items()
        if name.partition("[")[0] in _LACKED and _stated_by_call(evidence, found)
    ]
    return f"without the values and bounds of {' and '.join(stated)}" if stated else ""


def _stated_by_call(evidence: Evidence, found: ParameterEstimate) -> bool:
    """Whether its bounds or its fixed value are neither the joint's nor computed from the recording."""
    of_joint = evidence.joint.parameters.get(found.name) if evidence.joint is not None else None
    if not found.vary:
        return of_joint is None or of_joint.vary or of_joint.value != found.value
    if of_joint is None:
        return found.name not in evidence.bounds_from_data
    given = ((of_joint.min, found.min), (of_joint.max, found.max))
    return any(own is not None and own != used for own, used in given)


def _find(evidence: Evidence) -> Iterator[Finding]:
    reason = richness(evidence)
    if reason is not None:
        text, measured = reason
        named = (*_COULOMB, *STATIC, *SHAPES)
        yield MODEL_TOO_RICH.finding(
            f"the data do not determine the model '{evidence.model}': {text}",
            Action("call", {"model": simpler_model(evidence)}, _without(evidence)),
            Action("record", text="slow motion through zero speed"),
            evidence=measured,
            parameters=tuple(name for name in named if name in evidence.parameters),
        )


CHECK = Check(_find, (MODEL_TOO_RICH,))
