"""Nobody else may command the drive, or beat as our node: refused at the start, stopped later, marked."""

import math
import socket
import sys
from pathlib import Path
from typing import Any

import can
import pytest
from session_bench import JOINT, PERIOD, EchoingBus, devices, joint, session

import jointid as jid
from jointid.hardware import SessionRefusedError, SessionStoppedError
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_converter import EmulatedConverter
from jointid.hardware.elmo.emulated_drive import ElmoSettings, EmulatedElmo
from jointid.hardware.elmo.foreign import ForeignWatch, gives_back
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.session.drive import DriveFaultError

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))
from fault_cases import BEGIN, COMMAND, OURS, REQUEST, EmulatedSession, foreign

SOON = 10 * PERIOD
ON = bytes.fromhex("4D 4F 00 00 01 00 00 00")
AMPERE = bytes.fromhex("54 43 00 80 00 00 80 3F")
FOREIGN = {
    "heartbeat": (OURS, b"\x05", "sends the heartbeat of node 1"),
    "boot-up": (OURS, b"\x00", "sends the heartbeat of node 1"),
    "torque": (COMMAND, AMPERE, "TC = 1 "),
    "question": (COMMAND, b"SR\x00\x00", "SR "),
    "motor on": (COMMAND, ON, "MO = 1 "),
    "reset of all": (0x000, b"\x81\x00", "'reset node'"),
    "SYNC": (0x080, b"", "SYNC"),
    "object": (REQUEST, bytes.fromhex("40 18 10 01 00 00 00 00"), "object 1018h:1"),
    "control word": (0x27F, b"\x00\x00", "a PDO"),
}


@pytest.mark.parametrize("name", FOREIGN)
def test_a_start_is_refused_and_nothing_is_sent(name: str) -> None:
    identifier, payload, says = FOREIGN[name]
    bench = EmulatedSession()
    foreign(identifier, payload, begin=0.0, every=0.1)(bench)
    with pytest.raises(SessionRefusedError, match=says):
        bench.session().run()
    assert bench.bus.tried == []
    assert bench.elmo.switchings == []


@pytest.mark.parametrize("name", FOREIGN)
def test_a_running_session_stops_within_ten_cycles(name: str, tmp_path: Path) -> None:
    identifier, payload, says = FOREIGN[name]
    bench = EmulatedSession(output=tmp_path / "run.csv")
    foreign(identifier, payload, every=PERIOD)(bench)
    with pytest.raises(SessionStoppedError, match=says) as found:
        bench.session().run()
    stop = found.value.stop
    assert stop.limit == "foreign_master"
    assert BEGIN <= stop.moment <= BEGIN + SOON
    # By the emulator's own stamps the torque is zero soon after.
    assert next(when for when, on in bench.elmo.switchings[1:] if not on) <= BEGIN + SOON
    # And it stays so: the drive is left in a state in which it takes no commands.
    bench.bus.sleep_until(bench.bus.now() + 0.06)
    assert not bench.elmo.motor_on
    for recording in (found.value.recording, jid.load(tmp_path / "run.csv")):
        assert recording is not None
        assert recording.metadata["stopped"]["limit"] == "foreign_master"
    assert found.value.recording is not None
    first = found.value.recording.metadata["drive"]["foreign_frames"][0]
    when, _, frame = first.partition(" ")
    assert float(when) == pytest.approx(BEGIN, abs=1e-3)
    assert frame == f"{identifier:03X}#{payload.hex().upper()}"


def test_frames_for_other_nodes_are_no_concern_of_ours() -> None:
    bench = EmulatedSession()
    for identifier, payload in (
        (0x000, b"\x02\x05"),  # a network command to node 5
        (0x702, b"\x05"),  # node 2's heartbeat
        (0x605, bytes.fromhex("40 18 10 01 00 00 00 00")),
        (0x305, AMPERE),
    ):
        foreign(identifier, payload, begin=0.0)(bench)
    recording = bench.session().run()
    assert recording is not None
    assert "foreign_frames" not in recording.metadata["drive"]


def test_our_node_is_an_option_and_the_drive_watches_it() -> None:
    bench = EmulatedSession(drive=ElmoOptions(master=33))
    foreign(OURS, b"\x05", begin=0.0)(bench)  # the robot's own node 1
    watched: list[int] = []
    bench.at(BEGIN, lambda: watched.append(bench.elmo.objects.master))
    recording = bench.session().run()
    assert recording is not None
    assert watched == [33]
    assert recording.metadata["drive"]["master"] == 33
    assert {sent for _, sent, _ in bench.bus.tried if sent > 0x700} == {0x721}


def test_a_heartbeat_that_keeps_the_drive_on_after_our_death_stops_the_session_before() -> None:
    """What was measured: the motor stayed on for 5 s after the host was killed."""
    bench = EmulatedSession()
    foreign(OURS, b"\x05", begin=BEGIN)(bench)
    with pytest.raises(SessionStoppedError):
        bench.session().run()
    bench.bus.sleep_until(BEGIN + 1.0)
    assert not bench.elmo.motor_on


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"master": 127}, "master is 127: 1 to 127 is expected, other than the drive's node 127"),
        ({"master": 0}, "master is 0"),
        ({"master": 128}, "master is 128"),
        ({"listen": -1.0}, "listen is -1"),
        ({"listen": math.nan}, "listen is nan"),
    ],
)
def test_a_node_that_cannot_be_ours_is_refused(options: Any, says: str) -> None:
    with pytest.raises(jid.InputError, match=says):
        ElmoOptions(**options)


