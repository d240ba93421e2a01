"""Single samples far from both neighbours, and positions that jump."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from jointid import _core
from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected, spike_of
from jointid.recording.order_statistics import median
from jointid.recording.recording import Recording

SPIKES = FindingType(
    code="spikes",
    meaning="single samples lie far from their neighbours and distort the least-squares fit",
    advice="delete those rows, and check the logger",
)
JUMPS = FindingType(
    code="jumps",
    severity="blocking",
    meaning="the position jumps, and neither the velocity nor the neighbouring samples show this jump. "
    "Possible causes: the angle wraps, the encoder lost its index, or samples are lost",
    advice="unwrap the angle, or cut the recording at the jump",
)

_JUMP = 10.0  # times the usual change of the velocity between samples
_BESIDE = 1  # samples


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording = inspected.recording
    for name in inspected.channels:
        spike = _without_kicks(inspected) if name == "sensor" else inspected.spike(name)
        if spike.count:
            unit = "" if name == "sensor" else recording.unit(name)
            height = f"{spike.height:.3g} {unit}".rstrip()
            time = float(recording.time[spike.index])
            yield SPIKES.finding(
                f"{name} has a spike of {height} at {time:.4g} s (number of spikes: {spike.count})",
                Action("inspect", text="the logger, and delete the rows with spikes"),
                details="a spike is one sample far from its neighbours",
                evidence={
                    "spikes": Measured(spike.count),
                    "height": Measured(spike.height, unit),
                    "time": Measured(time, "s"),
                },
            )
            break
    jump = inspected.found.jump
    if jump >= 0 and not _is_motion(recording, jump):
        step = float(recording.position[jump + 1] - recording.position[jump])
        unit, time = recording.unit("position"), float(recording.time[jump])
        yield JUMPS.finding(
            f"the position jumps by {step:.4g} {unit} at {time:.4g} s",
            Action(
                "inspect", text="the rows at the jump, and unwrap the angle or cut the log there"
            ),
            details="the angle wraps, the encoder lost its index, or samples are lost",
            evidence={"height": Measured(step, unit), "time": Measured(time, "s")},
        )


def _is_motion(recording: Recording, jump: int) -> bool:
    """Return whether a recorded velocity, or the steps next to a jump, account for half of the jump."""
    changes = np.diff(recording.position)
    half = 0.5 * abs(float(changes[jump]))
    if not recording.velocity_derived:
        ends = recording.velocity[jump : jump + 2]
        passed = float(ends.mean()) * float(recording.time[jump + 1] - recording.time[jump])
        if abs(float(changes[jump]) - passed) < half:
            return True
    new = np.flatnonzero(changes)  # repeated rows have no step
    place = int(np.searchsorted(new, jump))
    beside = changes[[*new[max(0, place - 1) : place], *new[place + 1 : place + 2]]]
    return bool(np.abs(beside).max(initial=0.0) > half)


def _without_kicks(inspected: Inspected) -> _core.Spike:
    """Return the sensor's largest spike, without those from the link's response to jumps of the velocity.

    Such a jump comes from a friction compensation that changes its sign at a reversal and stops the drive at once.
    """
    recording, spike = inspected.recording, inspected.spike("sensor")
    if not spike.count or recording.sensor is None:
        return spike
    change = np.abs(np.diff(recording.velocity, prepend=recording.velocity[0]))
    moving = change[change > 0.0]
    jumps = np.flatnonzero(change > _JUMP * median(moving)) if moving.size else moving
    if not np.any(np.abs(jumps - spike.index) <= _BESIDE):
        return spike
    kept = np.ones(len(recording), dtype=bool)
    for step in range(-_BESIDE, _BESIDE + 1):
        kept[np.clip(jumps + step, 0, len(recording) - 1)] = False
    if not kept.any():
        return spike
    smooth = np.interp(recording.time, recording.time[kept], recording.sensor[kept])
    return spike_of(recording, smooth, inspected.threads)


CHECK = Check(None, (SPIKES, JUMPS), _in_recording)
