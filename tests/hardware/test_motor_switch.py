"""The motor comes on watched, and goes off by three ways; echoes and late answers of the drive's."""

import math
import struct
from collections.abc import Callable
from itertools import pairwise

import pytest
from session_bench import JOINT, PERIOD, devices, session

from jointid.hardware import DriveFaultError, SessionStoppedError
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.echoes import CommandEchoes
from jointid.hardware.elmo.emulated_drive import EmulatedElmo
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.faults import BusFault

COMMAND, REPLY, REQUEST, ANSWER, POSITION = 0x37F, 0x2FF, 0x67F, 0x5FF, 0x4FF
NETWORK = 0x000


def connected(*faults: BusFault) -> tuple[EmulatedBus, EmulatedElmo, ElmoDrive]:
    elmo, converter = devices()
    bus = EmulatedBus(elmo, converter, faults=faults)
    drive = ElmoDrive(bus, JOINT)
    drive.connect(PERIOD)
    return bus, elmo, drive


def slow_to_answer(elmo: EmulatedElmo, bus: EmulatedBus, delay: float) -> None:
    """MO=1 is answered late: brake, commutation."""
    reply = elmo.reply

    def late(payload: bytes) -> None:
        if payload[:2] == b"MO" and payload[4]:
            bus.at(bus.now() + delay, lambda: reply(payload))
        else:
            reply(payload)

    elmo.reply = late  # type: ignore[method-assign]


@pytest.mark.parametrize("delay", [0.06, 0.5, 2.5])
def test_our_heartbeat_goes_on_while_the_motor_comes_on(delay: float) -> None:
    bus, elmo, drive = connected()
    slow_to_answer(elmo, bus, delay)
    beats: list[float] = []
    drive.tap = lambda when, identifier, _payload, _sent: (
        beats.append(when) if identifier == 0x701 else None
    )
    drive.enable()
    assert elmo.motor_on
    assert elmo.failure == 0
    gaps = [after - before for before, after in pairwise(beats)]
    assert max(gaps) < 0.5 * ElmoOptions().heartbeat
    assert drive.read(PERIOD).fresh


def test_a_session_whose_motor_takes_its_time() -> None:
    elmo, converter = devices()
    bus = EmulatedBus(elmo, converter)
    slow_to_answer(elmo, bus, 0.06)
    assert session(bus).run() is not None


def test_a_motor_that_never_answers_is_given_up_and_goes_off() -> None:
    bus, elmo, drive = connected()
    slow_to_answer(elmo, bus, math.inf)
    with pytest.raises(DriveFaultError, match="no reply to MO within 3000 ms"):
        drive.enable()
    assert drive.disable().motor_off
    assert not elmo.motor_on


def running(*faults: BusFault) -> tuple[EmulatedBus, EmulatedElmo, ElmoDrive]:
    """A motor that is on and turned by 1 A."""
    bus, elmo, drive = connected(*faults)
    drive.enable()
    for _ in range(5):
        bus.sleep_until(bus.now() + PERIOD)
        drive.read(0.75 * PERIOD)
        drive.command(20.0)
    for fault in faults:
        fault.start = bus.now()
    return bus, elmo, drive


def drops(*identifiers: int) -> tuple[BusFault, ...]:
    return tuple(
        BusFault(kind="drop", start=math.inf, identifier=identifier) for identifier in identifiers
    )


@pytest.mark.parametrize(
    ("lost", "seen"),
    [
        ((), True),
        ((COMMAND,), True),  # 6040h and 6041h by SDO
        ((REPLY,), True),
        ((COMMAND, NETWORK), True),
        ((COMMAND, REQUEST), False),  # the network's stop
        ((COMMAND, REQUEST, REPLY, ANSWER), False),
        ((REPLY, ANSWER), False),
    ],
)
def test_three_ways_off(lost: tuple[int, ...], seen: bool) -> None:
    bus, elmo, drive = running(*drops(*lost))
    began = bus.now()
    end = drive.disable()
    assert end.motor_off is seen
    when, on = elmo.switchings[-1]
    assert not on
    assert when - began < 0.02  # not by the drive's own watchdog, which takes 50 ms
    assert end.failure == ""
    assert bus.now() - began < 0.25


def test_a_motor_that_is_off_is_not_asked_again() -> None:
    bus, _, drive = running()
    drive.disable()
    sent = bus.sent
    assert drive.disable().motor_off
    assert bus.sent == sent


def test_the_drives_failure_is_told_where_only_objects_answer() -> None:
    _, elmo, drive = running(*drops(COMMAND))
    elmo.fail("over-temperature")
    end = drive.disable()
    assert end.motor_off


# Echoes.


