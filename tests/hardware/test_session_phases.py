"""What a session does when nothing goes wrong, and what it leaves alone."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

import jointid as jid
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput
from jointid.hardware.session.drive import DriveEnd, DriveFaultError
from jointid.hardware.session.session import SessionStoppedError

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))
from fault_cases import BEGIN, PERIOD, EmulatedSession


@pytest.mark.parametrize("source", [AnalogInput(every=4), None])
def test_session_with_another_sensor_runs(source: AnalogInput | None) -> None:
    bench = EmulatedSession(drive=ElmoOptions(torque=source))
    recording = bench.session().run()
    assert recording is not None
    assert recording.metadata["motor_off"] is True
    assert recording.reference is not None
    assert np.abs(recording.position - recording.reference).max() < 0.01
    assert (recording.sensor is None) is (source is None)
    if recording.sensor is not None:
        assert len(np.unique(recording.sensor)) > 200


def test_phases_follow_one_another() -> None:
    seen: list[str] = []
    bench = EmulatedSession()

    def watch(phase: str, *_: object) -> None:
        if phase not in seen[-1:]:
            seen.append(phase)

    bench.observer = watch
    bench.session().run()
    assert seen == ["move", "settle", "run"]


def test_open_loop_is_not_moved_to_a_start_it_does_not_have() -> None:
    seen = set()
    bench = EmulatedSession()
    bench.law = jid.OpenLoop()
    bench.trajectory = jid.Trajectory.sine(70.0, 1.0, duration=1.0)  # a torque [N·m]
    bench.observer = lambda phase, *_: seen.add(phase)
    recording = bench.session().run()
    assert seen == {"run"}
    assert recording is not None
    assert recording.torque is not None
    assert np.abs(recording.torque).max() == pytest.approx(70.0, rel=0.01)
    assert np.ptp(recording.position) > 0.01


def test_current_is_recorded_beside_the_command() -> None:
    bench = EmulatedSession()
    recording = bench.session().run()
    assert recording is not None
    assert recording.torque is not None
    assert recording.current is not None
    felt = recording.current * 0.198 * 101.0
    # It is reported at the SYNC, before the command of the same cycle; and in thousandths of 8 A.
    assert np.corrcoef(felt[1:], recording.torque[:-1])[0, 1] > 0.99


def test_drive_that_raises_while_switching_off_is_closed_all_the_same() -> None:
    bench = EmulatedSession()
    closed: list[None] = []
    close, disable = bench.drive.close, bench.drive.disable

    def fail() -> DriveEnd:
        disable()
        raise DriveFaultError("bus", "it went away")

    bench.drive.disable = fail  # type: ignore[method-assign]

    def close_too() -> None:
        closed.append(close())

    bench.drive.close = close_too  # type: ignore[method-assign]

    def watch(*_: object) -> None:
        if bench.bus.now() > BEGIN:
            raise OSError("enough")

    bench.observer = watch
    with pytest.raises(
        SessionStoppedError, match=r"enough.*it went away; THE DRIVE DID NOT CONFIRM"
    ) as found:
        bench.session().run()
    assert closed == [None]
    assert isinstance(found.value.__cause__, OSError)
    assert not bench.elmo.motor_on


def test_drive_that_raises_while_it_is_closed_hides_no_stop() -> None:
    bench = EmulatedSession()

    def fail() -> None:
        raise DriveFaultError("bus", "it went away")

    bench.drive.close = fail  # type: ignore[method-assign]
    bench.bus.at(BEGIN, lambda: bench.elmo.fail("encoder loss"))
    with pytest.raises(SessionStoppedError, match=r"feedback lost.*it went away") as found:
        bench.session().run()
    assert found.value.stop.limit == "drive_fault"
    assert found.value.stop.motor_off is True


def test_stop_on_the_way_to_the_start_has_no_recording() -> None:
    bench = EmulatedSession()
    bench.trajectory = jid.Trajectory.sine(0.3, 0.5, offset=0.5, duration=1.0)
    bench.bus.at(0.5, lambda: bench.elmo.fail("over-temperature"))
    with pytest.raises(SessionStoppedError) as found:
        bench.session().run()
    assert found.value.stop.phase == "move"
    assert found.value.recording is None
    assert found.value.stop.time <= 0.5 + PERIOD


def test_an_occasionally_late_host_is_tolerated() -> None:
    bench = EmulatedSession()
    for start in np.arange(0.8, 1.8, 0.1):
        bench.bus.at(start, lambda: setattr(bench.bus, "host_work", 0.9e-3))
        bench.bus.at(start + 1.5 * PERIOD, lambda: setattr(bench.bus, "host_work", 0.0))
    recording = bench.session().run()
    assert recording is not None
    timing = recording.metadata["timing"]
    assert timing["missed"] >= 10
    assert timing["slack_least"] < 0.0
    assert math.isclose(timing["slack_median"], 1.43e-3, rel_tol=0.1)


def test_recording_that_cannot_be_written_stops_the_session(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[str] = []

    def full(_: int) -> None:
        if seen.count("run") >= 2:  # enough for a recording, however slow the machine is
            raise OSError(28, "No space left on device")

    monkeypatch.setattr("jointid.hardware.session.appended_file.os.fsync", full)
    bench = EmulatedSession(output=tmp_path / "run.csv")
    bench.observer = lambda phase, *_: seen.append(phase)
    with pytest.raises(SessionStoppedError, match=r"written: .*No space left") as found:
        bench.session().run()
    assert found.value.stop.limit == "recording"
    assert found.value.stop.motor_off is True
    assert found.value.recording is not None
    assert not bench.elmo.motor_on
