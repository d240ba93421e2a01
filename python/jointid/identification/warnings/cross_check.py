"""Values that a plain least squares on the recorded signals contradicts."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.undetermined import listed

CONTRADICTED = FindingType(
    code="cross_check",
    severity="blocking",
    meaning="the cross-check, a plain least squares on the filtered signals, gives values that differ from "
    "the estimate",
    advice="plot position, velocity and torque over time, and find out whether identification or cross-check is wrong",
)

_ROOM = 65  # characters of values in a title


def _find(evidence: Evidence) -> Iterator[Finding]:
    second = evidence.cross_check
    if not second.disagrees:
        return
    pairs, measured = [], {}
    for name in second.contradicted:
        p, other = evidence.parameters[name], second.values[name].value
        pairs.append(f"{name} {other:.3g} (estimate {p.shown_value:.3g})")
        measured[name] = Measured(p.shown_value, p.unit)
        measured[f"{name}.second"] = Measured(other, p.unit)
    shown = listed(pairs, _ROOM)
    yield CONTRADICTED.finding(
        f"the cross-check disagrees: {shown}",
        Action("inspect", text="position, velocity and torque over time"),
        details="the first value of each parameter is from a plain least squares on the recorded signals"
        + ("" if shown == ", ".join(pairs) else f"; complete list: {', '.join(pairs)}"),
        evidence=measured,
        parameters=second.contradicted,
    )


CHECK = Check(_find, (CONTRADICTED,))
