"""A drive's answer counts for the SYNC it answers, however late, early or often frames come."""

import math

import can
import pytest
from session_bench import JOINT, PERIOD, EchoingBus, devices, joint

from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_converter import EmulatedConverter
from jointid.hardware.elmo.emulated_drive import ElmoSettings, EmulatedElmo
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.session.drive import DriveFaultError

POSITION, SENSOR = 0x4FF, 0x1C0


class MovingBench:
    """A drive whose encoder counts the milliseconds, so that each answer tells when it was given."""

    def __init__(self, *faults: BusFault) -> None:
        elmo, converter = devices()
        elmo.counts = lambda: round(1e3 * self.bus.now())  # type: ignore[method-assign]
        self.bus = EmulatedBus(elmo, converter, faults=faults)
        self.drive = ElmoDrive(self.bus, JOINT)
        self.drive.connect(PERIOD)
        self.drive.enable()

    def wording(self) -> float:
        """The time that the newest answer tells [s]."""
        position = self.drive.read(0.5 * PERIOD).position
        return position / self.drive.options.angle(1, JOINT) * 1e-3


def test_after_a_stall_the_newest_position_counts() -> None:
    bench = MovingBench()
    bench.wording()
    for _ in range(20):  # somebody else's SYNCs, answered while the host stands still
        bench.bus.send(can.Message(arbitration_id=canopen.SYNC, is_extended_id=False))
        bench.bus.sleep_until(bench.bus.now() + PERIOD)
    now = bench.bus.now()
    assert bench.wording() == pytest.approx(now, abs=1.01e-3)


@pytest.mark.parametrize("delay", [0.8e-3, 1.2e-3, 1.7e-3, 2.1e-3, 2.9e-3])
@pytest.mark.parametrize("identifier", [POSITION, SENSOR])
def test_a_late_answer_is_never_taken_for_the_next_one(delay: float, identifier: int) -> None:
    fault = BusFault(kind="delay", start=math.inf, identifier=identifier, delay=delay)
    bench = MovingBench(fault)
    bench.wording()
    bench.bus.sleep_until(bench.bus.now() + PERIOD)
    begin = bench.bus.now()
    fault.start, fault.stop = begin, begin + 1e-3  # the answer of one SYNC alone
    late = 0
    for k in range(8):
        bench.bus.sleep_until(begin + k * PERIOD)
        asked = bench.bus.now()
        try:
            wording = bench.wording()
        except DriveFaultError as error:
            late += error.kind == "stale_position"
            continue
        assert asked - 0.51e-3 <= wording <= bench.bus.now() + 0.51e-3
    assert late <= math.ceil(delay / PERIOD)
    assert late >= (delay > 0.5 * PERIOD)


def test_a_lost_answer_is_given_up_in_the_end() -> None:
    fault = BusFault(kind="drop", start=math.inf, identifier=POSITION)
    bench = MovingBench(fault)
    bench.wording()
    begin = bench.bus.now()
    fault.start, fault.stop = begin, begin + 1e-3
    with pytest.raises(DriveFaultError, match="no answer to the SYNC within 1 ms"):
        bench.wording()
    while bench.bus.now() < begin + 2.0 * bench.drive.options.heartbeat:
        bench.bus.sleep_until(bench.bus.now() + PERIOD)
        bench.drive.command(0.0)
    assert bench.wording() == pytest.approx(bench.bus.now(), abs=1.5e-3)


def test_an_answer_that_comes_twice_is_one_answer() -> None:
    fault = BusFault(kind="duplicate", start=0.0, identifier=POSITION)
    bench = MovingBench(fault)
    for _ in range(20):
        bench.bus.sleep_until(bench.bus.now() + PERIOD)
        now = bench.bus.now()
        assert bench.wording() == pytest.approx(now, abs=1.01e-3)
        bench.drive.command(0.0)


@pytest.mark.parametrize("node", [1, 2, 127])
def test_a_drive_is_not_confused_by_its_own_frames(node: int) -> None:
    elmo = EmulatedElmo(joint(), ElmoSettings(node=node))
    converter = EmulatedConverter(elmo)
    bus = EchoingBus(elmo, converter, bitrate=None)
    drive = ElmoDrive(bus, JOINT, ElmoOptions(node=node))
    received: list[int] = []
    drive.tap = lambda _when, identifier, _payload, sent: (
        None if sent else received.append(identifier)
    )
    drive.connect(PERIOD)
    assert drive.problems(160.0) == []
    drive.enable()
    for _ in range(10):
        bus.sleep_until(bus.now() + PERIOD)
        drive.command(0.5)
        assert drive.read(0.5 * PERIOD).fresh
    drive.disable()
    drive.close()
    assert not elmo.motor_on
    # In the log, a frame of the host's is there once, as sent.
    theirs = {0x280 + node, 0x480 + node, 0x580 + node, 0x700 + node, SENSOR}
    assert set(received) == theirs
