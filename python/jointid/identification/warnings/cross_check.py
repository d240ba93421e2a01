"""Values that a plain least squares on the recorded signals contradicts."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import number
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

CONTRADICTED = FindingType(
    code="cross_check",
    severity="blocking",
    meaning="a plain filtered least squares on the recorded signals gives other values",
    advice="find out which of the two is wrong: plot position, velocity and torque over time",
)


def _find(evidence: Evidence) -> Iterator[Finding]:
    second = evidence.cross_check
    if not second.disagrees:
        return
    pairs, measured = [], {}
    for name in second.contradicted:
        p, other = evidence.parameters[name], second.values[name].value
        pairs.append(f"{name} {number(p.shown_value)} here, {number(other)} there")
        measured[name] = Measured(p.shown_value, p.unit)
        measured[f"{name}.second"] = Measured(other, p.unit)
    yield CONTRADICTED.finding(
        f"a plain least squares on the recorded signals disagrees: {'; '.join(pairs)}",
        Action(
            "inspect",
            text="position, velocity and torque over time: one of the two looks misreads them",
        ),
        evidence=measured,
        parameters=second.contradicted,
    )


CHECK = Check(_find, (CONTRADICTED,))
