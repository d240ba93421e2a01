"""Description of a check: a function that yields findings of its types."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from jointid.base.values import dataclass
from jointid.estimate.findings import Finding
from jointid.estimate.types_of_findings import FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected
from jointid.identification.warnings.merging import merged
from jointid.problem.recordings import recording_names


@dataclass(frozen=True, slots=True)
class Check:
    """One check.

    Attributes
    ----------
    find : callable
        Takes the `Evidence` and yields findings; none if there is no fault.
    types : tuple of FindingType
        Types of its findings.
    in_recording : callable
        Takes the `Evidence` and one of its recordings as `Inspected`, and yields findings about this recording.
    """

    find: Callable[[Evidence], Iterator[Finding]] | None
    types: tuple[FindingType, ...]
    in_recording: Callable[[Evidence, Inspected], Iterator[Finding]] | None = None

    def findings(self, evidence: Evidence) -> list[Finding]:
        """Return all findings of the check; the same finding in several recordings is returned once."""
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


__all__ = ["Check", "FindingType"]
