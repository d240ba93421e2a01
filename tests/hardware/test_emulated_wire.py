"""The emulated wire: priority, device to device, a share of faults, drift, jitter, a bus that is down."""

import threading
import time
import uuid
from collections.abc import Callable
from pathlib import Path

import can
import numpy as np
import pytest
from session_bench import devices, joint, session

import jointid as jid
from jointid.base.errors import InputError
from jointid.hardware.can.wire_time import bits_on_wire, fd_bits_on_wire
from jointid.hardware.elmo.emulated_converter import EmulatedConverter
from jointid.hardware.elmo.emulated_drive import ElmoSettings, EmulatedElmo
from jointid.hardware.emulated import wire as wire_module
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.device import DeviceBus
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.emulated.thread import EmulatorThread
from jointid.hardware.emulated.wire import bitrate_to_emulate

BITRATE = 500e3


def frame(identifier: int, content: bytes = b"") -> can.Message:
    return can.Message(arbitration_id=identifier, data=content, is_extended_id=False)


class Talker:
    """A device that answers a SYNC, and keeps what it hears."""

    def __init__(self, *identifiers: int) -> None:
        self._identifiers = identifiers
        self.heard: list[tuple[int, float]] = []

    def attach(self, bus: DeviceBus) -> None:
        self.bus = bus

    def receive(self, message: can.Message) -> None:
        self.heard.append((message.arbitration_id, self.bus.now()))
        if message.arbitration_id == 0x80:
            for identifier in self._identifiers:
                self.bus.transmit(frame(identifier))


def received(bus: EmulatedBus, timeout: float = 0.1) -> list[tuple[int, float]]:
    found = []
    while (message := bus.recv(timeout)) is not None:
        found.append((message.arbitration_id, message.timestamp))
    return found


@pytest.mark.parametrize(("length", "bits"), [(0, 55), (1, 65), (8, 135)])
def test_bits_with_the_most_stuffing(length: int, bits: int) -> None:
    """44 plain bits and the gap of 3, and a stuffed bit behind each four of the first 34 + 8 n, less one."""
    assert bits_on_wire(length) == bits


def test_the_lowest_identifier_goes_first_and_a_sender_keeps_its_order() -> None:
    talkers = Talker(0x700, 0x100), Talker(0x300), Talker(0x200)
    with EmulatedBus(*talkers, bitrate=BITRATE) as bus:
        bus.send(frame(0x80))
        bus.send(frame(0x400))
        found = received(bus)
    # 0x700 keeps the queue of its sender from 0x100, as a controller's queue does.
    assert [identifier for identifier, _ in found] == [0x200, 0x300, 0x700, 0x100]
    assert talkers[2].heard[-1][0] == 0x100
    bit = bits_on_wire(0) / BITRATE
    assert [when for _, when in found] == pytest.approx([2 * bit, 3 * bit, 5 * bit, 6 * bit])
    assert [it for it, _ in talkers[1].heard] == [0x80, 0x200, 0x400, 0x700, 0x100]


def test_a_frame_of_can_fd_takes_both_bit_rates_and_a_longer_identifier_its_bits() -> None:
    """Of 8 and 64 bytes: 17 bits up to the switch, 13 behind the data, and all stuff bits."""
    assert fd_bits_on_wire(8) == (17 + 4 + 13, 5 + 64 + 17 + 4 + 23)
    assert fd_bits_on_wire(64) == fd_bits_on_wire(49) == (17 + 4 + 13, 5 + 512 + 129 + 4 + 28)
    assert fd_bits_on_wire(8, extended=True)[0] == 36 + 8 + 13
    assert bits_on_wire(8, extended=True) == 160  # 54 + 64, 29 stuff bits, 13

    def took(**kind: bool) -> float:
        sent = can.Message(arbitration_id=0x8001, data=bytes(8), **kind)
        with EmulatedBus(bitrate=1e6, data_bitrate=5e6) as bus:
            bus.transmit(sent)
            found = bus.recv(0.1)
        assert found is not None
        assert found.equals(sent, timestamp_delta=None)
        return found.timestamp

    slow, fast = fd_bits_on_wire(8, extended=True)
    assert took() == pytest.approx(160e-6)
    assert took(is_fd=True, bitrate_switch=True) == pytest.approx(1e-6 * slow + 0.2e-6 * fast)
    assert took(is_fd=True) == pytest.approx(1e-6 * (slow + fast))
    assert took(is_remote_frame=True) == pytest.approx(1e-6 * bits_on_wire(0, extended=True))


