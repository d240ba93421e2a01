"""Faults that a single signal shows by itself: clipped, repeated, constant, spiked, jumping."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.findings import Warned
from jointid.estimate.wording import percent
from jointid.identification.facts import Facts
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_DRIVE = ("torque", "motor_torque", "current")
_CLIPPED = 0.01  # share of the samples on a limit
_FINE = 30.0  # a usual step in quanta, from which on equal neighbours are no coincidence
_REPEATED = 0.03
_FROZEN = 0.05  # share of the samples in frozen runs
_FROZEN_RUN = 0.1  # [s]
_MOVING = 0.1  # of the peak speed
_STILL = 0.005
_SPIKE = 25.0  # usual changes over the spike's width
_SPIKE_OF_RANGE = 0.1
_COMMAND_SPIKE_OF_RANGE = 0.3  # a controller may well hit back hard for a moment
_POSITION_SPIKE = 8.0  # usual changes: inertia makes a position smooth
_SPIKE_WIDTHS = (1, 3)  # samples


def _steps(signal: Array) -> Array:
    return np.abs(np.diff(signal))


def _resolution(steps: Array) -> float:
    """A usual step over the smallest one: how far the signal is from coarse."""
    moved = steps[steps > 0.0]
    return float(np.median(moved) / moved.min()) if moved.size else 0.0


def _moving(recording: Recording) -> NDArray[np.bool_]:
    """Sample intervals at a fair speed."""
    speed = np.abs(recording.velocity)
    return np.asarray(np.minimum(speed[1:], speed[:-1]) > _MOVING * speed.max())


def _on_a_limit(recording: Recording, signal: Array) -> float:
    """Share of the samples that lie on a limit which cuts the signal off."""
    reach = float(np.ptp(signal))
    if reach == 0.0:
        return 0.0
    steps = _steps(signal)
    fine = _resolution(steps) >= _FINE
    speed = np.abs(recording.velocity)
    # At rest a clean signal stays where it is, and that may be its largest value.
    free = speed > _STILL * speed.max()
    share = 0.0
    for limit, inward in ((signal.max(), -1.0), (signal.min(), 1.0)):
        distance = (signal - limit) * inward
        there = np.count_nonzero((distance == 0.0) & free)
        near = np.count_nonzero(distance <= 0.01 * reach) - np.count_nonzero(distance == 0.0)
        if fine or there > 3 * near:
            share += there / signal.size
    # A signal of few levels (a square wave) rests on its limits by nature.
    changing = np.count_nonzero(steps) > 0.3 * (1.0 - share) * steps.size
    return share if changing else 0.0


def _off_its_limits(signal: Array) -> NDArray[np.bool_]:
    """Sample intervals that do not begin on the signal's largest or smallest value."""
    begins = signal[:-1]
    return np.asarray((begins < signal.max()) & (begins > signal.min()))


def clipped(facts: Facts) -> Iterator[Warned]:
    """A torque or a sensor that rests on its largest value."""
    for recording in facts.recordings:
        for name in (*_DRIVE, "sensor"):
            signal = getattr(recording, name)
            if signal is None:
                continue
            share = _on_a_limit(recording, signal)
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
                        f"{name} rests on its limit of {np.abs(signal).max():.4g} {recording.unit(name)} in "
                        f"{percent(share)} of the samples; if it was clipped after the fact, every value is wrong: "
                        "move more gently, or record the torque that the drive applied"
                    ),
                )


def repeated(facts: Facts) -> Iterator[Warned]:
    """Samples that merely repeat the one before while the joint moves."""
    for recording in facts.recordings:
        moving = _moving(recording)
        stale = {}
        for name in ("position", "velocity", "sensor"):
            if name == "velocity" and recording.velocity_derived:
                continue
            share = repeated_share(recording, name, moving)
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


def repeated_share(
    recording: Recording, name: str, moving: NDArray[np.bool_] | None = None
) -> float:
    """Share of the moving samples at which a finely resolved signal does not change."""
    signal = getattr(recording, name)
    moving = _moving(recording) if moving is None else moving
    if signal is None or not moving.any():
        return 0.0
    steps = _steps(signal)
    if _resolution(steps) < _FINE:
        return 0.0
    return float(np.mean((steps == 0.0)[moving] & _off_its_limits(signal)[moving]))


