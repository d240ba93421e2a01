"""A search that did not finish."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

STOPPED = FindingType(
    code="stopped",
    meaning="the search ended before it converged; better values may exist",
    advice="use the separable search, or let the search finish",
    picture="convergence",
)


def _find(evidence: Evidence) -> Iterator[Finding]:
    if evidence.status != "converged":
        yield STOPPED.finding(
            "the search ended before it converged: better values may exist",
            Action("call", {"search": "separable"}),
            details=evidence.message,
        )


CHECK = Check(_find, (STOPPED,))