def test_what_another_node_sends_reaches_host_and_drive() -> None:
    drive, _ = devices()
    with EmulatedBus(drive) as bus:
        bus.transmit(frame(0x000, b"\x01\x7f"))
        found = received(bus, 0.01)
    assert drive.state == "operational"
    assert [identifier for identifier, _ in found] == [0x000, 0x77F]


def test_a_fault_hits_its_share_of_the_frames_the_same_each_time() -> None:
    def lost(seed: int) -> list[int]:
        fault = BusFault(kind="drop", start=0.0, identifier=0x200, probability=0.3, seed=seed)
        with EmulatedBus(Talker(0x200, 0x300), bitrate=None, faults=(fault,)) as bus:
            for _ in range(1000):
                bus.send(frame(0x80))
            return [identifier for identifier, _ in received(bus)]

    found = lost(1)
    assert found.count(0x300) == 1000
    assert found.count(0x200) == pytest.approx(700, abs=45)
    assert lost(1) == found
    assert lost(2) != found
    with pytest.raises(InputError, match="probability"):
        BusFault(kind="drop", start=0.0, probability=1.5)


def test_the_hosts_clock_drifts_against_the_devices() -> None:
    talker = Talker()
    with EmulatedBus(talker, bitrate=None, clock_drift=1e-3) as bus:
        bus.sleep_until(10.01)
        bus.send(frame(0x80))
        bus.sleep_until(20.0)
        assert bus.now() == pytest.approx(20.0, abs=1e-12)
    assert talker.heard[0][1] == pytest.approx(10.01 / 1.001, abs=1e-9)


def test_jitter_lets_the_host_wake_late_and_repeats() -> None:
    def lateness(seed: int) -> list[float]:
        with EmulatedBus(jitter=0.3e-3, seed=seed) as bus:
            found = []
            for cycle in range(1, 200):
                bus.sleep_until(2e-3 * cycle)
                found.append(bus.now() - 2e-3 * cycle)
            return found

    late = lateness(0)
    assert 0.0 <= min(late) < 0.03e-3
    assert 0.27e-3 < max(late) <= 0.3e-3
    assert lateness(0) == late != lateness(1)


@pytest.mark.parametrize(
    ("option", "value"), [("clock_drift", 0.1), ("jitter", -1e-3), ("jitter", 1.0)]
)
def test_what_no_clock_does_is_refused(option: str, value: float) -> None:
    with pytest.raises(InputError, match=option):
        EmulatedBus(**{option: value})  # type: ignore[arg-type]


def test_a_session_bears_drift_and_jitter() -> None:
    drive = EmulatedElmo(joint(), ElmoSettings(idle_jitter=0.1e-3))
    with EmulatedBus(drive, EmulatedConverter(drive), clock_drift=1e-4, jitter=0.2e-3) as bus:
        recording = session(bus, 1.0).run()
    assert isinstance(recording, jid.Recording)
    assert recording.reference is not None
    assert np.abs(recording.position - recording.reference).max() < np.radians(1.0)


