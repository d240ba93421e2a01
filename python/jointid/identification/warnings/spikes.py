"""Single samples far off both neighbours, and positions that jump."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

SPIKES = FindingType(
    code="spikes",
    meaning="single samples lie far off their neighbours",
    advice="cut them out, or check the logger",
)
JUMPS = FindingType(
    code="jumps",
    meaning="the position jumps: a wrapped angle, a lost index or lost samples",
    advice="unwrap the angle, or crop the recording there",
)


def _find(evidence: Evidence) -> Iterator[Finding]:
    for inspected in evidence.inspections:
        recording = inspected.recording
        for name in inspected.channels:
            spike = inspected.spike(name)
            if spike.count:
                unit = "" if name == "sensor" else recording.unit(name)
                height = f"{spike.height:.3g} {unit}".rstrip()
                time = float(recording.time[spike.index])
                yield SPIKES.finding(
                    f"{spike.count} spike(s) in {name}, the largest of {height} at {time:.4g} s, "
                    "where the signal leaves its course and returns at once: least squares fits them, too",
                    Action("inspect", text="the logger, and cut the spikes out"),
                    evidence={
                        "spikes": Measured(spike.count),
                        "height": Measured(spike.height, unit),
                        "time": Measured(time, "s"),
                    },
                )
                break
        jump = inspected.found.jump
        if jump >= 0:
            step = float(recording.position[jump + 1] - recording.position[jump])
            unit, time = recording.unit("position"), float(recording.time[jump])
            yield JUMPS.finding(
                f"the position jumps by {step:.4g} {unit} at {time:.4g} s: a wrapped angle, a lost index or lost "
                "samples",
                Action("inspect", text="the recording there, and unwrap the angle or crop it"),
                evidence={"height": Measured(step, unit), "time": Measured(time, "s")},
            )


CHECK = Check(_find, (SPIKES, JUMPS))
