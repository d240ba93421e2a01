"""A model that explains too little."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

POOR_FIT = FindingType(
    code="poor_fit",
    meaning="the model explains less than 95 % of the variance of the measured signal",
    advice="check units, signs and gear ratio; add gravity, a load or sensor ripple to the model",
    picture="windows",
)
_EXPLAINED = 0.95


def _find(evidence: Evidence) -> Iterator[Finding]:
    explained = evidence.residuals.r_squared
    if explained < _EXPLAINED:
        yield POOR_FIT.finding(
            f"the model explains only {100.0 * explained:.1f} % of what was measured",
            Action("inspect", text="units, signs and gear ratio"),
            Action(
                "inspect",
                text="whether gravity, a load or sensor ripple is missing from the model",
            ),
            evidence={"r_squared": Measured(explained)},
        )


CHECK = Check(_find, (POOR_FIT,))
