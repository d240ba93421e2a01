"""A CAN bus with a clock of its own: frames take their time on the wire, waiting moves the clock."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

import can

from jointid.hardware.emulated.device import Agenda, Device, Event, Wire
from jointid.hardware.emulated.faults import BusFault


class EmulatedBus(can.BusABC):
    """A bus for python-can's users, behind which devices are emulated on virtual time.

    `recv` and `sleep_until` run what is due and move the clock; nothing runs by itself, so the same
    calls give bit-identical frames and times.

    Parameters
    ----------
    devices : Device
    bitrate : float
        [bit/s]; None: frames take no time. Default 500 000.
    faults : sequence of BusFault
        What goes wrong on the wire, and when.
    """

    def __init__(
        self, *devices: Device, bitrate: float | None = 500_000.0, faults: tuple[BusFault, ...] = ()
    ) -> None:
        super().__init__(channel="emulated")
        self.channel_info = "emulated bus on virtual time"
        self.bitrate = bitrate
        self._faults = faults
        self._time = 0.0
        self._wire = Wire(bitrate, faults)
        self._agenda = Agenda()
        self._inbox: deque[can.Message] = deque()
        self.sent = 0
        self.host_work = 0.0  # [s] that passes with each frame of the host's: its own computing
        self._devices = devices
        for device in devices:
            device.attach(self)

    def now(self) -> float:
        """Virtual time [s]."""
        return self._time

    def at(self, when: float, event: Event) -> None:
        """Run something when the clock gets there."""
        self._agenda.add(max(when, self._time), event)

    def sleep_until(self, deadline: float) -> None:
        """Run what is due until the deadline, and be there."""
        while self._agenda.next <= deadline:
            self._run_next()
        self._time = max(self._time, deadline)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Put a frame of the host's on the wire.

        Raises
        ------
        can.CanOperationError
            The bus is down or off.
        """
        del timeout  # an emulated wire always takes a frame
        if self.host_work > 0.0:
            self.sleep_until(self._time + self.host_work)
        self._check_up()
        self.sent += 1
        self._on_wire(msg, self._to_devices, from_host=True)

    def transmit(self, message: can.Message) -> None:
        """Put a device's frame on the wire."""
        self._on_wire(message, self._to_host, from_host=False)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """The next frame for the host, waiting on virtual time.

        Raises
        ------
        can.CanOperationError
            The bus is down.
        """
        deadline = self._time + (3600.0 if timeout is None else timeout)
        while True:
            self._check_up()
            if self._inbox:
                return self._inbox.popleft()
            if self._agenda.next > deadline:
                self._time = deadline
                self._check_up()
                return None
            self._run_next()

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        return self.recv(timeout), True

    def shutdown(self) -> None:
        """Nothing to give back."""
        super().shutdown()

    def _run_next(self) -> None:
        when, event = self._agenda.pop()
        self._time = max(self._time, when)
        event()

    def _on_wire(
        self, message: can.Message, arrive: Callable[[can.Message], None], *, from_host: bool
    ) -> None:
        for copy, when in self._wire.arrivals(message, self._time, from_host=from_host):
            self.at(when, lambda arrived=copy: arrive(arrived))  # type: ignore[misc]

    def _to_devices(self, message: can.Message) -> None:
        for device in self._devices:
            device.receive(message)

    def _to_host(self, message: can.Message) -> None:
        message.timestamp = self._time
        self._inbox.append(message)

    def _check_up(self) -> None:
        for fault in self._faults:
            if fault.kind == "down" and fault.acts(self._time):
                raise can.CanOperationError("the network is down", 100)
            if fault.kind == "bus_off" and fault.acts(self._time) and not fault.reported:
                fault.reported = True
                self._inbox.appendleft(
                    can.Message(is_error_frame=True, arbitration_id=0x40, timestamp=self._time)
                )

    @staticmethod
    def _detect_available_configs() -> list[Any]:
        return []