def test_echoes_in_order_late_lost_and_twice() -> None:
    echoes = CommandEchoes()
    assert echoes.came(3.0) == ""  # the motor is off: whose ever it is
    echoes.begin()
    for current in (0.0, 1.0, 2.0, 3.0):
        echoes.sent(current)
    assert echoes.came(1.0) == ""  # that of 0 was lost
    assert echoes.lost == 1
    assert echoes.came(1.0) == ""  # a frame that came twice
    assert echoes.came(2.0 + 1e-7) == ""
    assert "TC = 5 A, but 3 A was sent" in echoes.came(5.0)
    echoes.check()
    for _ in range(4):
        echoes.sent(4.0)
    echoes.check()
    echoes.sent(4.0)
    with pytest.raises(DriveFaultError, match="not acknowledged 5 torque commands") as found:
        echoes.check()
    assert found.value.kind == "command_echo"
    assert (found.value.measured, found.value.allowed) == (5, 4)
    echoes.end()
    assert echoes.came(9.0) == ""


@pytest.mark.parametrize("lost", [4, 5])
def test_a_burst_of_five_lost_commands_stops(lost: int) -> None:
    fault = BusFault(kind="drop", start=math.inf, identifier=COMMAND)
    bus, _, drive = running(fault)
    begin = fault.start = bus.now()
    fault.stop = begin + (lost + 0.75) * PERIOD

    def cycles() -> None:
        for k in range(20):
            bus.sleep_until(begin + (k + 1) * PERIOD)
            drive.read(0.75 * PERIOD)
            drive.command(20.0 + k)

    if lost < 5:
        cycles()
        assert drive.identity()["lost_echoes"] == lost
    else:
        with pytest.raises(DriveFaultError, match="acknowledged 5"):
            cycles()


# Answers to SYNC.


def test_a_lost_answer_costs_two_cycles() -> None:
    fault = BusFault(kind="drop", start=math.inf, identifier=POSITION)
    bus, _, drive = running(fault)
    begin = fault.start = bus.now()
    fault.stop = begin + 1.5 * PERIOD
    failed = []
    for k in range(10):
        bus.sleep_until(begin + (k + 1) * PERIOD)
        try:
            drive.read(0.5 * PERIOD)
        except DriveFaultError as error:
            failed.append((k, error.kind))
        drive.command(20.0)
    assert failed == [(0, "stale_position"), (1, "stale_position")]


def counting(
    delay: float,
) -> tuple[EmulatedBus, ElmoDrive, BusFault, Callable[[], float]]:
    """A drive whose encoder counts the milliseconds; an answer can be late."""
    fault = BusFault(kind="delay", start=math.inf, identifier=POSITION, delay=delay)
    bus, elmo, drive = running(fault)
    fault.start = math.inf
    elmo.counts = lambda: round(1e3 * bus.now())  # type: ignore[method-assign]

    def age() -> float:
        position = drive.read(0.5 * PERIOD).position
        return bus.now() - position / drive.options.per_count(JOINT) * 1e-3

    return bus, drive, fault, age


@pytest.mark.parametrize("delay", [4.5e-3, 6.2e-3, 9e-3])
def test_an_answer_that_comes_after_it_was_given_up_is_noticed(delay: float) -> None:
    bus, drive, fault, age = counting(delay)
    bus.sleep_until(bus.now() + PERIOD)
    begin = fault.start = bus.now()
    fault.stop = begin + 1e-3  # the answer of one SYNC alone
    old, failed = 0, []
    for k in range(20):
        bus.sleep_until(begin + k * PERIOD)
        try:
            old += age() > 1.6e-3
        except DriveFaultError as error:
            failed.append(error.kind)
        drive.command(0.0)
    assert old <= 1  # then the surplus is seen: what follows is not shifted
    assert failed == 3 * ["stale_position"]


def test_a_late_answer_leaves_no_negative_time() -> None:
    """What was seen: "no answer to the SYNC within −2.18 ms"."""
    fault = BusFault(kind="delay", start=math.inf, identifier=POSITION, delay=1.95e-3)
    bus, _, drive = running(fault)
    begin = fault.start = bus.now()
    said = []
    for k in range(6):
        bus.sleep_until(begin + (k + 1) * PERIOD)
        with pytest.raises(DriveFaultError) as found:
            drive.read(0.5 * PERIOD)
        said.append(str(found.value))
        assert found.value.allowed is not None
        assert found.value.measured is not None
        assert found.value.measured > 0.0
        assert 0.1 * PERIOD < found.value.allowed < 0.51 * PERIOD
        drive.command(0.0)
    assert not [text for text in said if " -" in text or "−" in text]
    assert any("is left to wait for the next" in text for text in said)


def test_a_changed_echo_stops_a_session_and_says_by_how_much() -> None:
    elmo, converter = devices()
    bus = EmulatedBus(elmo, converter)
    reply = elmo.reply

    def changed(payload: bytes) -> None:
        if payload[:2] == b"TC" and bus.now() > 1.0:
            payload = payload[:4] + struct.pack("<f", 7.25)
        reply(payload)

    elmo.reply = changed  # type: ignore[method-assign]
    with pytest.raises(SessionStoppedError, match=r"acknowledges TC = 7.25 A, but") as found:
        session(bus).run()
    assert found.value.stop.limit == "command_echo"
    assert not elmo.motor_on
