"""Signals without a unit in their header."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from jointid.base.advice import Action
from jointid.estimate.findings import Finding
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import DRIVE, Inspected
from jointid.identification.warnings.undetermined import listed
from jointid.recording.recording import Recording
from jointid.recording.signals import SIGNALS, header_unit

ASSUMED_UNITS = FindingType(
    code="assumed_units",
    meaning="a column has no unit, so SI is assumed",
    advice="state the unit when loading, or in the header (such as `position_rad`, `torque_Nm`)",
)
_AGREES = 0.01  # relative difference of a velocity and the position's rate


_IN_HEADER = Action(
    "inspect", text="the header, and name the unit there (as in position_rad, torque_Nm)"
)
_ROOM = 30  # characters of names in a title


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording = inspected.recording
    assumed = [str(signal) for signal in _sequence(recording.metadata.get("assumed_units"))]
    signals = [name for name in assumed if name != "time" or not _shows_seconds(inspected, assumed)]
    units = {name: header_unit(name, recording.kind) for name in signals if name in SIGNALS}
    if signals:
        advice = [_IN_HEADER]
        if units:
            purpose = "or with the true units"
            advice.insert(0, Action("call", {"units": units}, text=purpose, function="load"))
        yield ASSUMED_UNITS.finding(
            f"no unit is stated for {listed(signals, _ROOM)}, SI is assumed",
            *advice,
            details="; ".join(filter(None, (_all_of(signals), *_sizes(recording, signals)))),
        )
    recognised = _pairs(recording.metadata.get("recognised_units"))
    if recognised:
        shown = [f"{signal} in {unit}" for signal, unit in recognised]
        yield ASSUMED_UNITS.finding(
            f"unit inferred from numbers or names: {listed(shown, _ROOM)}",
            Action("inspect", text="the header, and name the unit there (time_ns)"),
            details=_all_of(shown),
            severity="info",
        )


def _shows_seconds(inspected: Inspected, assumed: Sequence[str]) -> bool:
    """Return whether position and velocity with stated units agree. If so, the time is in seconds."""
    found = inspected.found.agreement
    stated = not {"position", "velocity"} & set(assumed)
    return stated and found is not None and abs(found.scale - 1.0) < _AGREES


def _sizes(recording: Recording, signals: Sequence[str]) -> list[str]:
    """Return the largest torque or current in the assumed unit, so that a reader sees whether it is possible."""
    return [
        f"in the assumed unit, {name} is up to {float(np.abs(getattr(recording, name)).max()):.4g} "
        f"{recording.unit(name)}"
        for name in DRIVE
        if name in signals and getattr(recording, name) is not None
    ]


def _all_of(names: Sequence[str]) -> str:
    """Return the names that do not fit into a title."""
    return "" if listed(names, _ROOM) == ", ".join(names) else f"complete list: {', '.join(names)}"


def _pairs(value: object) -> tuple[tuple[object, object], ...]:
    return tuple(value.items()) if isinstance(value, Mapping) else ()


def _sequence(value: object) -> tuple[object, ...]:
    return tuple(value) if isinstance(value, list | tuple) else ()


CHECK = Check(None, (ASSUMED_UNITS,), _in_recording)
