"""Residuals that are not noise."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

STRUCTURED_RESIDUAL = FindingType(
    code="structured_residual",
    meaning="the residuals of neighbouring windows are correlated by more than 0.5: the model misses a "
    "systematic effect",
    advice="look at the picture of the residuals; the standard errors allow for the correlation, a bias may remain",
    picture="windows",
)
_CORRELATED = 0.5


def _find(evidence: Evidence) -> Iterator[Finding]:
    # Running integrals of white noise are correlated by themselves.
    correlation = evidence.residuals.autocorrelation
    if correlation > _CORRELATED and not evidence.penalty.cumulative:
        yield STRUCTURED_RESIDUAL.finding(
            f"the residuals are autocorrelated (r = {correlation:.2f}): the model misses a systematic effect; the "
            "standard errors allow for it, a bias may remain",
            Action("inspect", text="the residuals over time and over velocity"),
            evidence={"autocorrelation": Measured(correlation)},
        )


CHECK = Check(_find, (STRUCTURED_RESIDUAL,))
