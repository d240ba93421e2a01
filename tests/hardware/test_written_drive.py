"""A drive written from the protocol's documentation alone, without CAN, runs a session."""

import math
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from session_bench import PERIOD

import jointid as jid
from jointid.base.errors import InputError
from jointid.hardware.session.drive import Drive, DriveFaultError, DriveSample
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.session import (
    Session,
    SessionOptions,
    SessionRefusedError,
    SessionStoppedError,
)


class SimulatedTime:
    """A clock that only waiting moves."""

    def __init__(self) -> None:
        self.time = 0.0

    def now(self) -> float:
        return self.time

    def sleep_until(self, deadline: float) -> None:
        self.time = max(self.time, deadline)


@dataclass
class Flywheel:
    """A motor that turns a wheel with viscous friction; no gear, no CAN, no sensor."""

    inertia: float = 0.5
    viscous: float = 1.0
    strongest: float = 20.0
    clock: SimulatedTime = field(default_factory=SimulatedTime)
    command_latency: float = 0.0

    def __post_init__(self) -> None:
        self.position = self.velocity = self.torque = self.moved = 0.0
        self.on = self.silent = False
        self.calls: list[str] = []

    def connect(self, period: float) -> None:
        self.calls.append(f"connect {period}")

    def problems(self, torque_limit: float) -> list[str]:
        self.calls.append("problems")
        if self.strongest > torque_limit:
            return [
                f"the motor can {self.strongest:g} N·m, the session allows {torque_limit:g} N·m"
            ]
        return []

    def enable(self) -> None:
        self.calls.append("enable")
        self.on, self.torque = True, 0.0

    def read(self, timeout: float) -> DriveSample:
        if self.silent:
            raise DriveFaultError("stale_position", f"nothing came within {1e3 * timeout:g} ms")
        self._move()
        return DriveSample(time=self.clock.now(), position=self.position)

    def command(self, torque: float) -> float:
        self._move()
        self.torque = max(-self.strongest, min(self.strongest, torque))
        return self.torque

    def disable(self) -> None:
        self._move()
        self.torque, self.on = 0.0, False
        self.calls.append("disable")

    def close(self) -> None:
        self.calls.append("close")

    def bus_load(self, period: float) -> float:
        del period
        return 0.0

    def identity(self) -> dict[str, Any]:
        return {"drive": "flywheel", "inertia": self.inertia}

    def _move(self) -> None:
        """The exact solution under a torque that holds."""
        duration, self.moved = self.clock.now() - self.moved, self.clock.now()
        decay = math.exp(-duration * self.viscous / self.inertia)
        final = (self.torque if self.on else 0.0) / self.viscous
        lag = (self.velocity - final) * self.inertia / self.viscous
        self.position += final * duration + lag * (1.0 - decay)
        self.velocity = final + (self.velocity - final) * decay


LAW = jid.Pd(stiffness=200.0, damping=20.0)
SWING = jid.Trajectory.thesis(0.3, cycle=2.0, duration=2.0)
LIMITS = SessionLimits(position=(-1.0, 1.0), velocity=5.0, torque=25.0)
OPTIONS = SessionOptions(period=PERIOD, resolution=1e-9, settle=0.1)


def test_it_is_a_drive_to_the_type_checker() -> None:
    drive: Drive = Flywheel()
    assert drive.bus_load(PERIOD) == 0.0


def test_a_whole_session() -> None:
    wheel = Flywheel()
    recording = Session(wheel, LAW, SWING, LIMITS, options=OPTIONS).run()
    assert isinstance(recording, jid.Recording)
    assert recording.time.size == 1000
    assert recording.reference is not None
    assert recording.torque is not None
    assert recording.current is None
    assert recording.metadata["drive"] == {"drive": "flywheel", "inertia": 0.5}
    assert np.abs(recording.position - recording.reference).max() < 0.1
    assert [name for name in wheel.calls if name != "disable"] == [
        f"connect {PERIOD}",
        "problems",
        "enable",
        "close",
    ]
    assert wheel.calls[-2] == "disable"
    assert (wheel.on, wheel.torque) == (False, 0.0)
    # What was recorded is the wheel's motion: its balance of torques closes.
    speed = np.gradient(recording.position, recording.time)
    balance = 0.5 * np.gradient(speed, recording.time) + 1.0 * speed
    inside = slice(10, -10)
    assert np.std((recording.torque - balance)[inside]) < 0.02 * np.std(recording.torque[inside])


