"""A search that did not finish."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

STOPPED = FindingType(
    code="stopped",
    meaning="the search was stopped before it converged",
    advice="run it again to its end",
    picture="convergence",
)


def _find(evidence: Evidence) -> Iterator[Finding]:
    if evidence.status != "converged":
        yield STOPPED.finding(
            f"the search did not finish ({evidence.message}): better values may exist",
            Action("inspect", text="why the search ended, and run it to its end"),
        )


CHECK = Check(_find, (STOPPED,))
