"""A model that explains too little."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.structured_residual import excluded, excluded_number, named

POOR_FIT = FindingType(
    code="poor_fit",
    meaning="the model explains less than 95 % of the variance of the measured signal, and no cause with a name "
    "explains the rest",
    advice="check units, signs and gear ratio",
    picture="windows",
)
POORLY_EXPLAINED = 0.95


def _find(evidence: Evidence) -> Iterator[Finding]:
    explained = evidence.residuals.r_squared
    if explained < POORLY_EXPLAINED and not named(evidence):
        yield POOR_FIT.finding(
            f"the model explains only {100.0 * explained:.1f} % of what was measured{excluded(evidence, 'the rest')}",
            Action("inspect", text="units, signs and gear ratio"),
            Action("inspect", text="the residuals over time and over velocity"),
            evidence={"r_squared": Measured(explained)} | excluded_number(evidence),
        )


CHECK = Check(_find, (POOR_FIT,))
