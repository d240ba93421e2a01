"""Residuals that are not noise, where no cause has a name."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.undetermined import listed, wide, with_partners

STRUCTURED_RESIDUAL = FindingType(
    code="structured_residual",
    meaning="the residuals of neighbouring windows are correlated by more than 0.5, or by less and a parameter is not "
    "well determined; and no cause with a name explains that: the model misses a systematic effect (info where every "
    "parameter is well determined nevertheless)",
    advice="look at the picture of the residuals; the standard errors allow for the correlation, a bias may remain",
    picture="windows",
)
_CORRELATED = 0.5


def _find(evidence: Evidence) -> Iterator[Finding]:
    # Running integrals of white noise are correlated by themselves.
    if evidence.penalty.cumulative or named(evidence):
        return
    correlation = evidence.residuals.autocorrelation
    uncertain = with_partners(evidence, wide(evidence)) if evidence.causes is not None else ()
    if correlation <= _CORRELATED and not uncertain:
        return
    makes = f"; uncertain: {listed(uncertain)}" if uncertain else ""
    # Where all intervals are narrow with what the misfit adds to them, it is worth knowing, no more.
    yield STRUCTURED_RESIDUAL.finding(
        f"the residuals are autocorrelated (r = {correlation:.2f}): the model misses a systematic effect"
        f"{excluded(evidence)}{makes}",
        Action("inspect", text="the residuals over time and over velocity"),
        evidence={"autocorrelation": Measured(correlation)} | excluded_number(evidence),
        parameters=uncertain,
        severity=None if uncertain else "info",
    )


def named(evidence: Evidence) -> bool:
    """Whether a cause of the misfit is found."""
    causes = evidence.causes.found if evidence.causes is not None else ()
    return any(cause.name != "wrong_scale" for cause in causes)


def excluded(evidence: Evidence, what: str = "it") -> str:
    """How much was looked for and not found, as a part of a sentence; `Causes.excluded` has the names."""
    count = len(evidence.causes.excluded) if evidence.causes is not None else 0
    return f"; none of {count} known causes explains {what}" if count else ""


def excluded_number(evidence: Evidence) -> dict[str, Measured]:
    """How many causes were looked for and not found, as evidence."""
    if evidence.causes is None:
        return {}
    return {"causes_excluded": Measured(float(len(evidence.causes.excluded)))}


CHECK = Check(_find, (STRUCTURED_RESIDUAL,))
