"""Corrections of the recordings before they were used."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected

UNWRAPPED = FindingType(
    code="unwrapped",
    severity="info",
    meaning="the angle wraps after each revolution. The identification unwraps the angle",
    advice="log the angle without wraps",
)
HELD_ROWS = FindingType(
    code="held_rows",
    severity="info",
    meaning="rows repeat the previous sample, because the logger is faster than the bus. These rows are left out",
    advice="log at the rate of the bus",
)
HELD_TORQUE = FindingType(
    code="held_torque",
    severity="info",
    meaning="the recording does not say how the torque varies between samples. With a held torque (zero-order "
    "hold), the torque balance predicts better than with a linear torque, so the identification assumes a held torque",
    advice="state `torque_hold`: `zoh` for a command, `linear` for a measured torque",
)


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    for mend in inspected.mends:
        if mend.code == UNWRAPPED.code:
            yield UNWRAPPED.finding(
                f"the angle jumps {mend.count} times by {mend.size:.4g} rad and is unwrapped",
                details="values are not affected",
                evidence={"wraps": Measured(mend.count), "size": Measured(mend.size, "rad")},
            )
        elif mend.code == HELD_TORQUE.code:
            yield HELD_TORQUE.finding(
                "the torque is assumed to be held between samples: a linear torque predicts worse",
                Action(
                    "call",
                    {"torque_hold": "zoh"},
                    text="if the torque is held; linear if it is measured",
                ),
                evidence={"period": Measured(mend.size, "s")},
            )
        else:
            yield HELD_ROWS.finding(
                f"{mend.count} rows repeat the previous sample and are left out",
                Action("record", text="at the rate of the bus"),
                details=f"the log has {mend.size:.3g} rows for each sample of the bus",
                evidence={"rows": Measured(mend.count), "rows_per_sample": Measured(mend.size)},
            )


CHECK = Check(None, (UNWRAPPED, HELD_ROWS, HELD_TORQUE), _in_recording)
