"""A bug in a session: the motor is off and the recording closed first, then the exception is raised again."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from session_bench import JOINT, PERIOD, devices, law, limits, motion

import jointid as jid
from jointid.hardware import (
    DriveFaultError,
    EmulatedBus,
    SessionOptions,
    SessionRefusedError,
    SessionStoppedError,
)
from jointid.hardware.elmo import ElmoDrive
from jointid.hardware.elmo.decoder import ElmoDecoder
from jointid.hardware.session import recorder as recorder_module
from jointid.hardware.session.guard import Guard
from jointid.hardware.session.session import Session
from jointid.hardware.session.velocity_estimator import VelocityEstimator

BEGIN = 0.9  # [s] on the bus's clock, in the run


class Bench:
    """A session into which a bug can be put."""

    def __init__(self, output: Path | None = None) -> None:
        self.elmo, converter = devices()
        self.bus = EmulatedBus(self.elmo, converter)
        self.drive = ElmoDrive(self.bus, JOINT)
        self.law: Any = law()
        self.observer: Callable[..., object] | None = None
        self.output = output

    def session(self) -> Session:
        return Session(
            self.drive,
            self.law,
            motion(),
            limits(),
            options=SessionOptions(period=PERIOD, settle=0.05),
            output=self.output,
            observer=self.observer,
        )

    def run(self) -> jid.Recording | None:
        return self.session().run()


class Law:
    """A controller of the user's own with a bug."""

    def __init__(self, inner: Any, fails: Callable[[], None]) -> None:
        self._inner, self._fails = inner, fails
        self.saturations = 0

    def start(self, **options: Any) -> "Law":
        self._inner = self._inner.start(**options)
        return self

    def step(self, **measured: float) -> float:
        self._fails()
        return float(self._inner.step(**measured))


Fails = Callable[[], None]


def before(monkeypatch: pytest.MonkeyPatch, owner: Any, name: str, fails: Fails) -> None:
    """Let a method fail before it does its work."""
    work = getattr(owner, name)

    def failing(*given: Any, **more: Any) -> Any:
        fails()
        return work(*given, **more)

    monkeypatch.setattr(owner, name, failing)


def put(place: str, bench: Bench, fails: Fails, monkeypatch: pytest.MonkeyPatch) -> None:
    """Put a bug in a place."""
    if place == "controller":
        bench.law = Law(bench.law, fails)
    elif place == "observer":
        bench.observer = lambda *_: fails()
    elif place in ("read", "command"):
        before(monkeypatch, bench.drive, place, fails)
    elif place == "decoder":
        before(monkeypatch, ElmoDecoder, "take", fails)
    elif place == "guard":
        before(monkeypatch, Guard, "commanded", fails)
    else:
        before(monkeypatch, VelocityEstimator, "__call__", fails)


PLACES = ("controller", "observer", "read", "command", "decoder", "guard", "estimator")


@pytest.mark.parametrize("kind", [TypeError, ValueError, KeyError])
@pytest.mark.parametrize("place", PLACES)
def test_a_bug_is_raised_again_after_the_motor_is_off_and_the_recording_closed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str, kind: type[Exception]
) -> None:
    bench, bug = Bench(tmp_path / "run.csv"), kind("a bug")
    thrown: list[float] = []

    def fails() -> None:
        if bench.bus.now() >= BEGIN and not thrown:
            assert bench.elmo.motor_on
            thrown.append(bench.bus.now())
            raise bug

    put(place, bench, fails, monkeypatch)
    with pytest.raises(kind) as found:
        bench.run()
    assert found.value is bug
    assert not bench.elmo.motor_on
    assert bench.elmo.switchings[-1][0] - thrown[0] < 3.0 * PERIOD
    (note,) = bug.__notes__
    assert note.startswith("the session was stopped by error after ")
    recording = jid.load(tmp_path / "run.csv")
    assert recording.metadata["stopped"]["limit"] == "error"
    assert recording.metadata["stopped"]["motor_off"] is True
    assert not {"torn", "truncated"} & recording.metadata.keys()


@pytest.mark.parametrize("name", ["disable", "close"])
def test_a_bug_on_the_way_out_is_raised_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    bench, thrown = Bench(tmp_path / "run.csv"), list[None]()

    def fails() -> None:
        if not thrown:
            thrown.append(None)
            raise KeyError("a bug")

    before(monkeypatch, bench.drive, name, fails)
    with pytest.raises(KeyError) as found:
        bench.run()
    assert not bench.elmo.motor_on  # the second disable() of every way out has done it
    assert found.value.__notes__ == ["the session was completed"]
    assert jid.load(tmp_path / "run.csv").metadata["motor_off"] is True


