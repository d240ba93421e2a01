"""Properties of the signals of one recording, computed once by the core for all checks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.recording.corrections import Mend
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
    found : Inspection
        Properties of the signals.
    channels : tuple of str
        Inspected signals, in the order of `found.facts` and `found.spikes`.
    threads : int
        Number of threads for further inspections; 0: all.
    mends : tuple of Mend
        Corrections of the recording.
    """

    recording: Recording
    found: _core.Inspection
    channels: tuple[str, ...]
    threads: int = 0
    mends: tuple[Mend, ...] = ()

    def counts(self, name: str) -> _core.SignalFacts:
        """Return the counts of one signal."""
        return self.found.facts[self.channels.index(name)]

    def spike(self, name: str) -> _core.Spike:
        """Return the largest spike of one signal."""
        return self.found.spikes[self.channels.index(name)]

    def stale_share(self, name: str) -> float:
        """Return the share of the moving samples in which a finely resolved signal does not change."""
        counts = self.counts(name)
        return counts.stale / counts.moving if counts.fine and counts.moving else 0.0


def inspect(recording: Recording, threads: int = 0, mends: tuple[Mend, ...] = ()) -> Inspected:
    """Inspect all signals of a recording."""
    signals = {
        name: signal
        for name in _CHANNELS
        if (signal := getattr(recording, name)) is not None
        and not (name == "velocity" and recording.velocity_derived)
    }
    rules = {"position": _core.SpikeRule.position} | dict.fromkeys(DRIVE, _core.SpikeRule.command)
    found = _core.inspect(
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
    return Inspected(
        recording=recording, found=found, channels=tuple(signals), threads=threads, mends=mends
    )


def spike_of(recording: Recording, sensor: Array, threads: int) -> _core.Spike:
    """Return the largest spike of a reading in place of the recorded one."""
    found = _core.inspect(
        time=recording.time,
        position=recording.position,
        velocity=recording.velocity,
        velocity_derived=recording.velocity_derived,
        period=recording.sample_period,
        channels=[(sensor, _core.SpikeRule.other, True)],
        threads=threads,
    )
    return found.spikes[0]