def constant(facts: Facts) -> Iterator[Warned]:
    """A sensor or torque that never changes, or hangs for a while as the joint moves."""
    for recording in facts.recordings:
        moving = _moving(recording)
        for name in (*_DRIVE, "sensor"):
            signal = getattr(recording, name)
            if signal is None:
                continue
            share = 1.0 if np.ptp(signal) == 0.0 else _frozen(recording, signal, moving)
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


def _frozen(recording: Recording, signal: Array, moving: NDArray[np.bool_]) -> float:
    steps = _steps(signal)
    if _resolution(steps) < _FINE:
        return 0.0
    still = (steps == 0.0) & moving & _off_its_limits(signal)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], still, [False]]).astype(np.int8)))
    lengths = edges[1::2] - edges[::2]
    long = lengths * recording.sample_period > _FROZEN_RUN
    return float(lengths[long & (lengths > 10)].sum() / signal.size)


def spikes(facts: Facts) -> Iterator[Warned]:
    """Single samples far off both neighbours, and positions that jump."""
    for recording in facts.recordings:
        for name in ("position", "velocity", *_DRIVE, "sensor"):
            signal = getattr(recording, name)
            if signal is None or (name == "velocity" and recording.velocity_derived):
                continue
            height, index, count = _largest_spike(name, signal)
            if count:
                yield Warned(
                    code="spikes",
                    parameters=(),
                    message=(
                        f"{count} spike(s) in {name}, the largest of {height:.3g} {recording.unit(name)} at "
                        f"{recording.time[index]:.4g} s, where the signal leaves its course and returns at once: least "
                        "squares takes it at its word; cut it out, or mend the logger"
                    ),
                )
                break
        jump = _largest_jump(recording)
        if jump is not None:
            yield Warned(
                code="jumps",
                parameters=(),
                message=(
                    f"the position jumps by {recording.position[jump + 1] - recording.position[jump]:.4g} "
                    f"{recording.unit('position')} at {recording.time[jump]:.4g} s: a wrapped angle, a lost index or "
                    "lost samples; unwrap it, or crop the recording there"
                ),
            )


def _largest_spike(name: str, signal: Array) -> tuple[float, int, int]:
    """Height of the largest spike, its sample, and how many there are."""
    low, high = np.percentile(signal, (2.5, 97.5))
    share = _COMMAND_SPIKE_OF_RANGE if name in _DRIVE else _SPIKE_OF_RANGE
    for width in _SPIKE_WIDTHS[:1] if name in _DRIVE else _SPIKE_WIDTHS:
        change = signal[width:] - signal[:-width]
        there, back = change[:-width], -change[width:]
        height = np.where(there * back > 0.0, np.minimum(np.abs(there), np.abs(back)), 0.0)
        sizes = np.abs(change)
        usual = float(np.median(sizes[sizes > 0.0])) if np.any(sizes > 0.0) else np.inf
        if name == "position":
            limit = _POSITION_SPIKE * usual
        else:
            limit = max(_SPIKE * usual, share * width**0.5 * float(high - low))
        count = int(np.count_nonzero(height > limit))
        if count:
            index = int(np.argmax(height))
            return float(height[index]), index + width, -(-count // width)
    return 0.0, 0, 0


def _largest_jump(recording: Recording) -> int | None:
    """The sample after which the position moves on faster than it ever does otherwise."""
    steps = np.diff(recording.position)
    rate = np.abs(steps / np.diff(recording.time))
    index = int(np.argmax(rate))
    usual = float(np.percentile(rate, 99.0))
    if rate[index] < 4.0 * usual or not 0 < index < steps.size - 1:
        return None
    # A spike goes back; a jump stays.
    beside = np.abs(steps[[index - 1, index + 1]]).max()
    quantum = _steps(recording.position)
    finest = quantum[quantum > 0.0].min()
    return index if beside < 0.5 * abs(steps[index]) > 4.0 * finest else None


def _sensor_parameters(facts: Facts) -> tuple[str, ...]:
    return tuple(name for name in ("sensor_gain", "sensor_offset") if name in facts.parameters)
