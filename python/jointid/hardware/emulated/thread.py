"""Emulated devices on a bus of python-can's, in real time, in a thread."""

from __future__ import annotations

import threading
import time
from types import TracebackType
from typing import Self

import can

from jointid.hardware.emulated.device import Agenda, Device, Event, Wire

_LONGEST_WAIT = 0.02  # [s]: so soon the thread sees that it is to end


class EmulatorThread:
    """Runs devices on a bus until it is closed; a context manager.

    The devices get the services of an `EmulatedBus`, on the machine's clock: `now`, `at`, `transmit`.
    All of their code runs in this one thread. Another bus on the same channel is the host's.

    Parameters
    ----------
    bus : can.BusABC
        Any interface, e.g. "virtual" in one process or "udp_multicast" between two; left open.
    devices : Device
    bitrate : float, optional
        [bit/s] of the wire whose times the frames are given in addition to what the bus takes. Default:
        none are.

    Examples
    --------
    >>> import can
    >>> from jointid.hardware.emulated.thread import EmulatorThread
    >>> with can.Bus("bench", interface="virtual") as there, EmulatorThread(there):
    ...     pass  # a session on another can.Bus("bench", interface="virtual")
    """

    def __init__(self, bus: can.BusABC, *devices: Device, bitrate: float | None = None) -> None:
        self._bus, self._devices = bus, devices
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
        """Time since the start [s]."""
        return time.perf_counter() - self._began

    def at(self, when: float, event: Event) -> None:
        """Run something when the clock gets there, or as soon as possible."""
        self._agenda.add(when, event)

    def transmit(self, message: can.Message) -> None:
        """Put a device's frame on the wire."""
        for copy, when in self._wire.arrivals(message, self.now(), from_host=False):
            self._when(when, lambda sent=copy: self._bus.send(sent, timeout=0.1))  # type: ignore[misc]

    # The thread.

    def _run(self) -> None:
        try:
            for device in self._devices:
                device.attach(self)
            while not self._ending.is_set():
                self._run_due()
                wait = max(0.0, min(self._agenda.next - self.now(), _LONGEST_WAIT))
                message = self._bus.recv(wait)
                if message is not None and not message.is_error_frame:
                    self._take(message)
        except BaseException as error:
            self._failure = error

    def _run_due(self) -> None:
        while self._agenda.next <= self.now() and not self._ending.is_set():
            self._agenda.pop()[1]()

    def _take(self, message: can.Message) -> None:
        for copy, when in self._wire.arrivals(message, self.now(), from_host=True):
            self._when(when, lambda arrived=copy: self._arrive(arrived))  # type: ignore[misc]

    def _arrive(self, message: can.Message) -> None:
        for device in self._devices:
            device.receive(message)

    def _when(self, when: float, event: Event) -> None:
        if when <= self.now():
            event()
        else:
            self.at(when, event)
