"""What happens to an emulated drive, told line by line while it runs."""

from __future__ import annotations

import json
from typing import Any, Protocol, TextIO

import can

from jointid.hardware.emulated.device import DeviceBus


class Telling(Protocol):
    """A device that can tell its condition."""

    def condition(self) -> dict[str, Any]:
        """What counts as an event when it changes, by name, and what else is worth telling.

        Returns
        -------
        dict
            "events": the values whose change is an event; any others; of JSON's types.
        """


class Journal:
    """Writes a line of JSON whenever a device's condition has changed.

    It is a device itself, which hears all frames, and the `watch` of an `EmulatorThread`. A line has
    "time", by the devices' clock, the device's condition, and "heard": when the last frame of each
    identifier (in hexadecimal digits) arrived.

    Parameters
    ----------
    device : Telling
    stream : text stream
        Flushed after each line.
    """

    def __init__(self, device: Telling, stream: TextIO) -> None:
        self._device, self._stream = device, stream
        self._told: object = None
        self._heard: dict[int, float] = {}
        self._bus: DeviceBus | None = None

    def attach(self, bus: DeviceBus) -> None:
        """Remember the bus."""
        self._bus = bus

    def receive(self, message: can.Message) -> None:
        """Note when it arrived."""
        assert self._bus is not None, "attach the journal to a bus"
        self._heard[message.arbitration_id] = self._bus.now()

    def __call__(self, time: float) -> None:
        """Write a line if something has changed."""
        condition = self._device.condition()
        events = condition.pop("events")
        if events == self._told:
            return
        self._told = events
        heard = {f"{identifier:03X}": when for identifier, when in self._heard.items()}
        line = {"time": time, **events, **condition, "heard": heard}
        self._stream.write(json.dumps(line) + "\n")
        self._stream.flush()
