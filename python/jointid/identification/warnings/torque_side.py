"""A torque without a stated side of the gear, together with a motion on the motor side."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected

TORQUE_SIDE = FindingType(
    code="torque_side",
    severity="blocking",
    meaning="position or velocity is on the motor side, and the side of the torque is not stated. All values in "
    "units of torque may be wrong by a factor equal to the gear ratio",
    advice="state with `side` on which side of the gear the torque is measured",
)


def _in_recording(evidence: Evidence, inspected: Inspected) -> Iterator[Finding]:
    stated = inspected.recording.metadata
    ratio = stated.get("gear_ratio")
    inertia = evidence.parameters.get("inertia")
    if inertia is not None and not inertia.vary:
        return  # a known inertia shows the side: a contradiction is reported as a wrong scale
    if stated.get("assumed_side") == "torque" and isinstance(ratio, int | float):
        yield TORQUE_SIDE.finding(
            f"is the torque on the motor side, too? Then all values are {abs(ratio):.4g} times as large",
            Action(
                "call", {"side": {"torque": "motor"}}, "if the drive reports the torque", "load"
            ),
            Action(
                "call",
                {"side": {"torque": "joint"}},
                "if the torque is measured or computed behind the gear",
                "load",
            ),
            details="the motion is on the motor side; the torque is assumed to be on the joint side",
            evidence={"gear_ratio": Measured(abs(ratio))},
        )


CHECK = Check(None, (TORQUE_SIDE,), _in_recording)
