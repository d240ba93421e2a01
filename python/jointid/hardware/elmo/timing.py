"""Estimate from the frames when an Elmo drive samples and when it acts on a command."""

from __future__ import annotations

import math

from jointid.hardware.can.wire_time import bits_on_wire
from jointid.hardware.elmo.options import ElmoOptions

_EARLY = 0.25  # share of a SYNC: a frame that began by then was sent before the SYNC


class SyncWatch:
    """Estimate when drive and converter sampled: at the arrival of the SYNC.

    Our own frames are sent one after the other, so the SYNC waits for a command that was sent late. A frame
    of another node that was on the wire when the SYNC was sent, such as the drive's heartbeat, delays the
    SYNC too. A frame between the SYNC and its answer delays only the answer. Arrival times that are exact to
    the microsecond show which case it was.

    Parameters
    ----------
    bitrate : float
        Bit rate [bit/s].
    stamped : bool
        Whether arrival times are exact to the microsecond.
    """

    def __init__(self, bitrate: float, *, stamped: bool) -> None:
        self._bitrate, self._stamped = bitrate, stamped
        self._sent = self._free = self._busy = 0.0
        self._latest = math.inf

    def sent(self, when: float) -> None:
        """Note the time at which the SYNC was sent [s]."""
        self._sent = self._free = max(when, self._busy)
        self._latest = math.inf
        self._busy = self._sent + bits_on_wire(0) / self._bitrate

    def own(self, when: float, length: int) -> None:
        """Note another frame of ours: send time [s] and number of bytes."""
        self._busy = max(when, self._busy) + bits_on_wire(length) / self._bitrate

    def came(self, when: float, length: int, *, answers: bool) -> None:
        """Note a received frame: arrival time [s] and number of bytes. The position's frame answers the SYNC."""
        begun = when - bits_on_wire(length) / self._bitrate
        if begun < self._sent + _EARLY * bits_on_wire(0) / self._bitrate and self._sent < when:
            self._free = when
        if answers:
            self._latest = begun

    @property
    def sampled(self) -> float:
        """Sample time [s]."""
        if not self._stamped:
            return self._sent + bits_on_wire(0) / self._bitrate
        return min(self._free + bits_on_wire(0) / self._bitrate, self._latest)


def command_latency(options: ElmoOptions) -> float:
    """Estimate the delay from sending a command until the drive acts on it [s]."""
    return bits_on_wire(8) / options.bitrate + options.execution_delay
