"""What a check is: a function that yields findings, and the types of finding that it can yield."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from jointid.base.advice import Action
from jointid.base.values import dataclass
from jointid.estimate.findings import Finding, Measured, Severity
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected
from jointid.identification.warnings.merging import merged
from jointid.problem.recordings import recording_names


@dataclass(frozen=True, slots=True, kw_only=True)
class FindingType:
    """One code: how severe it is, what it means, and what to do about it.

    Attributes
    ----------
    code : str
        Stable name.
    severity : {"info", "warning", "blocking"}
    meaning : str
        When it is raised; a row of docs/findings.md.
    advice : str
        What to do, in general; a finding's own advice is data.
    picture : str
        Section of the HTML report that shows it: "friction-map", "windows" or "convergence". Default: none.
    """

    code: str
    severity: Severity = "warning"
    meaning: str
    advice: str
    picture: str = ""

    def finding(
        self,
        title: str,
        *advice: Action,
        details: str = "",
        evidence: Mapping[str, Measured] | None = None,
        parameters: tuple[str, ...] = (),
        severity: Severity | None = None,
    ) -> Finding:
        """Return a finding of this type; its severity is the type's unless given."""
        return Finding(
            code=self.code,
            severity=severity or self.severity,
            parameters=parameters,
            evidence=evidence or {},
            title=title,
            details=details,
            advice=advice,
        )


@dataclass(frozen=True, slots=True)
class Check:
    """One check.

    Attributes
    ----------
    find : callable
        Takes the `Evidence`, yields findings; yields nothing when all is well.
    types : tuple of FindingType
        What it can yield.
    in_recording : callable
        Takes the `Evidence` and one of its recordings as `Inspected`, yields findings about that one.
    """

    find: Callable[[Evidence], Iterator[Finding]] | None
    types: tuple[FindingType, ...]
    in_recording: Callable[[Evidence, Inspected], Iterator[Finding]] | None = None

    def findings(self, evidence: Evidence) -> list[Finding]:
        """Return all that it finds; what it says of several recordings alike is one finding."""
        found: list[Finding] = []
        if self.in_recording is not None:
            single = [
                (number, each)
                for number, inspected in enumerate(evidence.inspections)
                for each in self.in_recording(evidence, inspected)
            ]
            found += merged(single, recording_names(evidence.recordings))
        if self.find is not None:
            found += self.find(evidence)
        return found
