"""An offset and two Coulomb frictions: only their sum is determined."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

UNDIVIDED_OFFSET = FindingType(
    code="undivided_offset",
    severity="info",
    meaning="a constant torque and direction-dependent Coulomb friction look the same in the data. The data determine "
    "only the sum of the Coulomb friction in both directions",
    advice="state the offset if you know it, or leave the offset out if only friction and gravity act",
)


def _find(evidence: Evidence) -> Iterator[Finding]:
    found = evidence.parameters
    for each in evidence.undivided:
        total = sum(found[name].value for name in each.change if "offset" not in name)
        unit = found[each.offset].unit
        known = {"parameters": {each.offset: ...}}
        yield UNDIVIDED_OFFSET.finding(
            f"{each.offset} and the two Coulomb frictions look the same (sum of both: {total:.4g} {unit})",
            Action("call", known, text="if you know the offset"),
            details="no motion separates offset and Coulomb friction; the two Coulomb frictions are shown as equal",
            evidence={"coulomb_sum": Measured(total, unit)},
            parameters=tuple(each.change),
        )


CHECK = Check(_find, (UNDIVIDED_OFFSET,))
