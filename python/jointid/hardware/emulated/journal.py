"""Report the events of an emulated drive line by line while it runs."""

from __future__ import annotations

import json
from typing import Any, Protocol, TextIO

import can

from jointid.hardware.emulated.device import DeviceBus


class Telling(Protocol):
    """A device that reports its condition."""

    def condition(self) -> dict[str, Any]:
        """Return the values that count as events when they change, and other values to report.

        Returns
        -------
        dict
            "events": the values that count as events when they change; and any others. All have JSON types.
        """


class Journal:
    """Write a line of JSON whenever a device's condition changes.

    The journal is a device itself, which receives all frames, and the `watch` of an `EmulatorThread`. A line
    has "time" on the devices' clock, the device's condition, and "heard": arrival time of the last frame of
    each identifier (in hexadecimal digits).

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
        """Note the arrival time of a frame."""
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
