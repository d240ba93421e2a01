"""Too few windows for reliable standard errors."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.motion_advice import DESIGNED, other_motion

FEW_WINDOWS = FindingType(
    code="few_windows",
    meaning="fewer than eight windows per free parameter make the standard errors uncertain",
    advice=f"use shorter windows, or record longer motion{DESIGNED}",
)
_FEW = 8  # windows per free parameter
_ADVISED = 12  # windows per free parameter in the advice; more, because some are then left out


def _find(evidence: Evidence) -> Iterator[Finding]:
    free = sum(p.vary for p in evidence.parameters.values())
    windows = evidence.residuals.windows
    if windows < _FEW * free:
        yield FEW_WINDOWS.finding(
            f"only {windows} windows for {free} parameters make the standard errors uncertain",
            other_motion(evidence, "for longer"),
            Action("call", {"windows": _ADVISED * free}, text="shorter windows"),
            evidence={"windows": Measured(windows), "free_parameters": Measured(free)},
        )


CHECK = Check(_find, (FEW_WINDOWS,))