class Down(can.BusABC):
    """An interface that can go down, and back up again."""

    def __init__(self, channel: str) -> None:
        self._bus = can.Bus(channel, interface="virtual")
        self.down = threading.Event()
        super().__init__(channel=channel)

    def _check(self) -> None:
        if self.down.is_set():
            raise can.CanOperationError("Network is down", 100)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        self._check()
        self._bus.send(msg, timeout)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        self._check()
        return self._bus.recv(timeout)

    def shutdown(self) -> None:
        self._bus.shutdown()
        super().shutdown()


def until(condition: Callable[[], bool]) -> None:
    """Wait for a condition of another thread's."""
    end = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < end, "it never came"
        time.sleep(0.001)


def test_an_interface_that_goes_down_ends_nothing_and_the_watchdog_acts() -> None:
    channel = uuid.uuid4().hex
    settings = ElmoSettings(abort_option=2, error_behaviour=1)
    drive = EmulatedElmo(joint(), settings)
    with (
        Down(channel) as there,
        can.Bus(channel, interface="virtual") as host,
        EmulatorThread(there, drive) as emulator,
    ):
        begin = (0x000, b"\x01\x7f"), (0x67F, bytes.fromhex("23 16 10 01 32 00 01 00"))
        torque = (0x37F, b"MO\0\0\1\0\0\0"), (0x37F, b"TC\0\x80\0\0\x80\x3f")
        for content in (*begin, (0x37F, b"UM\0\0\1\0\0\0"), *torque):
            host.send(frame(*content))
        until(lambda: drive.current == 1.0)
        host.send(frame(0x701, b"\x05"))
        there.down.set()
        until(lambda: not drive.motor_on or emulator.failure is not None)
        assert emulator.failure is None
        assert (drive.failure, drive.current) == (0x800, 0.0)
        until(lambda: emulator.trouble is not None)
        there.down.clear()
        host.send(frame(0x000, b"\x82\x7f"))
        until(lambda: drive.state == "pre-operational")
        assert emulator.running


def test_a_machine_that_stands_still_does_not_change_when_the_watchdog_acts() -> None:
    channel = uuid.uuid4().hex
    drive = EmulatedElmo(joint(), ElmoSettings(abort_option=2, error_behaviour=1))
    stalled = threading.Event()

    class Staller:
        def attach(self, bus: DeviceBus) -> None:
            pass

        def receive(self, message: can.Message) -> None:
            if message.arbitration_id == 0x123:
                time.sleep(0.5)  # the whole emulator stands still
                stalled.set()

    with (
        can.Bus(channel, interface="virtual") as there,
        can.Bus(channel, interface="virtual") as host,
        EmulatorThread(there, drive, Staller()),
    ):
        for content in (
            *((0x000, b"\x01\x7f"), (0x67F, bytes.fromhex("23 16 10 01 C8 00 01 00"))),
            *((0x37F, b"UM\0\0\1\0\0\0"), (0x37F, b"MO\0\0\1\0\0\0"), (0x701, b"\x05")),
        ):
            host.send(frame(*content))
        until(lambda: drive.motor_on)
        host.send(frame(0x123))
        assert stalled.wait(30.0)
        until(lambda: not drive.motor_on)
    (on, _), (off, _) = drive.switchings
    # 200 ms behind the heartbeat, on the drive's clock; it came together with MO=1.
    assert 0.15 < off - on < 0.4


def test_the_bit_rate_is_emulated_where_no_controller_takes_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(wire_module, "_NETWORKS", tmp_path)
    (tmp_path / "can0" / "device").mkdir(parents=True)
    (tmp_path / "vcan0").mkdir()
    assert bitrate_to_emulate("socketcan", "vcan0", BITRATE) == BITRATE
    assert bitrate_to_emulate("virtual", "bench", BITRATE) == BITRATE
    assert bitrate_to_emulate("udp_multicast", "239.74.163.2", BITRATE) == BITRATE
    assert bitrate_to_emulate("socketcan", "can0", BITRATE) is None
    assert bitrate_to_emulate("pcan", "PCAN_USBBUS1", BITRATE) is None