def test_its_frames_of_can_fd_are_in_the_log_from_the_first(tmp_path: Path) -> None:
    @dataclass
    class Tapped(Flywheel):
        tap: Any = None

        def connect(self, period: float) -> None:
            self.tap(0.0, 0x8001, b"\x01", True, fd=True, extended=True)
            super().connect(period)

        def read(self, timeout: float) -> DriveSample:
            self.tap(self.clock.now(), 0x101, b"\x02", False, fd=True)
            return super().read(timeout)

    Session(Tapped(), LAW, SWING, LIMITS, options=OPTIONS, output=tmp_path / "run.csv").run()
    lines = (tmp_path / "run.log").read_text().splitlines()
    assert lines[0] == "(0.000000000) can0 00008001##101 T"
    assert lines[-1].endswith(" can0 101##102 R")


def test_what_it_says_against_a_start_is_heard() -> None:
    wheel = Flywheel(strongest=30.0)
    with pytest.raises(
        SessionRefusedError, match="the motor can 30 N·m, the session allows 25 N·m"
    ):
        Session(wheel, LAW, SWING, LIMITS, options=OPTIONS).run()
    assert "enable" not in wheel.calls
    assert wheel.calls[-1] == "close"


def test_its_fault_stops_the_session_under_its_name() -> None:
    wheel = Flywheel()

    def watch(phase: str, when: float, *_: object) -> None:
        wheel.silent = phase == "run" and when > 1.0

    with pytest.raises(SessionStoppedError) as stopped:
        Session(wheel, LAW, SWING, LIMITS, options=OPTIONS, observer=watch).run()
    stop = stopped.value.stop
    # A few samples may be late; these are too many.
    assert (stop.limit, stop.phase) == ("late_samples", "run")
    assert stop.time == pytest.approx(1.0, abs=9.0 * PERIOD)
    assert "nothing came within 1.5 ms" in stop.message
    assert (wheel.on, wheel.torque) == (False, 0.0)
    assert wheel.calls[-1] == "close"


def test_the_resolution_is_the_drives_or_the_sessions() -> None:
    wheel, options = Flywheel(), SessionOptions(period=PERIOD, settle=0.1)
    with pytest.raises(InputError) as refused:
        Session(wheel, LAW, SWING, LIMITS, options=options)
    assert refused.value.argument == "resolution"
    assert wheel.calls == []
    wheel.resolution = 1e-9  # type: ignore[attr-defined]
    recording = Session(wheel, LAW, SWING, LIMITS, options=options).run()
    assert recording is not None
    assert recording.metadata["options"]["resolution"] == 1e-9
    again = Session(Flywheel(), LAW, SWING, LIMITS, options=OPTIONS).run()
    assert again is not None
    assert np.array_equal(again.position, recording.position)


