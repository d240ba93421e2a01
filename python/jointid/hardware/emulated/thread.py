"""Emulated devices on a bus of python-can's, in real time, in a thread."""

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

_LONGEST_WAIT = 0.02  # [s]: so soon the thread sees that it is to end
_OLDEST = 60.0  # [s]: a frame that is stamped earlier bears the time of another clock, or of one that was set
_MOST_WAITING = 10_000  # frames that are read at once
_SENDING = 0.01  # [s] that a full queue may take: the devices' own guards wait meanwhile


class EmulatorThread:
    """Runs devices on a bus until it is closed; a context manager.

    The devices get the services of an `EmulatedBus`, on the machine's clock: `now`, `at`, `transmit`.
    All of their code runs in this one thread. Another bus on the same channel is the host's. What is due
    runs at its own time on the devices' clock, and frames arrive at the time of their stamps, so a
    machine that stands still for a moment changes neither joint nor watchdog. A bus that is down is no
    end: frames are lost, and the devices go on by themselves.

    Parameters
    ----------
    bus : can.BusABC
        Any interface, e.g. "virtual" in one process or "udp_multicast" between two; left open.
    devices : Device
    bitrate : float, optional
        [bit/s] of the wire whose times the frames are given in addition to what the bus takes. None: a
        bus of its own that takes its time. Default 500 000.
    faults : sequence of BusFault
        What goes wrong on the wire, and when since the start. "down" and "bus_off" lose all frames.
    watch : callable, optional
        Called with the time [s] after each event and frame, for what wants to see the devices change.
    rest : float
        Shortest time between two looks at what is due [s], unless a frame comes. It is done at its time by the
        devices' clock all the same: a machine that wakes slowly has less to do, and frames are so much
        later. Default 0.
    data_bitrate : float, optional
        Of the data of CAN FD frames [bit/s]. Default: the same as `bitrate`.

    Attributes
    ----------
    lost : int
        Frames that the bus did not take.
    trouble : Exception or None
        What the bus said last about it.

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
        self._moment: float | None = None  # [s], of the event that runs
        self._latest = 0.0  # [s], of the events that have run
        # An interface that gives a sender its own frames back, without saying so.
        self._echoing = "udp_multicast" in type(bus).__module__.split(".")
        self._echoes: Counter[tuple[int, bytes]] = Counter()
        self.lost = 0
        self.trouble: Exception | None = None
        self._thread = threading.Thread(target=self._run, name="emulator", daemon=True)

    def start(self) -> None:
        """Power the devices up."""
        self._began = time.perf_counter()
        self._thread.start()

    def close(self) -> None:
        """End the thread; it has ended when this returns.

        Raises
        ------
        Exception
            Whatever a device raised; the thread ended then and there.
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
            # What the host saw follows from this: both are reported.
            error.add_note(f"the emulator had failed: {type(failure).__name__}: {failure}")

    @property
    def failure(self) -> BaseException | None:
        """What ended the thread early."""
        return self._failure

    @property
    def running(self) -> bool:
        """Whether the devices run."""
        return self._thread.is_alive()

    # For the devices.

    def now(self) -> float:
        """Time since the start [s]; while something runs that was due, the time at which it was."""
        return self._moment if self._moment is not None else self._clock()

    def at(self, when: float, event: Event) -> None:
        """Run something when the clock gets there, or as soon as possible."""
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
        """Read what has come: all of it, since it has its place before what is due now."""
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
        """When a frame came [s], by its stamp where that is of the machine's clock."""
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
