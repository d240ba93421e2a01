"""A joint that stands still for too much of the recording."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

STANDING = FindingType(
    code="standing",
    meaning="the joint stands still or sticks in more than 35 % of the samples",
    advice="record more motion",
)
_MUCH = 0.35


def _find(evidence: Evidence) -> Iterator[Finding]:
    share = evidence.residuals.standing
    if share > _MUCH:
        yield STANDING.finding(
            f"the joint stands still or sticks in {100.0 * share:.0f} % of the samples, which carry no information "
            "about friction and are left out",
            Action("record", text="more motion"),
            evidence={"standing": Measured(share)},
        )


CHECK = Check(_find, (STANDING,))
