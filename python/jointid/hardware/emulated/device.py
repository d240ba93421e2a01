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
        """A frame of the host's or of another device's has arrived, now."""


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


class Port:
    """Where one device is connected: the services of a bus, and who sends.

    Parameters
    ----------
    now, at, transmit : callable
        The bus's clock and agenda; what it does with a frame and its sender.
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
        """Put the device's frame on the wire."""
        self._transmit(message, self._device)
