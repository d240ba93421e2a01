"""Interface between an emulated device and its bus, on virtual or real time."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Callable
from typing import Protocol

import can

Event = Callable[[], None]


class DeviceBus(Protocol):
    """The services that a bus gives to the devices on it."""

    def now(self) -> float:
        """Return the time since the start [s]; it never decreases."""

    def at(self, when: float, event: Event) -> None:
        """Run a callable when the clock reaches a time [s]."""

    def transmit(self, message: can.Message) -> None:
        """Send a device's frame on the wire."""


class Device(Protocol):
    """A device on a bus, for example an emulated drive or a converter."""

    def attach(self, bus: DeviceBus) -> None:
        """Remember the bus."""

    def receive(self, message: can.Message) -> None:
        """Take a frame of the host or of another device, at its arrival."""


class Agenda:
    """Events and their times. Events at the same time run in the order in which they were added."""

    def __init__(self) -> None:
        self._events: list[tuple[float, int, Event]] = []
        self._count = itertools.count()

    def add(self, when: float, event: Event) -> None:
        """Run `event` at `when` [s]."""
        heapq.heappush(self._events, (when, next(self._count), event))

    @property
    def next(self) -> float:
        """Time of the next event [s]; infinite without one."""
        return self._events[0][0] if self._events else float("inf")

    def pop(self) -> tuple[float, Event]:
        """Remove the next event. Return its time and the event."""
        when, _, event = heapq.heappop(self._events)
        return when, event


class Port:
    """Connection of one device to a bus: the services of the bus, and the sender of its frames.

    Parameters
    ----------
    now, at, transmit : callable
        Clock and agenda of the bus; its function for a frame and the sender.
    device : Device
    """

    def __init__(
        self,
        now: Callable[[], float],
        at: Callable[[float, Event], None],
        transmit: Callable[[can.Message, Device], None],
        device: Device,
    ) -> None:
        self.now, self.at = now, at
        self._transmit, self._device = transmit, device

    def transmit(self, message: can.Message) -> None:
        """Send the device's frame on the wire."""
        self._transmit(message, self._device)
