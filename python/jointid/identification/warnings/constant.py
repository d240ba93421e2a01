"""A sensor or torque that never changes, or is constant for a while during motion."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import DRIVE, Inspected

CONSTANT_SIGNAL = FindingType(
    code="constant_signal",
    severity="blocking",
    meaning="while the joint moves, the torque or the sensor reading stays constant: in the whole log, or in more than "
    "5 % of the samples",
    advice="check the signal's cable and its mapping",
)
_FROZEN = 0.05  # share of the samples in frozen runs


def _in_recording(evidence: Evidence, inspected: Inspected) -> Iterator[Finding]:
    for name in inspected.channels:
        if name not in (*DRIVE, "sensor"):
            continue
        signal = inspected.counts(name)
        share = signal.frozen / len(inspected.recording) if signal.fine else 0.0
        if signal.lowest == signal.highest:
            share = 1.0
        if share < _FROZEN:
            continue
        names = evidence.sensor_parameters if name == "sensor" else ()
        frozen = (
            "never changes" if share == 1.0 else f"is frozen in {percent(share)} of the samples"
        )
        result = "gain and offset cannot be determined" if names else "the values cannot be used"
        yield CONSTANT_SIGNAL.finding(
            f"{name} {frozen} while the joint moves",
            Action("inspect", text="the signal's cable and its mapping"),
            details=result,
            evidence={"frozen": Measured(share)},
            parameters=names,
        )


CHECK = Check(None, (CONSTANT_SIGNAL,), _in_recording)
