"""Emulated devices on a bus of python-can's, in real time, in a thread."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import Self

import can

from jointid.hardware.emulated.device import Agenda, Device, Event, Wire

_LONGEST_WAIT = 0.02  # [s]: so soon the thread sees that it is to end
_MOST_WAITING = 1000  # frames that are read before anything else happens
_LONGEST_STAND = 60.0  # [s] that this program may have stood still; more is a wall clock that was set


class EmulatorThread:
    """Runs devices on a bus until it is closed; a context manager.

    The devices get the services of an `EmulatedBus`, on the machine's clock: `now`, `at`, `transmit`.
    All of their code runs in this one thread. Another bus on the same channel is the host's.

    What the devices do happens when it is due by their clock, also when this thread gets to it late: in
    the order of the times at which events are due and frames arrived. So a watchdog acts at its time, not
    at that of a busy machine. Only SocketCAN tells when a frame arrived; elsewhere it is when it was read.

    Parameters
    ----------
    bus : can.BusABC
        Any interface, e.g. "virtual" in one process or "udp_multicast" between two; left open.
    devices : Device
    bitrate : float, optional
        [bit/s] of the wire whose times the frames are given in addition to what the bus takes. Default:
        none are.
    watch : callable, optional
        Called with the time [s] after each event and frame, for what wants to see the devices change.
    rest : float
        Shortest time between two looks at what the devices do by themselves [s]; frames end it. It happens at its
        time all the same, only a machine that wakes slowly has less to do. Default 0.

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
        bitrate: float | None = None,
        watch: Callable[[float], object] | None = None,
        rest: float = 0.0,
    ) -> None:
        self._bus, self._devices, self._watch, self._rest = bus, devices, watch, rest
        self._stamped = "socketcan" in type(bus).__module__.split(".")
        self._moment: float | None = None  # of the event that is running [s]
        self._latest = 0.0  # event that has run [s]
        self._wire = Wire(bitrate)
        self._agenda = Agenda()
        self._failure: BaseException | None = None
        self._ending = threading.Event()
        self._began = time.perf_counter()
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
        """Time since the start [s]; while an event runs, the time at which it is due."""
        moment = self._moment
        return self._clock() if moment is None else moment

    def at(self, when: float, event: Event) -> None:
        """Run something when the clock gets there, or as soon as possible."""
        self._agenda.add(max(when, self._latest), event)

    def transmit(self, message: can.Message) -> None:
        """Put a device's frame on the wire."""
        for copy, when in self._wire.arrivals(message, self.now(), from_host=False):
            self._when(when, lambda sent=copy: self._bus.send(sent, timeout=0.1))  # type: ignore[misc]

    # The thread.

    def _clock(self) -> float:
        return time.perf_counter() - self._began

    def _run(self) -> None:
        try:
            for device in self._devices:
                device.attach(self)
            while not self._ending.is_set():
                wait = min(max(self._agenda.next - self._clock(), self._rest), _LONGEST_WAIT)
                self._read(wait)
                self._run_due(self._clock())
        except BaseException as error:
            self._failure = error

    def _read(self, wait: float) -> None:
        """Read what has arrived: it may have done so before the next event was due."""
        message = self._bus.recv(wait)
        for _ in range(_MOST_WAITING):
            if message is None:
                break
            if not message.is_error_frame:
                self._take(message)
            message = self._bus.recv(0.0)

    def _run_due(self, until: float) -> None:
        while self._agenda.next <= until and not self._ending.is_set():
            when, event = self._agenda.pop()
            self._moment = self._latest = when
            try:
                event()
                if self._watch is not None:
                    self._watch(when)
            finally:
                self._moment = None

    def _take(self, message: can.Message) -> None:
        for copy, when in self._wire.arrivals(message, self._arrival(message), from_host=True):
            self.at(when, lambda arrived=copy: self._arrive(arrived))  # type: ignore[misc]

    def _arrival(self, message: can.Message) -> float:
        """When a frame came [s]: by the kernel's stamp, of its wall clock, where there is one."""
        now = self._clock()
        if self._stamped:
            now -= min(_LONGEST_STAND, max(0.0, time.time() - message.timestamp))
        return max(now, self._latest)

    def _arrive(self, message: can.Message) -> None:
        for device in self._devices:
            device.receive(message)

    def _when(self, when: float, event: Event) -> None:
        if when <= self.now():
            event()
        else:
            self.at(when, event)
