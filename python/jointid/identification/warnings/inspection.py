"""Properties of the signals of one recording: computed by the core once, for all checks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

DRIVE = ("torque", "motor_torque", "current")
_CHANNELS = ("position", "velocity", *DRIVE, "sensor")


@dataclass(frozen=True, slots=True, kw_only=True)
class Inspected:
    """A recording and the properties of its signals.

    Attributes
    ----------
    recording : Recording
    work : Beside
        The core's look at them.
    channels : tuple of str
        The signals looked at, in the order of `found.facts` and `found.spikes`.
    threads : int
        For a further look; 0: all.
    """

    recording: Recording
    work: _core.Beside
    channels: tuple[str, ...]
    threads: int = 0

    @property
    def found(self) -> _core.Inspection:
        """What the signals show; it waits for the core."""
        found: _core.Inspection = self.work.result()
        return found

    def counts(self, name: str) -> _core.SignalFacts:
        """Counts of one signal."""
        return self.found.facts[self.channels.index(name)]

    def spike(self, name: str) -> _core.Spike:
        """The largest spike of one signal."""
        return self.found.spikes[self.channels.index(name)]

    def stale_share(self, name: str) -> float:
        """Share of the moving samples at which a finely resolved signal does not change."""
        counts = self.counts(name)
        return counts.stale / counts.moving if counts.fine and counts.moving else 0.0


def inspect(recording: Recording, threads: int = 0) -> Inspected:
    """Begin to inspect all signals of a recording."""
    signals = {
        name: signal
        for name in _CHANNELS
        if (signal := getattr(recording, name)) is not None
        and not (name == "velocity" and recording.velocity_derived)
    }
    rules = {"position": _core.SpikeRule.position} | dict.fromkeys(DRIVE, _core.SpikeRule.command)
    work = _core.inspect(
        time=recording.time,
        position=recording.position,
        velocity=recording.velocity,
        velocity_derived=recording.velocity_derived,
        period=recording.sample_period,
        channels=[
            (signal, rules.get(name, _core.SpikeRule.other), True)
            for name, signal in signals.items()
        ],
        threads=threads,
    )
    return Inspected(recording=recording, work=work, channels=tuple(signals), threads=threads)


def inspect_each(recordings: Sequence[Recording], threads: int) -> tuple[Inspected, ...]:
    """Begin to inspect recordings: a single one, which is short, beside what follows."""
    begun = []
    for run in recordings:
        begun.append(inspect(run, threads))
        if len(recordings) > 1:  # not as many threads as recordings
            begun[-1].work.result()
    return tuple(begun)


def spike_of(recording: Recording, sensor: Array, threads: int) -> _core.Spike:
    """The largest spike of a reading in place of the recorded one."""
    found = _core.inspect(
        time=recording.time,
        position=recording.position,
        velocity=recording.velocity,
        velocity_derived=recording.velocity_derived,
        period=recording.sample_period,
        channels=[(sensor, _core.SpikeRule.other, True)],
        threads=threads,
    ).result()
    spike: _core.Spike = found.spikes[0]
    return spike
