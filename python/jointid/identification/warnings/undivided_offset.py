"""An offset beside two Coulomb frictions: their sum is known, how it divides is not."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

UNDIVIDED_OFFSET = FindingType(
    code="undivided_offset",
    severity="info",
    meaning="a constant torque and the difference between the Coulomb frictions of the two directions are one quantity "
    "while the joint moves: their intervals are infinite, the sum of the two is determined",
    advice="fix the offset where it is known, or leave it out where gravity is the only constant torque",
)


def _find(evidence: Evidence) -> Iterator[Finding]:
    found = evidence.parameters
    for each in evidence.undivided:
        total = sum(found[name].value for name in each.change if "offset" not in name)
        unit = found[each.offset].unit
        known = {"parameters": {each.offset: ...}}
        yield UNDIVIDED_OFFSET.finding(
            f"no motion tells {', '.join(each.change)} apart: the two directions' Coulomb frictions are known with the "
            f"offset in them, and are shown as equal; their sum is {total:.4g} {unit}",
            Action("call", known, text="which fixes the offset, where it is known"),
            evidence={"coulomb_sum": Measured(total, unit)},
            parameters=tuple(each.change),
        )


CHECK = Check(_find, (UNDIVIDED_OFFSET,))
