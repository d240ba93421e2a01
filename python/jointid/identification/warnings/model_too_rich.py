"""A Stribeck model on data that do not determine it."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
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


def _find(evidence: Evidence) -> Iterator[Finding]:
    reason = richness(evidence)
    if reason is not None:
        text, measured = reason
        named = (*_COULOMB, *STATIC, *SHAPES)
        yield MODEL_TOO_RICH.finding(
            f"the data do not determine the model '{evidence.model}': {text}",
            Action("call", {"model": simpler_model(evidence)}),
            Action("record", text="slow motion through zero speed"),
            evidence=measured,
            parameters=tuple(name for name in named if name in evidence.parameters),
        )


CHECK = Check(_find, (MODEL_TOO_RICH,))
