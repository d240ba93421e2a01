"""Interface between an emulated device and its bus, on virtual or real time."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Callable, Iterator, Sequence
from typing import Protocol

import can

from jointid.hardware.can.canopen_frames import bits_on_wire
from jointid.hardware.emulated.faults import BusFault, mangled

Event = Callable[[], None]


class DeviceBus(Protocol):
    """The services that a bus gives to the devices on it."""

    def now(self) -> float:
        """Time [s] since the bus began; never goes back."""

    def at(self, when: float, event: Event) -> None:
        """Run something when the clock gets there [s]."""

    def transmit(self, message: can.Message) -> None:
        """Put a device's frame on the wire."""


class Device(Protocol):
    """A device on a bus: an emulated drive, a converter."""

    def attach(self, bus: DeviceBus) -> None:
        """Remember the bus."""

    def receive(self, message: can.Message) -> None:
        """A frame from the host has arrived, now."""


class Agenda:
    """What is to be run, and when; what is due at the same time runs in the order of asking."""

    def __init__(self) -> None:
        self._events: list[tuple[float, int, Event]] = []
        self._count = itertools.count()

    def add(self, when: float, event: Event) -> None:
        """Run `event` at `when` [s]."""
        heapq.heappush(self._events, (when, next(self._count), event))

    @property
    def next(self) -> float:
        """When the next is due [s]; infinite when nothing is."""
        return self._events[0][0] if self._events else float("inf")

    def pop(self) -> tuple[float, Event]:
        """Take the next off, and when it was due."""
        when, _, event = heapq.heappop(self._events)
        return when, event


class Wire:
    """Two wires that one frame at a time is on, for as long as its bits take.

    Parameters
    ----------
    bitrate : float or None
        [bit/s]; None: frames take no time.
    faults : sequence of BusFault
        What goes wrong, and when.
    """

    def __init__(self, bitrate: float | None, faults: Sequence[BusFault] = ()) -> None:
        self._bitrate, self._faults = bitrate, faults
        self._free = 0.0

    def arrivals(
        self, message: can.Message, now: float, *, from_host: bool
    ) -> Iterator[tuple[can.Message, float]]:
        """What arrives of a frame sent now, and when [s]."""
        for copy, delay in mangled(message, self._faults, now, from_host=from_host):
            begin = max(now + delay, self._free)
            took = 0.0 if self._bitrate is None else bits_on_wire(copy.dlc) / self._bitrate
            if delay == 0.0:
                self._free = begin + took
            yield copy, begin + took
