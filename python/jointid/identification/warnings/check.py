"""What a check is: a function that yields findings of its types."""

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


__all__ = ["Check", "FindingType"]
