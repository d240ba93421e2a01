"""Samples that repeat the previous one while the joint moves."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected

REPEATED_SAMPLES = FindingType(
    code="repeated_samples",
    meaning="more than 3 % of the samples repeat the previous sample while the joint moves",
    advice="record at the sampling rate of the drive",
)
REPEATED = 0.03  # share of the moving samples


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    stale = {}
    for name in ("position", "velocity", "sensor"):
        share = inspected.stale_share(name) if name in inspected.channels else 0.0
        if share > REPEATED:
            stale[name] = share
    if stale:
        yield REPEATED_SAMPLES.finding(
            f"{percent(max(stale.values()))} of the {' and '.join(stale)} samples repeat the previous one",
            Action("record", text="at the sampling rate of the drive"),
            details="the joint moves during these samples; the logger was faster than the bus of the drive",
            evidence={f"{name}.repeated": Measured(share) for name, share in stale.items()},
        )


CHECK = Check(None, (REPEATED_SAMPLES,), _in_recording)
