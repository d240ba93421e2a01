"""What the emulated drive does when its host is lost, on virtual time: only what it was told to do."""

import struct
from typing import Any

import can
import pytest
from session_bench import joint

from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.codec import Command, DriveError, Reply
from jointid.hardware.elmo.emulated_drive import ElmoSettings, EmulatedElmo
from jointid.hardware.emulated.bus import EmulatedBus

NODE, MASTER, HEARTBEAT = 127, 1, 50  # [ms]
EMERGENCY = canopen.emergency_id(NODE)
PRE_OPERATIONAL, OPERATIONAL, STOPPED = 0x7F, 0x05, 0x04


class Bench:
    """An emulated drive, and a host that talks to it frame by frame."""

    def __init__(self, **settings: Any) -> None:
        self.drive = EmulatedElmo(joint(), ElmoSettings(**settings))
        self.bus = EmulatedBus(self.drive)
        self.frames: list[tuple[int, bytes]] = []
        self.network(canopen.START)

    def send(self, identifier: int, content: bytes = b"") -> None:
        """Send a frame, and let it arrive and be answered."""
        message = can.Message(arbitration_id=identifier, data=content, is_extended_id=False)
        self.bus.send(message)
        self.listen(2e-3)

    def network(self, command: int) -> None:
        self.send(canopen.NMT, canopen.network(command, NODE))

    def listen(self, duration: float) -> None:
        """Keep what comes."""
        end = self.bus.now() + duration
        while (message := self.bus.recv(max(0.0, end - self.bus.now()))) is not None:
            self.frames.append((message.arbitration_id, bytes(message.data)))

    def write(self, index: int, subindex: int, value: int, size: int) -> None:
        request = canopen.SdoRequest(index=index, subindex=subindex, value=value, size=size)
        self.send(0x600 + NODE, request.payload())
        canopen.sdo_result(self.frames[-1][1], request)

    def read(self, index: int, subindex: int = 0) -> int:
        request = canopen.SdoRequest(index=index, subindex=subindex)
        self.send(0x600 + NODE, request.payload())
        found = canopen.sdo_result(self.frames[-1][1], request)
        assert found is not None
        return found

    def ask(self, letters: str, index: int = 0, value: float | None = None) -> float:
        """Send a command of the interpreter's; its reply's value."""
        self.send(0x300 + NODE, Command(letters=letters, index=index, value=value).payload())
        return Reply.of(self.frames[-1][1]).value

    def refused(self, letters: str, index: int = 0, value: float | None = None) -> int:
        """EC of a command that is refused."""
        with pytest.raises(DriveError) as error:
            self.ask(letters, index, value)
        return error.value.code

    def run(self) -> None:
        """Switch the motor on at 1 A."""
        self.ask("UM", value=1)
        self.ask("MO", value=1)
        self.ask("TC", value=1.0)

    def beat(self) -> None:
        self.send(canopen.heartbeat_id(MASTER), b"\x05")

    def emergencies(self) -> list[int]:
        return [
            struct.unpack_from("<H", content)[0] for it, content in self.frames if it == EMERGENCY
        ]


def watched(option: int = 2, behaviour: int = 1, events: int = 0x188) -> Bench:
    """A drive that waits for a heartbeat, its motor on, and has seen one."""
    bench = Bench()
    bench.write(0x1016, 1, MASTER << 16 | HEARTBEAT, 4)
    bench.write(0x6007, 0, option, 2)
    bench.write(0x1029, 1, behaviour, 1)
    bench.write(0x2F21, 0, events, 2)
    bench.run()
    bench.beat()
    return bench


@pytest.mark.parametrize(("option", "on"), [(0, True), (1, False), (2, False), (3, False)])
def test_6007h_says_what_a_lost_heartbeat_does_to_the_motor(option: int, on: bool) -> None:
    bench = watched(option=option)
    seen = bench.bus.now()
    bench.listen(0.2)
    assert bench.drive.motor_on is on
    assert bench.drive.failure == (0 if on else 0x800)
    assert bench.drive.current == (1.0 if on else 0.0)
    assert bench.emergencies() == [0x8130]
    if not on:
        when = bench.drive.switchings[-1][0]
        assert 0.0 < when - seen + 2e-3 <= 1e-3 * HEARTBEAT + 1e-3


