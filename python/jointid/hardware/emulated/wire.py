"""A wire that carries one frame at a time; of the waiting frames, the lowest identifier is next."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import can

from jointid.hardware.can.wire_time import frame_time
from jointid.hardware.emulated.device import Event
from jointid.hardware.emulated.faults import BusFault, mangled

_NETWORKS = Path("/sys/class/net")
_WITHOUT_WIRE = ("virtual", "udp_multicast")
Arrive = Callable[[can.Message], None]


@dataclass(slots=True, kw_only=True)
class _Frame:
    """A frame that waits for the wire or is on it."""

    message: can.Message
    arrive: Arrive
    put: float  # [s], time at which it was queued
    delay: float  # [s], after the wire


class Wire:
    """Give each frame its time on the wire, by priority.

    A sender's own frames keep their order, as in the queue of one controller.

    Parameters
    ----------
    now, at : callable
        The clock [s], and a function that runs an event at a time.
    bitrate : float or None
        Bit rate [bit/s]. None: frames take no time.
    faults : sequence of BusFault
        Faults and their times.
    data_bitrate : float, optional
        Bit rate of the data of CAN FD frames [bit/s]. Default: the same.
    """

    def __init__(
        self,
        now: Callable[[], float],
        at: Callable[[float, Event], None],
        bitrate: float | None,
        faults: Sequence[BusFault] = (),
        data_bitrate: float | None = None,
    ) -> None:
        self._now, self._at = now, at
        self._bitrate, self._data_bitrate, self._faults = bitrate, data_bitrate, faults
        self._queues: dict[int, deque[_Frame]] = {}
        self._busy = False
        self._free = 0.0  # [s], end of the last frame

    def put(self, message: can.Message, sender: object, arrive: Arrive, *, from_host: bool) -> None:
        """Queue a frame until the wire is free.

        Parameters
        ----------
        message : can.Message
        sender : object
            Owner of the queue.
        arrive : callable
            Receives the arriving frame.
        from_host : bool
        """
        now = self._now()
        queue = self._queues.setdefault(id(sender), deque())
        for copy, delay in mangled(message, self._faults, now, from_host=from_host):
            queue.append(_Frame(message=copy, arrive=arrive, put=now, delay=delay))
        if queue and not self._busy:
            self._at(now, self._arbitrate)  # after all frames that are queued now

    def _arbitrate(self) -> None:
        waiting = [queue for queue in self._queues.values() if queue]
        if self._busy or not waiting:
            return
        frame = min(waiting, key=lambda queue: _priority(queue[0].message)).popleft()
        took = 0.0
        if self._bitrate is not None:
            took = frame_time(frame.message, self._bitrate, self._data_bitrate)
        end = max(frame.put, self._free) + took
        self._busy = True
        self._at(end, lambda: self._finish(frame, end))

    def _finish(self, frame: _Frame, end: float) -> None:
        self._busy, self._free = False, end
        if frame.delay:
            self._at(end + frame.delay, lambda: frame.arrive(frame.message))
        else:
            frame.arrive(frame.message)
        self._arbitrate()


def _priority(message: can.Message) -> tuple[int, bool]:
    """Return the priority: the lowest value is sent first. Of equal identifiers, the frame with data is first."""
    identifier = message.arbitration_id
    return (identifier if message.is_extended_id else identifier << 18), message.is_remote_frame


def bitrate_to_emulate(interface: str, channel: str | None, bitrate: float) -> float | None:
    """Return the bit rate that an emulator has to imitate on a bus.

    Parameters
    ----------
    interface, channel : str
        Names as in python-can.
    bitrate : float
        Bit rate of the emulated bus [bit/s].

    Returns
    -------
    float or None
        None if a controller sends the frames on a real wire, which takes its own time.
    """
    if interface == "socketcan":
        return None if (_NETWORKS / str(channel) / "device").exists() else bitrate
    return bitrate if interface in _WITHOUT_WIRE else None