def test_a_bug_in_disable_that_stays_says_that_the_motor_was_not_seen_off(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = Bench(tmp_path / "run.csv")

    def fails() -> None:
        raise TypeError("a bug")

    before(monkeypatch, bench.drive, "disable", fails)
    with pytest.raises(TypeError) as found:
        bench.run()
    assert "THE DRIVE DID NOT CONFIRM THAT THE MOTOR IS OFF" in found.value.__notes__[0]


def test_a_bug_in_a_dry_run_is_raised(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(tmp_path / "run.csv")

    def fails() -> None:
        raise KeyError("a bug")

    before(monkeypatch, bench.drive, "close", fails)
    run = Session(bench.drive, bench.law, motion(), limits())
    with pytest.raises(KeyError):
        run.run(dry_run=True)


def test_a_bug_in_the_writing_thread_stops_the_session(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench, line = Bench(tmp_path / "run.csv"), recorder_module._line

    def fails(frame: Any) -> bytes:
        if frame[0] > BEGIN:
            raise TypeError("a bug")
        return line(frame)

    monkeypatch.setattr(recorder_module, "_line", fails)
    with pytest.raises(TypeError, match="a bug"):
        bench.run()
    assert not bench.elmo.motor_on


@pytest.mark.parametrize(
    "cause", [jid.InputError("wrong"), OSError("gone"), DriveFaultError("bus", "gone")]
)
def test_what_is_no_bug_stops_the_session(tmp_path: Path, cause: Exception) -> None:
    bench = Bench(tmp_path / "run.csv")

    def watch(*_: object) -> None:
        if bench.bus.now() >= BEGIN:
            raise cause

    bench.observer = watch
    with pytest.raises(SessionStoppedError) as found:
        bench.run()
    assert found.value.__cause__ is cause
    assert found.value.recording is not None


def late(fails: Fails, bench: Bench) -> Callable[..., object]:
    """An observer that fails in the run."""
    return lambda *_: fails() if bench.bus.now() >= BEGIN else None


def broken() -> None:
    raise KeyError("a bug")


def test_what_was_recorded_before_a_bug_is_kept_by_the_session() -> None:
    bench = Bench()
    bench.observer = late(broken, bench)
    session = bench.session()
    assert session.recording is None
    with pytest.raises(KeyError):
        session.run()
    assert session.recording is not None
    assert session.recording.time.size > 100
    assert session.recording.metadata["stopped"]["limit"] == "error"


def test_the_recording_is_kept_by_the_session_after_success_and_after_a_stop() -> None:
    session = Bench().session()
    assert session.run() is session.recording is not None
    bench = Bench()

    def stops() -> None:
        raise DriveFaultError("bus", "gone")

    bench.observer = late(stops, bench)
    session = bench.session()
    with pytest.raises(SessionStoppedError) as found:
        session.run()
    assert session.recording is found.value.recording is not None


def unrecordable(bench: Bench) -> None:
    """Let the drive give a current that no recording takes."""
    read = bench.drive.read
    bench.drive.read = lambda timeout: replace(  # type: ignore[method-assign]
        read(timeout), current=math.inf
    )


def test_a_bug_is_raised_though_there_is_no_recording() -> None:
    bench = Bench()
    unrecordable(bench)
    bench.observer = late(broken, bench)
    session = bench.session()
    with pytest.raises(KeyError) as found:
        session.run()
    how, why = found.value.__notes__
    assert how.startswith("the session was stopped by error after ")
    assert why.startswith("the recording cannot be made: InputError: ")
    assert session.recording is None
    assert not bench.elmo.motor_on


def test_a_stop_is_raised_though_there_is_no_recording() -> None:
    bench = Bench()
    unrecordable(bench)

    def stops() -> None:
        raise DriveFaultError("bus", "gone")

    bench.observer = late(stops, bench)
    with pytest.raises(SessionStoppedError) as found:
        bench.run()
    assert (found.value.stop.limit, found.value.recording) == ("bus", None)
    assert found.value.__notes__[0].startswith("the recording cannot be made: ")


def test_a_completed_session_without_a_recording_is_a_stop() -> None:
    bench = Bench()
    unrecordable(bench)
    with pytest.raises(SessionStoppedError, match="the recording cannot be made") as found:
        bench.run()
    assert (found.value.stop.limit, found.value.stop.motor_off) == ("recording", True)


@pytest.mark.parametrize("name", ["connect", "problems", "read", "bus_load"])
def test_an_error_of_the_system_refuses_the_session(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    bench, gone = Bench(), BrokenPipeError(32, "Broken pipe")
    switched: list[None] = []

    def fails() -> None:
        raise gone

    before(monkeypatch, bench.drive, name, fails)
    before(monkeypatch, bench.drive, "disable", lambda: switched.append(None))
    with pytest.raises(
        SessionRefusedError, match=r"not started: BrokenPipeError: .*Broken pipe"
    ) as f:
        bench.run()
    assert f.value.__cause__ is gone
    assert switched
    assert not bench.elmo.motor_on


def test_an_error_of_the_system_while_the_motor_comes_on_is_a_stop(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bench = Bench()

    def fails() -> None:
        raise BrokenPipeError(32, "Broken pipe")

    before(monkeypatch, bench.drive, "enable", fails)
    with pytest.raises(SessionStoppedError, match="Broken pipe") as found:
        bench.run()
    assert (found.value.stop.phase, found.value.stop.motor_off) == ("enable", True)