def test_a_measured_velocity_takes_the_place_of_the_estimated_one() -> None:
    class Measuring(Flywheel):
        offset = 0.0

        def read(self, timeout: float) -> DriveSample:
            return replace(super().read(timeout), velocity=self.velocity + self.offset)

    seen: dict[str, list[float]] = {"measured": [], "estimated": []}

    class Law:
        """Keeps the velocity that the session gives to the controller."""

        def __init__(self, name: str) -> None:
            self.name, self.saturations = name, 0

        def start(self, **options: float) -> "Law":
            self.run = LAW.start(**options)
            return self

        def step(self, **measured: float) -> float:
            seen[self.name].append(measured["velocity"])
            return self.run.step(**measured)

    for wheel, name in ((Measuring(), "measured"), (Flywheel(), "estimated")):
        law: Any = Law(name)
        recording = Session(wheel, law, SWING, LIMITS, options=OPTIONS).run()
        assert recording is not None
        assert recording.metadata.get("velocity_measured", False) is (name == "measured")
        peak = max(map(abs, seen[name]))
        assert 0.5 < peak < 5.0
    # The estimate is the mean over past samples, so it lags behind.
    assert seen["measured"] != seen["estimated"]
    wrong = Measuring()
    wrong.offset = 6.0
    with pytest.raises(SessionStoppedError) as stopped:
        Session(wrong, LAW, SWING, LIMITS, options=OPTIONS).run()
    assert stopped.value.stop.limit == "velocity"


def test_a_measured_velocity_that_is_stuck_does_not_disarm_the_limit() -> None:
    class Stuck(Flywheel):
        def read(self, timeout: float) -> DriveSample:
            return replace(super().read(timeout), velocity=0.0)

    wheel = Stuck()
    push = jid.Trajectory.step(5.0, duration=2.0)
    within = replace(LIMITS, velocity=0.5)
    with pytest.raises(SessionStoppedError) as stopped:
        Session(wheel, jid.OpenLoop(), push, within, options=OPTIONS).run()
    assert stopped.value.stop.limit == "velocity"
    assert stopped.value.stop.measured == pytest.approx(0.5, abs=0.1)
    assert abs(wheel.velocity) < 0.6


@pytest.mark.parametrize("back", [0.0, 0.005, math.nan])
def test_a_sample_that_is_not_later_than_the_last_one_is_the_drives_fault(back: float) -> None:
    class Stamping(Flywheel):
        last = math.nan

        def read(self, timeout: float) -> DriveSample:
            sample = super().read(timeout)
            if self.clock.now() > 1.5:
                return replace(sample, time=self.last - back)
            self.last = sample.time
            return sample

    wheel = Stamping()
    with pytest.raises(SessionStoppedError, match="stamps must increase") as stopped:
        Session(wheel, LAW, SWING, LIMITS, options=OPTIONS).run()
    assert stopped.value.stop.limit == "stale_position"
    assert stopped.value.stop.allowed == wheel.last
    assert not wheel.on
    assert stopped.value.recording is not None


METHODS = ["connect", "problems", "enable", "read", "command", "disable", "close"]
METHODS += ["bus_load", "identity"]


@pytest.mark.parametrize("name", METHODS)
def test_a_missing_method_is_reported_before_anything_is_called(name: str) -> None:
    members = {key: value for key, value in vars(Flywheel).items() if key != name}
    wheel = type("Incomplete", (), members)()
    with pytest.raises(InputError) as refused:
        Session(wheel, LAW, SWING, LIMITS, options=OPTIONS)
    assert str(refused.value) == (
        f"drive is an Incomplete: a drive is expected, but this object has no {name}(); "
        "see `jointid.hardware.Drive` for the methods that a session needs"
    )
    assert wheel.calls == []


def test_all_missing_methods_are_reported_at_once() -> None:
    with pytest.raises(InputError, match=r"has no connect\(\), .*, clock, command_latency;"):
        Session(object(), LAW, SWING, LIMITS)  # type: ignore[arg-type]


def test_the_drive_in_the_documentation_runs(repo: Path) -> None:
    text = (repo / "docs" / "hardware.md").read_text(encoding="utf-8")
    section = text.partition("\n## Writing your own drive")[2]
    code = section.partition("```python\n")[2].partition("```")[0]
    names: dict[str, Any] = {}
    exec(compile(code, "docs", "exec"), names)
    recording = names["recording"]
    assert recording.time.size == 1000
    assert np.abs(recording.position - recording.reference).max() < 0.1
    for member in (*METHODS, "clock", "command_latency"):
        assert f"| `{member}" in section