@pytest.mark.parametrize(("node", "ours"), [(1, 2), (2, 1), (127, 1)])
def test_our_node_is_the_first_that_is_not_the_drives(node: int, ours: int) -> None:
    assert ElmoOptions(node=node).master_node == ours


def test_where_our_own_frames_come_back_a_foreign_one_is_told_from_them() -> None:
    elmo = EmulatedElmo(joint(), ElmoSettings())
    bus = EchoingBus(elmo, EmulatedConverter(elmo), bitrate=None)
    drive = ElmoDrive(bus, JOINT)
    drive.connect(PERIOD)
    drive.enable()
    for k in range(60):
        bus.sleep_until(bus.now() + PERIOD)
        drive.read(0.5 * PERIOD)
        drive.command(0.0)
        if k == 50:  # the same frame as ours
            bus.transmit(can.Message(arbitration_id=OURS, data=b"\x05", is_extended_id=False))
            break
    bus.sleep_until(bus.now() + PERIOD)
    with pytest.raises(DriveFaultError, match="sends the heartbeat of node 1") as found:
        drive.read(0.5 * PERIOD)
    assert found.value.kind == "foreign_master"


def test_a_foreign_frame_that_looks_like_our_first_one_blinds_not_for_long() -> None:
    watch = ForeignWatch(ElmoOptions())
    watch.begin()
    watch.sent(0.0, COMMAND, b"SR\x00\x00")
    assert watch.is_own(0.001, COMMAND, b"SR\x00\x00")  # somebody else's, in truth
    watch.decide()
    seen = []
    for k in range(2000):
        watch.sent(2e-3 * k, OURS, b"\x05")
        if k % 10 == 0:
            seen.append(watch.is_own(2e-3 * k + 1e-3, OURS, b"\x05"))
    assert seen[0]
    assert not seen[-1]
    assert not watch.is_own(5.0, OURS, b"\x05")


@pytest.mark.parametrize("every", [0.3, 1.0])
@pytest.mark.parametrize("begin", [0.26, 0.261])
def test_a_question_while_ours_is_on_its_way_is_not_taken_for_it(
    begin: float, every: float
) -> None:
    """An emulated bus gives nothing back, so that the first such frame is somebody else's."""
    bench = EmulatedSession()
    foreign(COMMAND, b"SR\x00\x00", begin=begin, every=every)(bench)
    with pytest.raises((SessionRefusedError, SessionStoppedError), match="SR "):
        bench.session().run()
    assert bench.bus.now() < 0.5
    assert not bench.elmo.motor_on


def test_whether_an_interface_gives_our_own_frames_back() -> None:
    elmo = EmulatedElmo(joint(), ElmoSettings())
    with EmulatedBus(elmo) as quiet, EchoingBus(elmo) as echoing:
        assert gives_back(quiet) is False
        assert gives_back(echoing) is True
    for own in (False, True):
        with can.Bus(interface="virtual", channel="own", receive_own_messages=own) as bus:
            assert gives_back(bus) is own
    assert gives_back(SocketcanBus(0)) is False
    assert gives_back(SocketcanBus(1)) is True
    assert gives_back(OtherBus()) is None


class OtherBus(can.BusABC):
    """Of an interface that says nothing."""

    def __init__(self) -> None:
        super().__init__(channel="other")
        self.shutdown()

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send nothing."""


class SocketcanBus(OtherBus):
    """With the socket's option as the system reports it."""

    __module__ = "can.interfaces.socketcan.socketcan"

    def __init__(self, option: int) -> None:
        super().__init__()
        self.socket = self
        self._option = option

    def getsockopt(self, level: int, option: int) -> int:
        assert (level, option) == (socket.SOL_CAN_RAW, socket.CAN_RAW_RECV_OWN_MSGS)
        return self._option


def test_a_session_where_our_own_frames_come_back() -> None:
    assert session(EchoingBus(*devices())).run() is not None


def test_a_drive_is_left_deaf_to_the_foreign_master_and_a_later_session_starts_anew() -> None:
    bench = EmulatedSession()
    bench.at(BEGIN, lambda: send_once(bench))
    with pytest.raises(SessionStoppedError):
        bench.session().run()
    assert bench.elmo.objects.consumer_time == 0.0
    assert bench.elmo.state == "stopped"
    switchings = len(bench.elmo.switchings)
    bench.bus.transmit(can.Message(arbitration_id=COMMAND, data=ON, is_extended_id=False))
    bench.bus.sleep_until(bench.bus.now() + 0.1)
    assert len(bench.elmo.switchings) == switchings
    recording = bench.session().run()
    assert recording is not None
    assert "foreign_frames" not in recording.metadata["drive"]
    assert bench.elmo.state == "pre-operational"


def send_once(bench: EmulatedSession) -> None:
    bench.bus.transmit(can.Message(arbitration_id=OURS, data=b"\x05", is_extended_id=False))


def test_a_log_with_a_foreign_frame_is_replayed_until_it_stopped_the_session(
    tmp_path: Path,
) -> None:
    path = tmp_path / "run.csv"
    bench = EmulatedSession(output=path)
    foreign(COMMAND, AMPERE, every=PERIOD)(bench)
    with pytest.raises(SessionStoppedError) as found:
        bench.session().run()
    recording = found.value.recording
    assert recording is not None
    assert " 37F#544300800000803F R" in path.with_suffix(".log").read_text()
    again = jid.hardware.replay(path.with_suffix(".log"), bench.drive.joint, recording=recording)
    assert len(again) == len(recording)
