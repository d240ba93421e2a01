"""A CAN bus in virtual time: frames take time on the wire, and waiting advances the clock."""

from __future__ import annotations

from collections import deque
from random import Random
from typing import Any

import can

from jointid.base.errors import InputError
from jointid.hardware.emulated.device import Agenda, Device, Event, Port
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.emulated.wire import Wire


class EmulatedBus(can.BusABC):
    """A python-can bus with emulated devices in virtual time.

    `recv` and `sleep_until` run due events and advance the clock. Nothing else runs, so the same calls give
    bit-identical frames and times.

    Parameters
    ----------
    devices : Device
    bitrate : float
        Bit rate [bit/s]. With None, the transmission of a frame takes no time. Default 500 000.
    faults : sequence of BusFault
        Faults of the emulated wire.
    clock_drift : float
        Relative error of the rate of the host's clock, compared with the clock of devices and joint. With 1e-4, the
        host's clock is fast by 100 ppm. Default 0. All times of this class are host times.
    jitter : float
        Largest random delay of the host after each wait for a time or a frame [s]. Default 0.
    seed : int
        Seed of the jitter. Default 0.
    data_bitrate : float, optional
        Bit rate of the data in CAN FD frames [bit/s]. Default: the same as `bitrate`.

    Raises
    ------
    InputError
        `clock_drift` is outside ±1 %, or `jitter` is outside 0 to 0.1 s.
    """

    receive_own_messages = False

    def __init__(
        self,
        *devices: Device,
        bitrate: float | None = 500_000.0,
        faults: tuple[BusFault, ...] = (),
        clock_drift: float = 0.0,
        jitter: float = 0.0,
        seed: int = 0,
        data_bitrate: float | None = None,
    ) -> None:
        if not -0.01 <= clock_drift <= 0.01:
            raise InputError("-0.01 to 0.01 is expected", argument="clock_drift", value=clock_drift)
        if not 0.0 <= jitter <= 0.1:
            raise InputError("0 to 0.1 s is expected", argument="jitter", value=jitter)
        super().__init__(channel="emulated")
        self.channel_info = "emulated bus on virtual time"
        self.bitrate = bitrate
        self._rate = 1.0 + clock_drift
        self._jitter, self._random = jitter, Random(seed)
        self._faults = faults
        self._time = 0.0  # [s], clock of the devices and the joint
        self._agenda = Agenda()
        self._wire = Wire(self._true_time, self._at, bitrate, faults, data_bitrate)
        self._inbox: deque[can.Message] = deque()
        self.sent = 0
        self.host_work = 0.0  # [s] of the host's own computing with each of its frames
        self._devices = devices
        for device in devices:
            device.attach(Port(self._true_time, self._at, self._transmit, device))

    def now(self) -> float:
        """Virtual time [s]."""
        return self._time * self._rate

    def at(self, when: float, event: Event) -> None:
        """Run a callable at the time `when` [s]."""
        self._at(when / self._rate, event)

    def sleep_until(self, deadline: float) -> None:
        """Run due events and advance the clock to the deadline."""
        end = deadline / self._rate
        self._run_until(end + self._lateness() if end > self._time else end)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame of the host.

        Raises
        ------
        can.CanOperationError
            The bus is down or in the state bus-off.
        """
        del timeout  # an emulated wire always takes a frame
        if self.host_work > 0.0:
            self._run_until(self._time + self.host_work)
        self._check_up()
        self.sent += 1
        self._wire.put(msg, self, self._to_devices, from_host=True)

    def transmit(self, message: can.Message) -> None:
        """Send a frame of another node; the host and all devices receive it."""
        self._transmit(message, None)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """Wait in virtual time for the next frame for the host, and return it.

        Raises
        ------
        can.CanOperationError
            The bus is down.
        """
        deadline = self._time + (3600.0 if timeout is None else timeout / self._rate)
        waited = False
        while True:
            self._check_up()
            if self._inbox:
                if waited:
                    self._run_until(self._time + self._lateness())
                return self._inbox.popleft()
            if self._agenda.next > deadline:
                self._run_until(deadline + (self._lateness() if deadline > self._time else 0.0))
                self._check_up()
                return self._inbox.popleft() if self._inbox else None
            self._run_next()
            waited = True

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        return self.recv(timeout), True

    def shutdown(self) -> None:
        """Do nothing: there are no resources to release."""
        super().shutdown()

    def _true_time(self) -> float:
        return self._time

    def _at(self, when: float, event: Event) -> None:
        self._agenda.add(when, event)

    def _lateness(self) -> float:
        return self._random.uniform(0.0, self._jitter) if self._jitter else 0.0

    def _run_until(self, end: float) -> None:
        while self._agenda.next <= end:
            self._run_next()
        self._time = max(self._time, end)

    def _run_next(self) -> None:
        when, event = self._agenda.pop()
        self._time = max(self._time, when)
        event()

    def _transmit(self, message: can.Message, sender: Device | None) -> None:
        def arrive(arrived: can.Message) -> None:
            for device in self._devices:
                if device is not sender:
                    device.receive(arrived)
            self._to_host(arrived)

        self._wire.put(message, sender, arrive, from_host=False)

    def _to_devices(self, message: can.Message) -> None:
        for device in self._devices:
            device.receive(message)

    def _to_host(self, message: can.Message) -> None:
        message.timestamp = self.now()
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