@pytest.mark.parametrize(
    ("behaviour", "state"), [(0, "pre-operational"), (1, "operational"), (2, "stopped")]
)
def test_1029h_says_what_becomes_of_the_network_state(behaviour: int, state: str) -> None:
    bench = watched(behaviour=behaviour)
    bench.listen(0.2)
    assert bench.drive.state == state


@pytest.mark.parametrize(("events", "sent"), [(0, []), (0x180, []), (0x8, [0x8130])])
def test_2f21h_says_which_emergencies_are_sent(events: int, sent: list[int]) -> None:
    bench = watched(events=events)
    bench.listen(0.2)
    assert bench.emergencies() == sent
    assert not bench.drive.motor_on


def test_a_drive_that_nobody_armed_lets_its_motor_run() -> None:
    bench = Bench()
    bench.write(0x1016, 1, MASTER << 16 | HEARTBEAT, 4)
    bench.run()
    bench.beat()
    bench.listen(1.0)
    assert bench.drive.motor_on
    assert bench.emergencies() == []
    assert bench.drive.state == "pre-operational"


def test_a_heartbeat_is_awaited_from_the_first_on() -> None:
    bench = Bench(abort_option=2)
    bench.write(0x1016, 1, MASTER << 16 | HEARTBEAT, 4)
    bench.run()
    bench.listen(1.0)
    assert bench.drive.motor_on


def test_another_nodes_heartbeat_does_not_count() -> None:
    bench = watched()
    for _ in range(10):
        bench.send(canopen.heartbeat_id(MASTER + 1), b"\x05")
        bench.listen(0.02)
    assert not bench.drive.motor_on


@pytest.mark.parametrize(("option", "on"), [(0, True), (2, False)])
@pytest.mark.parametrize("command", [canopen.STOP, canopen.RESET_COMMUNICATION])
def test_a_stopped_node_is_a_lost_host(option: int, on: bool, command: int) -> None:
    bench = watched(option=option)
    bench.network(command)
    assert bench.drive.motor_on is on
    assert bench.drive.failure == 0
    if command == canopen.RESET_COMMUNICATION:
        assert bench.read(0x6007) == 0


def test_a_reset_of_the_node_switches_the_motor_off_in_any_case() -> None:
    bench = watched(option=0)
    bench.network(canopen.RESET_NODE)
    assert not bench.drive.motor_on


def test_recovery_is_told_with_emergency_zero() -> None:
    bench = watched()
    bench.drive.fail("over-temperature")
    bench.listen(0.01)
    assert bench.emergencies() == [0x4310]
    assert bench.read(0x1001) == 0x09
    assert bench.read(0x1003, 1) == 0x4310
    assert bench.refused("MO", value=1) == 66
    bench.drive.problem = 0  # it has cooled down
    bench.ask("MO", value=1)
    assert bench.emergencies() == [0x4310, 0x0000]
    assert bench.read(0x1001) == 0
    assert bench.read(0x1003) == 1


def test_a_heartbeat_that_comes_back_is_no_recovery_of_the_motor() -> None:
    bench = watched()
    bench.listen(0.1)
    bench.beat()
    assert bench.emergencies() == [0x8130]
    bench.ask("MO", value=1)
    assert bench.emergencies() == [0x8130, 0x0000]
    quiet = watched(option=0)
    quiet.listen(0.1)
    quiet.beat()
    assert quiet.emergencies() == [0x8130, 0x0000]


def test_controlword_and_statusword() -> None:
    bench = Bench()
    assert bench.read(0x6041) & 0x6F == 0x40
    request = canopen.SdoRequest(index=0x6040, subindex=0, value=0x0F, size=2)
    bench.send(0x600 + NODE, request.payload())
    with pytest.raises(canopen.SdoAbortError):  # not from "switch on disabled"
        canopen.sdo_result(bench.frames[-1][1], request)
    for word, state in ((0x06, 0x21), (0x07, 0x23), (0x0F, 0x27), (0x07, 0x23), (0x0F, 0x27)):
        bench.write(0x6040, 0, word, 2)
        assert bench.read(0x6041) & 0x6F == state
        assert bench.drive.motor_on is (state == 0x27)
    bench.write(0x6040, 0, 0x00, 2)
    assert not bench.drive.motor_on
    bench.drive.fail("motor stuck")
    assert bench.read(0x6041) & 0x4F == 0x08
    bench.write(0x6040, 0, 0x80, 2)
    assert bench.read(0x6041) & 0x4F == 0x40
    assert bench.drive.failure == 0


