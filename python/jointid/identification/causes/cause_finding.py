"""Finding of a cause, for any fitted balance."""

from __future__ import annotations

from jointid.estimate.causes import Cause
from jointid.estimate.findings import TITLE, Finding
from jointid.estimate.types_of_findings import FindingType
from jointid.identification.causes.families import BY_NAME


def finding_of_cause(
    cause: Cause, parameters: tuple[str, ...], joint: str = "", kind: FindingType | None = None
) -> Finding:
    """Return the finding of a harmful cause, with the same text as for a single joint.

    Parameters
    ----------
    joint : str
        Name of the joint before the title. Default: none.
    kind : FindingType, optional
        Type of the finding. Default: that of the cause.
    """
    of = f"{joint}: " if joint else ""
    title = cause.titled(TITLE - len(of))
    if len(of + title) > TITLE:
        title = cause.meaning
    return (kind or BY_NAME[cause.name].finding_type).finding(
        of + title,
        *cause.advice,
        details=cause.details if title == cause.title else str(cause),
        evidence=cause.evidence(cause.relative),
        parameters=parameters,
    )
