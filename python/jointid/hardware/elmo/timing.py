"""When an Elmo drive samples and when it acts on a command, estimated from its frames."""

from __future__ import annotations

import math

from jointid.hardware.can.wire_time import bits_on_wire
from jointid.hardware.elmo.options import ElmoOptions

_EARLY = (
    0.25  # of a SYNC: what began by then went first, since what waits for the SYNC begins behind it
)
POSITION_LENGTH = 6
"""Bytes of the position's frame, as `elmo_setup.map_position` has it."""


class SyncWatch:
    """Estimates when drive and converter sampled: when the SYNC had arrived.

    Our own frames go out one after the other: behind a command that was sent late the SYNC waits. A frame of others
    that was on the wire when the SYNC was sent, such as the drive's heartbeat, delays the SYNC too;
    one that came between the SYNC and its answer delays the answer only. The frames' times of arrival
    show which it was, where they are known to the microsecond.

    Parameters
    ----------
    bitrate : float
        [bit/s]
    stamped : bool
        Times of arrival are that exact.
    """

    def __init__(self, bitrate: float, *, stamped: bool) -> None:
        self._bitrate, self._stamped = bitrate, stamped
        self._sent = self._free = self._busy = 0.0
        self._latest = math.inf

    def sent(self, when: float) -> None:
        """The SYNC was sent [s]."""
        self._sent = self._free = max(when, self._busy)
        self._latest = math.inf
        self._busy = self._sent + bits_on_wire(0) / self._bitrate

    def own(self, when: float, length: int) -> None:
        """Another frame of ours, of so many bytes, was sent [s]."""
        self._busy = max(when, self._busy) + bits_on_wire(length) / self._bitrate

    def came(self, when: float, length: int, *, answers: bool) -> None:
        """A frame of so many bytes has come [s]; the position's answers the SYNC."""
        begun = when - bits_on_wire(length) / self._bitrate
        if begun < self._sent + _EARLY * bits_on_wire(0) / self._bitrate and self._sent < when:
            self._free = when
        if answers:
            self._latest = begun

    @property
    def sampled(self) -> float:
        """When it was sampled [s]."""
        if not self._stamped:
            return self._sent + bits_on_wire(0) / self._bitrate
        return min(self._free + bits_on_wire(0) / self._bitrate, self._latest)


def command_latency(options: ElmoOptions) -> float:
    """From sending a command until the drive acts on it [s]."""
    return bits_on_wire(8) / options.bitrate + options.execution_delay
