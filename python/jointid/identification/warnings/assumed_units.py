"""Signals whose unit no header states."""

from collections.abc import Iterator, Mapping

from jointid.base.advice import Action
from jointid.estimate.findings import Finding
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected
from jointid.recording.signals import SIGNALS, header_unit

ASSUMED_UNITS = FindingType(
    code="assumed_units",
    meaning="a column has no unit; SI is assumed",
    advice="name the unit in the header (as in `position_rad`, `torque_Nm`), or state it when loading",
)


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording = inspected.recording
    signals = [str(signal) for signal in _sequence(recording.metadata.get("assumed_units"))]
    units = {name: header_unit(name, recording.kind) for name in signals if name in SIGNALS}
    if signals:
        advice = [
            Action(
                "inspect",
                text="the header, and name the unit there (as in position_rad, torque_Nm)",
            )
        ]
        if units:
            purpose = "or whatever the units are"
            advice.append(Action("call", {"units": units}, text=purpose, function="load"))
        yield ASSUMED_UNITS.finding(
            f"no unit is stated for {', '.join(signals)}; SI is assumed", *advice
        )
    recognised = _pairs(recording.metadata.get("recognised_units"))
    if recognised:
        shown = ", ".join(f"{signal} is read in {unit}" for signal, unit in recognised)
        yield ASSUMED_UNITS.finding(
            f"no unit is stated, but numbers or names show it: {shown}",
            Action("inspect", text="the header, and name the unit there (time_ns)"),
            severity="info",
        )


def _pairs(value: object) -> tuple[tuple[object, object], ...]:
    return tuple(value.items()) if isinstance(value, Mapping) else ()


def _sequence(value: object) -> tuple[object, ...]:
    return tuple(value) if isinstance(value, list | tuple) else ()


CHECK = Check(None, (ASSUMED_UNITS,), _in_recording)