def test_the_commands_that_a_check_of_the_bench_asks_for() -> None:
    bench = Bench(peak_current=6.0, continuous_current=3.0, supply=47.5, temperature=31.0)
    found = {
        letters: bench.ask(letters, index)
        for letters, index in (
            *(("SN", 4), ("PU", 0), ("MC", 0), ("LL", 2), ("HL", 2), ("ER", 3), ("LC", 0)),
            *(("TS", 0), ("TM", 0), ("HP", 0), ("CA", 18), ("XM", 1), ("SO", 0), ("BV", 0)),
            *(("IP", 0), ("IB", 1), ("JV", 0), ("BG", 0), ("TI", 1), ("CL", 3), ("AN", 6)),
        )
    }
    assert found["SN"] == bench.read(0x1018, 4)
    assert (found["HL"], found["LL"]) == (10**9, -(10**9))
    assert (found["MC"], found["CA"], found["AN"], found["TI"]) == (12.0, 8000, 47.5, 31)
    assert bench.refused("VR") == 5  # a text: by 1023h
    assert bench.refused("SN", 5) == 3
    assert bench.refused("SR", value=1) == 23
    assert bench.read(0x6075) == 3000
    assert bench.read(0x6076) == 594


def test_peak_current_set_below_what_flows_cuts_it() -> None:
    bench = Bench()
    bench.run()
    bench.ask("PL", 1, 0.5)
    assert bench.drive.current == 0.5
    assert bench.refused("TC", value=0.6) == 21


def test_speed_bounds_that_are_set_hold() -> None:
    bench = Bench()
    bench.ask("HL", 2, 1000)
    bench.run()
    bench.ask("TC", value=8.0)
    bench.listen(0.5)
    assert bench.drive.failure == 0x20000


def test_no_continuous_current_is_no_crash() -> None:
    bench = Bench(continuous_current=0.0)
    assert bench.ask("CL", 1) == 0.0
    assert bench.read(0x6077) == 0
    assert bench.read(0x6075) == 0


@pytest.mark.parametrize(
    ("modulo", "before", "after"),
    [((0, 0), 2**31 - 1, -(2**31)), ((-1000, 1000), 999, -1000)],
)
def test_counts_wrap(modulo: tuple[int, int], before: int, after: int) -> None:
    bench = Bench(modulo=modulo)
    bench.ask("PX", value=before)
    assert bench.ask("PX") == before
    bench.drive.slipped_counts += 1
    assert bench.ask("PX") == after
    assert bench.read(0x6064) == after & 0xFFFFFFFF


def test_enabling_takes_its_time_and_what_waits_too() -> None:
    bench = Bench(enable_time=0.06)
    bench.ask("UM", value=1)
    asked = bench.bus.now()
    for command in (Command(letters="MO", value=1), Command(letters="SR")):
        message = can.Message(arbitration_id=0x37F, data=command.payload(), is_extended_id=False)
        bench.bus.send(message)
    bench.listen(0.05)
    assert not bench.drive.motor_on
    bench.listen(0.05)
    assert bench.drive.motor_on
    assert bench.drive.switchings[-1][0] - asked == pytest.approx(0.06, abs=1e-3)
    assert [Reply.of(content).letters for _, content in bench.frames[-2:]] == ["MO", "SR"]
    assert int(Reply.of(bench.frames[-1][1]).value) & 0x10


def test_a_brake_holds_what_would_fall_and_stops_what_moves() -> None:
    bench = Bench(brake=200.0)
    bench.run()
    bench.ask("TC", value=4.0)
    bench.listen(0.1)
    speed = bench.drive.joint.velocity
    assert speed > 0.5
    where = bench.drive.joint.position
    bench.ask("MO", value=0)
    bench.listen(0.1)
    stood = bench.drive.joint.position
    assert 0.0 < stood - where < speed * 0.05
    bench.listen(1.0)
    assert bench.drive.joint.position == stood  # the link weighs on it, and it holds
    bench.run()
    bench.listen(0.2)
    assert bench.drive.joint.position != stood
