"""Run emulated devices in real time, in a thread, on a python-can bus."""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Self

import can

from jointid.hardware.emulated.device import Agenda, Device, Event, Port
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.emulated.wire import Wire

_LONGEST_WAIT = 0.02  # [s], longest delay until the thread sees that it must end
_OLDEST = 60.0  # [s]: an older stamp comes from another clock, or the clock was set
_MOST_WAITING = 10_000  # frames that are read at once
_SENDING = 0.01  # [s] that a full queue may block; the devices' own guards wait meanwhile


class EmulatorThread:
    """Context manager that runs emulated devices on a bus until it is closed.

    The devices use `now`, `at` and `transmit` as on an `EmulatedBus`, with the machine's clock. The code of the
    devices runs only in this thread. The host uses another bus on the same channel. Events run at their due time on
    the devices' clock. Frames arrive at the time of their stamps. Therefore, a short pause of the machine does not
    affect the joint or the watchdog. While the bus is down, frames are lost and the devices continue.

    Parameters
    ----------
    bus : can.BusABC
        Bus with any interface, e.g. "virtual" in one process or "udp_multicast" between two processes. It stays open
        at the end.
    devices : Device
    bitrate : float, optional
        Bit rate of the emulated wire [bit/s]. The wire delays frames in addition to the bus. Use None if the bus
        already has this delay. Default 500 000.
    faults : sequence of BusFault
        Faults of the emulated wire, with times since the start. With "down" and "bus_off", all frames are lost.
    watch : callable, optional
        Function to observe the devices. It is called with the time [s] after each event and frame.
    rest : float
        Shortest time between two checks for due events [s], if no frame arrives. Events keep their due time on the
        devices' clock. A larger value saves processor time, but delays frames. Default 0.
    data_bitrate : float, optional
        Bit rate of the data in CAN FD frames [bit/s]. Default: the same as `bitrate`.

    Attributes
    ----------
    lost : int
        Number of frames that the bus did not accept.
    trouble : Exception or None
        Last error of the bus; None without an error.

    Examples
    --------
    >>> import can
    >>> from jointid.hardware.emulated.thread import EmulatorThread
    >>> with can.Bus("bench", interface="virtual") as there, EmulatorThread(there):
    ...     pass  # a session on another can.Bus("bench", interface="virtual")
    """

    def __init__(
        self,
        bus: can.BusABC,
        *devices: Device,
        bitrate: float | None = 500_000.0,
        faults: Sequence[BusFault] = (),
        watch: Callable[[float], object] | None = None,
        rest: float = 0.0,
        data_bitrate: float | None = None,
    ) -> None:
        self._bus, self._devices, self._watch, self._rest = bus, devices, watch, rest
        self._wire = Wire(self.now, self.at, bitrate, faults, data_bitrate)
        self._agenda = Agenda()
        self._failure: BaseException | None = None
        self._ending = threading.Event()
        self._began = time.perf_counter()
        self._moment: float | None = None  # [s], due time of the running event
        self._latest = 0.0  # [s], latest time of the executed events
        # An interface that returns a sender's own frames, without marking them.
        self._echoing = "udp_multicast" in type(bus).__module__.split(".")
        self._echoes: Counter[tuple[int, bytes]] = Counter()
        self.lost = 0
        self.trouble: Exception | None = None
        self._thread = threading.Thread(target=self._run, name="emulator", daemon=True)

    def start(self) -> None:
        """Power up the devices."""
        self._began = time.perf_counter()
        self._thread.start()

    def close(self) -> None:
        """Stop the thread, and wait until it has ended.

        Raises
        ------
        Exception
            Error of a device that ended the thread.
        """
        self._ending.set()
        if self._thread.is_alive():
            self._thread.join()
        failure, self._failure = self._failure, None
        if failure is not None:
            raise failure

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            self.close()
        except BaseException as failure:
            if error is None:
                raise
            # This failure explains the host's observation, so both are reported.
            error.add_note(f"the emulator had failed: {type(failure).__name__}: {failure}")

    @property
    def failure(self) -> BaseException | None:
        """Error that ended the thread; None without an error."""
        return self._failure

    @property
    def running(self) -> bool:
        """Whether the devices run."""
        return self._thread.is_alive()

    # For the devices.

    def now(self) -> float:
        """Time since the start [s]; during an event, the due time of this event."""
        return self._moment if self._moment is not None else self._clock()

    def at(self, when: float, event: Event) -> None:
        """Run a callable at the time `when` [s], or as soon as possible afterwards."""
        self._agenda.add(when, event)

    # The thread.

    def _clock(self) -> float:
        return max(self._latest, time.perf_counter() - self._began)

    def _run(self) -> None:
        try:
            for device in self._devices:
                device.attach(Port(self.now, self.at, self._transmit, device))
            while not self._ending.is_set():
                self._read(min(max(self._agenda.next - self._clock(), self._rest), _LONGEST_WAIT))
                self._run_due()
        except BaseException as error:
            self._failure = error

    def _read(self, wait: float) -> None:
        """Read all frames that have arrived, because they precede the events that are due now."""
        for _ in range(_MOST_WAITING):
            try:
                message = self._bus.recv(wait)
            except (can.CanError, OSError) as error:
                self.trouble = error
                self._ending.wait(wait)
                return
            if message is None:
                return
            wait = 0.0
            if not message.is_error_frame and not self._own(message):
                self.at(self._arrival(message), lambda came=message: self._take(came))  # type: ignore[misc]

    def _own(self, message: can.Message) -> bool:
        if not self._echoing:
            return False
        key = message.arbitration_id, bytes(message.data)
        if not self._echoes[key]:
            return False
        self._echoes[key] -= 1
        return True

    def _arrival(self, message: can.Message) -> float:
        """Return the arrival time of a frame [s], from its stamp if the machine's clock gave it."""
        age = time.time() - message.timestamp
        now = self._clock()
        return now - age if 0.0 <= age <= _OLDEST else now

    def _run_due(self) -> None:
        while self._agenda.next <= self._clock() and not self._ending.is_set():
            when, event = self._agenda.pop()
            self._latest = self._moment = max(self._latest, when)
            try:
                event()
                if self._watch is not None:
                    self._watch(self._moment)
            finally:
                self._moment = None

    def _take(self, message: can.Message) -> None:
        self._wire.put(message, self, self._arrive, from_host=True)

    def _arrive(self, message: can.Message) -> None:
        for device in self._devices:
            device.receive(message)

    def _transmit(self, message: can.Message, sender: Device) -> None:
        def arrive(arrived: can.Message) -> None:
            for device in self._devices:
                if device is not sender:
                    device.receive(arrived)
            self._send(arrived)

        self._wire.put(message, sender, arrive, from_host=False)

    def _send(self, message: can.Message) -> None:
        try:
            self._bus.send(message, timeout=_SENDING)
        except (can.CanError, OSError) as error:
            self.lost += 1
            self.trouble = error
            return
        if self._echoing:
            self._echoes[message.arbitration_id, bytes(message.data)] += 1
