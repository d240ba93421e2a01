"""A session that should not start does not: the motor stays off, and the reason is said."""

import math
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.session import Session, SessionOptions
from jointid.hardware.session.stop import SessionRefusedError

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))
from fault_cases import EmulatedSession

Prepare = Callable[[EmulatedSession], object]


def limited(**changes: Any) -> Prepare:
    def prepare(bench: EmulatedSession) -> None:
        bench.limits = replace(bench.limits, **changes)

    return prepare


def with_elmo(**attributes: Any) -> Prepare:
    def prepare(bench: EmulatedSession) -> None:
        for name, value in attributes.items():
            setattr(bench.elmo, name, value)

    return prepare


def strong(bench: EmulatedSession) -> None:
    bench.elmo.current_limits[0] = 9.0


def railed(bench: EmulatedSession) -> None:
    bench.converter.stuck = bytes(4)


def unwilling(bench: EmulatedSession) -> None:
    """An object that this drive does not have."""
    answer = bench.elmo.objects.answer

    def refuse(payload: bytes) -> bytes | None:
        request = canopen.SdoRequest.of(payload)
        missing = request.index == 0x1016
        return canopen.sdo_abort(request, 0x06020000) if missing else answer(payload)

    bench.elmo.objects.answer = refuse  # type: ignore[method-assign]


def open_loop(bench: EmulatedSession) -> None:
    bench.law = jid.OpenLoop()
    bench.trajectory = jid.Trajectory.sine(170.0, 0.5, duration=2.0)


def fast_at_the_edge(bench: EmulatedSession) -> None:
    """It brakes harder, just inside of the window, than any torque of this drive can."""
    limited(position=(-0.5, 0.5))(bench)
    bench.trajectory = jid.Trajectory.trapezoid(
        0.49, velocity=5.0, acceleration=200.0, duration=1.0
    )


CASES: dict[str, tuple[Prepare, str]] = {
    "not homed": (with_elmo(slipped_counts=-(10**6)), "is it homed"),
    "trajectory outside": (limited(position=(-0.2, 0.6)), "outside -0.2000 to 0.6000 rad"),
    "trajectory too fast": (limited(velocity=1.0), "rad/s, more than 1 rad/s"),
    "too fast at the edge": (
        fast_at_the_edge,
        r"too fast near the edge of the window: .* would stop the joint only at .* outside -0\.5000 to 0\.5000 rad",
    ),
    "torque beyond": (open_loop, "needs 170 N·m, more than 160 N·m"),
    "peak current": (strong, r"PL\[1\] is 9 A, but the session allows only 8 A"),
    "unit mode": (with_elmo(fixed_unit_mode=5), "is in unit mode 5, not in torque mode"),
    "failure latched": (
        with_elmo(failure=0x4),
        r"down earlier \(feedback lost\).*acknowledge = true under \[session.drive\].*delete this line",
    ),
    "power stage": (with_elmo(problem=6), "reports over-temperature"),
    "sensor at its end": (railed, "sensor is at the end of its range"),
    "object missing": (unwilling, "refused object 1016h:1: the object does not exist"),
}
WIRES = {
    "nobody there": (
        BusFault(kind="drop", start=0.0),
        "no boot-up message from node 127 within 2000 ms; check that the drive is on, and that its node",
    ),
    "no answers": (BusFault(kind="drop", start=0.0, identifier=0x5FF), "no answer to object 1018h"),
    "no replies": (BusFault(kind="drop", start=0.0, identifier=0x2FF), "no reply to SR"),
    "no position": (BusFault(kind="drop", start=0.0, identifier=0x4FF), "no answer to the SYNC"),
    "garbled replies": (BusFault(kind="corrupt", start=0.0, identifier=0x2FF), "unreadable reply"),
    "interface down": (BusFault(kind="down", start=0.0), "the network is down"),
    "bus off": (BusFault(kind="bus_off", start=0.0), "an error frame"),
}


def refused(bench: EmulatedSession, message: str, **more: Any) -> None:
    """It does not start, and the motor has never been on."""
    with pytest.raises(SessionRefusedError, match=f"not started: .*{message}"):
        bench.session().run(**more)
    assert bench.elmo.switchings == []
    assert bench.elmo.torque_commands == []
    assert bytes.fromhex("4D 4F 00 00 01 00 00 00") not in {data for _, _, data in bench.bus.tried}


@pytest.mark.parametrize("name", CASES)
def test_start_is_refused(name: str) -> None:
    prepare, message = CASES[name]
    bench = EmulatedSession()
    prepare(bench)
    refused(bench, message)


@pytest.mark.parametrize("name", WIRES)
def test_start_on_a_bad_bus_is_refused(name: str) -> None:
    fault, message = WIRES[name]
    refused(EmulatedSession((fault,)), message)


def test_full_bus_is_refused_before_it_is_touched() -> None:
    bench = EmulatedSession()
    session = Session(
        *(bench.drive, bench.law, bench.trajectory, bench.limits),
        options=SessionOptions(period=1e-3),
    )
    with pytest.raises(SessionRefusedError, match=r"the bus load is 1\d\d %, more than 80 %"):
        session.run()
    assert bench.bus.tried == []


@pytest.mark.parametrize("state", ["operational", "pre-operational"])
def test_motor_that_another_has_switched_on_is_left_alone(state: str) -> None:
    bench = EmulatedSession()
    bench.elmo.state, bench.elmo.unit_mode = state, 1
    bench.elmo.switch(on=True)
    bench.elmo.current = 1.5
    with pytest.raises(SessionRefusedError, match="the motor is already on"):
        bench.session().run()
    assert bench.elmo.motor_on
    assert bench.elmo.current == 1.5
    assert bench.bus.assignments() == []
    if state == "operational":  # not even its communication is reset
        assert {identifier for _, identifier, _ in bench.bus.tried} == {0x37F}


def test_several_reasons_are_reported_together() -> None:
    bench = EmulatedSession()
    strong(bench)
    railed(bench)
    refused(bench, "PL.*; the torque sensor is at the end")


def test_failure_that_is_acknowledged_is_cleared() -> None:
    bench = EmulatedSession(drive=ElmoOptions(acknowledge=True))
    bench.elmo.failure = 0x4
    assert bench.session().run() is not None
    assert bench.elmo.failure == 0


def test_reading_that_is_no_number_is_refused() -> None:
    bench = EmulatedSession(drive=ElmoOptions(torque=AnalogInput(every=1)))
    bench.elmo.stuck_voltage = math.nan
    refused(bench, "AN is nan: a finite value is expected")
    bench.elmo.stuck_voltage = 9.99
    refused(bench, "sensor is at the end of its range")


def test_dry_run_only_looks() -> None:
    bench = EmulatedSession()
    assert bench.session().run(dry_run=True) is None
    assert bench.elmo.switchings == []
    bench = EmulatedSession()
    strong(bench)
    refused(bench, "PL", dry_run=True)


def test_limits_of_the_trajectory_are_looked_at_at_their_edge() -> None:
    bench = EmulatedSession()
    highest = float(bench.trajectory.sample(np.linspace(0.0, 2.0, 2000))[0].max())
    bench.limits = SessionLimits.of(jid.thesis_joint(), position=(-1.0, highest + 1e-3))
    assert bench.session().run() is not None
