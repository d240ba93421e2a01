"""What a code of findings stands for, whatever it is found of: a joint, a robot, a servo."""

from __future__ import annotations

from collections.abc import Mapping

from jointid.base.advice import Action
from jointid.base.values import dataclass
from jointid.estimate.findings import Finding, Measured, Severity


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
