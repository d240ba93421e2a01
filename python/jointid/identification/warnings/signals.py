"""Faults that a single signal shows by itself: clipped, repeated, constant, spiked, jumping."""

from __future__ import annotations

from collections.abc import Iterator

from jointid import _core
from jointid.estimate.statistics import Warned
from jointid.estimate.wording import percent
from jointid.identification.warnings.evidence import Facts
from jointid.identification.warnings.inspection import DRIVE

_CLIPPED = 0.01  # share of the samples on a limit
_REPEATED = 0.03
_FROZEN = 0.05  # share of the samples in frozen runs


def _on_a_limit(facts: _core.SignalFacts, samples: int) -> float:
    """Share of the samples that lie on a limit which cuts the signal off."""
    if facts.lowest == facts.highest:
        return 0.0
    share = 0.0
    for limit in (facts.upper, facts.lower):
        # At rest a clean signal stays where it is, and that may be its largest value.
        if facts.fine or limit.moving > 3 * (limit.near - limit.there):
            share += limit.moving / samples
    # A signal of few levels (a square wave) rests on its limits by nature.
    changing = facts.changes > 0.3 * (1.0 - share) * (samples - 1)
    return share if changing else 0.0


def clipped(facts: Facts) -> Iterator[Warned]:
    """A torque or a sensor that rests on its largest value."""
    for inspected in facts.inspections:
        recording = inspected.recording
        for name in inspected.channels:
            if name not in (*DRIVE, "sensor"):
                continue
            signal = inspected.facts(name)
            share = _on_a_limit(signal, len(recording))
            if share < _CLIPPED:
                continue
            if name == "sensor":
                yield Warned(
                    code="sensor_clipped",
                    parameters=_sensor_parameters(facts),
                    message=(
                        f"the sensor rests on its limit in {percent(share)} of the samples, so it reads less than "
                        "the torque was: widen its range, or move the link so that it carries less"
                    ),
                )
            else:
                yield Warned(
                    code="torque_saturated",
                    parameters=(),
                    message=(
                        f"{name} rests on its limit of {max(abs(signal.lowest), abs(signal.highest)):.4g} "
                        f"{recording.unit(name)} in "
                        f"{percent(share)} of the samples; if it was clipped after the fact, every value is wrong: "
                        "move more gently, or record the torque that the drive applied"
                    ),
                )


def repeated(facts: Facts) -> Iterator[Warned]:
    """Samples that merely repeat the one before while the joint moves."""
    for inspected in facts.inspections:
        stale = {}
        for name in ("position", "velocity", "sensor"):
            share = inspected.stale_share(name) if name in inspected.channels else 0.0
            if share > _REPEATED:
                stale[name] = share
        if stale:
            yield Warned(
                code="repeated_samples",
                parameters=(),
                message=(
                    f"{' and '.join(stale)} repeat the sample before in {percent(max(stale.values()))} of the samples "
                    "though the joint moves: the logger was faster than the drive's bus; drop the copies, or record "
                    "at the drive's own rate"
                ),
            )


def constant(facts: Facts) -> Iterator[Warned]:
    """A sensor or torque that never changes, or hangs for a while as the joint moves."""
    for inspected in facts.inspections:
        for name in inspected.channels:
            if name not in (*DRIVE, "sensor"):
                continue
            signal = inspected.facts(name)
            share = signal.frozen / len(inspected.recording) if signal.fine else 0.0
            if signal.lowest == signal.highest:
                share = 1.0
            if share < _FROZEN:
                continue
            names = _sensor_parameters(facts) if name == "sensor" else ()
            hangs = "never changes" if share == 1.0 else f"hangs in {percent(share)} of the samples"
            yield Warned(
                code="constant_signal",
                parameters=names,
                message=(
                    f"{name} {hangs} while the joint moves: check its cable and its mapping; "
                    + (
                        "gain and offset cannot be told"
                        if names
                        else "the values are not to be used"
                    )
                ),
            )


def spikes(facts: Facts) -> Iterator[Warned]:
    """Single samples far off both neighbours, and positions that jump."""
    for inspected in facts.inspections:
        recording = inspected.recording
        for name in inspected.channels:
            spike = inspected.spike(name)
            if spike.count:
                yield Warned(
                    code="spikes",
                    parameters=(),
                    message=(
                        f"{spike.count} spike(s) in {name}, the largest of {spike.height:.3g} "
                        f"{recording.unit(name)} at {recording.time[spike.index]:.4g} s, where the signal leaves its "
                        "course and returns at once: least squares takes it at its word; cut it out, or mend the logger"
                    ),
                )
                break
        jump = inspected.found.jump
        if jump >= 0:
            yield Warned(
                code="jumps",
                parameters=(),
                message=(
                    f"the position jumps by {recording.position[jump + 1] - recording.position[jump]:.4g} "
                    f"{recording.unit('position')} at {recording.time[jump]:.4g} s: a wrapped angle, a lost index or "
                    "lost samples; unwrap it, or crop the recording there"
                ),
            )


def _sensor_parameters(facts: Facts) -> tuple[str, ...]:
    return tuple(name for name in ("sensor_gain", "sensor_offset") if name in facts.parameters)
