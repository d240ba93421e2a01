"""A current or torque too large for a joint's drive: it is probably in thousandths of the assumed unit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from jointid.base.advice import Action
from jointid.estimate.findings import Finding
from jointid.identification.warnings.check import Check
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected
from jointid.identification.warnings.units import IMPLAUSIBLE_UNITS
from jointid.recording.plausible_units import unlikely_sizes
from jointid.recording.signals import header_unit

_STATED = 10.0  # factor on the limit if the call states the unit


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording = inspected.recording
    assumed, stated = (recording.metadata.get(key) for key in ("assumed_units", "stated_units"))
    unstated = assumed if isinstance(assumed, list | tuple) else ()
    asked = unlikely_sizes(recording, unstated)
    by_call = stated if isinstance(stated, Mapping) else {}
    for signal, each in (asked | unlikely_sizes(recording, by_call, _STATED)).items():
        usual = header_unit(signal, recording.kind)
        as_it_is = Action("call", {"units": {signal: usual}}, f"if these are {usual}", "load")
        yield IMPLAUSIBLE_UNITS.finding(
            f"{signal}{' without a unit' * (signal in asked)}: {each.reason}",
            Action("call", {"units": {signal: each.unit}}, function="load"),
            *([as_it_is] if signal in asked else []),
            severity="blocking" if signal in asked else "warning",
        )


CHECK = Check(None, (IMPLAUSIBLE_UNITS,), _in_recording)
