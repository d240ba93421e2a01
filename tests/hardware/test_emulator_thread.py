"""Emulated devices in a thread on a bus of python-can's: a whole session, and an orderly end."""

import contextlib
import random
import threading
import uuid
from collections.abc import Iterator
from typing import Any

import can
import numpy as np
import pytest
from session_bench import devices, law, limits, session

import jointid as jid
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.emulated.device import DeviceBus
from jointid.hardware.emulated.thread import EmulatorThread
from jointid.hardware.session.session import SessionRefusedError

SLOW = 10e-3  # [s]: this machine may stand still for tens of milliseconds
PATIENT: dict[str, Any] = {
    "period": SLOW,
    "answer_timeout": 5.0,
    "drive": ElmoOptions(heartbeat=10.0),
    "limits": limits(
        missed_deadlines=10**6,
        saturated_samples=10**6,
        late_samples=10**6,
        late_share=1.0,
        watchdog_travel=1e6,  # of a heartbeat that a busy machine keeps
    ),
    "law": law().replace(bandwidth=15.0, robust_term=False),
}


@pytest.fixture
def buses() -> Iterator[tuple[can.BusABC, can.BusABC]]:
    """The host's end of a channel, and the devices'."""
    channel = uuid.uuid4().hex
    with (
        can.Bus(channel, interface="virtual") as host,
        can.Bus(channel, interface="virtual") as there,
    ):
        yield host, there


def emulators() -> list[threading.Thread]:
    return [each for each in threading.enumerate() if each.name == "emulator"]


@pytest.mark.parametrize("bitrate", [None, 500e3])
def test_a_whole_session_over_a_virtual_bus(
    buses: tuple[can.BusABC, can.BusABC], bitrate: float | None
) -> None:
    host, there = buses
    drive, converter = devices(period=SLOW)
    with EmulatorThread(there, drive, converter, bitrate=bitrate) as emulator:
        recording = session(host, 1.0, **PATIENT).run()
        assert emulator.running
    assert not emulators()
    assert not drive.motor_on
    assert isinstance(recording, jid.Recording)
    # A cycle that is over is skipped; how many are is the machine's affair.
    assert 20 <= recording.time.size <= 100
    assert recording.time[-1] <= 1.0
    assert recording.reference is not None
    # Sampled when asked for, never before, and in order; how late is the machine's affair.
    assert (np.diff(recording.time) > 0.0).all()  # when they were taken, not when they were due
    assert (np.diff(recording.time) > 0.0).all()
    assert np.ptp(recording.position) > np.radians(15.0)
    assert np.median(np.abs(recording.position - recording.reference)) < np.radians(3.0)
    assert recording.metadata["timing"]["cycles"] >= recording.time.size


def test_a_session_over_a_bus_that_gives_a_sender_its_own_frames_back() -> None:
    port = random.SystemRandom().randrange(20_000, 60_000)
    with contextlib.ExitStack() as opened:
        try:
            host, there = (
                opened.enter_context(can.Bus("239.74.163.2", interface="udp_multicast", port=port))
                for _ in range(2)
            )
            host.send(frame())
        except (can.CanError, OSError, ImportError) as error:
            pytest.skip(f"no multicast here: {error}")
        if host.recv(1.0) is None or there.recv(1.0) is None:
            pytest.skip("multicast goes nowhere here")
        drive, converter = devices(period=SLOW)
        with EmulatorThread(there, drive, converter):
            recording = session(host, 1.0, **PATIENT).run()
    assert recording is not None
    # A cycle that is over is skipped; how many are is the machine's affair.
    assert 20 <= recording.time.size <= 100
    assert recording.time[-1] <= 1.0
    assert recording.reference is not None
    assert np.median(np.abs(recording.position - recording.reference)) < np.radians(3.0)
    assert not drive.motor_on


class Broken:
    """A device that fails at the first frame."""

    def attach(self, bus: DeviceBus) -> None:
        self.bus = bus

    def receive(self, message: can.Message) -> None:
        del message
        raise ZeroDivisionError("the device has failed")


class Timed:
    """A device that answers nothing and notes when it is called."""

    def __init__(self) -> None:
        self.called: list[tuple[str, float, int]] = []
        self.done = threading.Event()

    def attach(self, bus: DeviceBus) -> None:
        for name, when in (("late", 0.02), ("early", 0.01), ("at once", -1.0)):
            bus.at(when, lambda name=name: self._note(name, bus))  # type: ignore[misc]

    def receive(self, message: can.Message) -> None:
        del message

    def _note(self, name: str, bus: DeviceBus) -> None:
        self.called.append((name, bus.now(), threading.get_ident()))
        if name == "late":
            self.done.set()


def test_events_run_in_order_not_before_their_time_and_in_the_thread(
    buses: tuple[can.BusABC, can.BusABC],
) -> None:
    device = Timed()
    with EmulatorThread(buses[1], device):
        assert device.done.wait(30.0)
    assert [name for name, _, _ in device.called] == ["at once", "early", "late"]
    assert device.called[1][1] >= 0.01
    assert device.called[2][1] >= 0.02
    assert {where for _, _, where in device.called}.isdisjoint({threading.get_ident()})


def frame() -> can.Message:
    return can.Message(arbitration_id=0x80, is_extended_id=False)


def test_an_exception_in_the_thread_is_not_lost(buses: tuple[can.BusABC, can.BusABC]) -> None:
    host, there = buses
    emulator = EmulatorThread(there, Broken())
    emulator.start()
    host.send(frame())
    while emulator.running:
        threading.Event().wait(0.001)
    assert isinstance(emulator.failure, ZeroDivisionError)
    with pytest.raises(ZeroDivisionError, match="the device has failed"):
        emulator.close()
    emulator.close()  # reported once


def test_what_the_host_saw_names_the_emulators_failure(
    buses: tuple[can.BusABC, can.BusABC],
) -> None:
    host, there = buses
    with (
        pytest.raises(SessionRefusedError, match="no boot-up message") as refused,
        EmulatorThread(there, Broken()),
    ):
        session(host, **PATIENT).run()
    notes = refused.value.__notes__
    assert notes == ["the emulator had failed: ZeroDivisionError: the device has failed"]
    assert not emulators()


def test_it_can_be_closed_before_it_was_started(buses: tuple[can.BusABC, can.BusABC]) -> None:
    EmulatorThread(buses[1]).close()
