"""Late, lost and skipped cycles: the session goes on, the recording says so, identification leaves them out."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from session_bench import JOINT, PERIOD, devices, law, limits, session

import jointid as jid
from jointid import _core
from jointid.hardware import EmulatedBus, SessionStoppedError
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.session.cycle import capped
from jointid.hardware.session.drive import DriveSample
from jointid.hardware.session.lateness import Lateness
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.session import Session, SessionOptions
from jointid.hardware.session.stop import LimitError

FRAMES = (0x4FF, 0x1C0, 0x080, 0x37F, 0x701, 0x2FF)
BEGIN = 1.0  # [s] on the bus's clock: in the run


def fault(kind: str, identifier: int, begin: float = BEGIN, cycles: float = 1.0) -> BusFault:
    """Frames of some cycles are lost, or come 1.5 ms late."""
    return BusFault(
        kind=kind,
        identifier=identifier,
        start=begin,
        stop=begin + cycles * PERIOD,
        delay=1.5e-3,
    )


def disturbed(seed: int, duration: float) -> tuple[BusFault, ...]:
    """Of the cycles .3 % have a late frame, .1 % a lost one."""
    drawn = np.random.default_rng(seed)
    faults = []
    for cycle in range(round(duration / PERIOD)):
        chance = drawn.random()
        if chance < 0.004:
            kind = "delay" if chance < 0.003 else "drop"
            faults.append(fault(kind, int(drawn.choice(FRAMES)), BEGIN + cycle * PERIOD))
    return tuple(faults)


def long_run(duration: float, *faults: BusFault) -> jid.Recording:
    """Six seconds, or several times that."""
    motion = jid.Trajectory.thesis(math.radians(60.0), cycle=6.0, duration=duration)
    with EmulatedBus(*devices(seed=0), faults=faults) as bus:
        drive = ElmoDrive(bus, JOINT)
        recording = Session(
            drive, law(), motion, limits(), options=SessionOptions(settle=0.05)
        ).run()
    assert recording is not None
    return recording


def short_run(*faults: BusFault, output: Path | None = None, **more: Any) -> jid.Recording:
    """A second."""
    with EmulatedBus(*devices(seed=1), faults=faults) as bus:
        recording = session(bus, output=output, **more).run()
    assert recording is not None
    return recording


@pytest.mark.parametrize("duration", [6.0, pytest.param(12.0, marks=pytest.mark.slow)])
def test_late_and_lost_frames_do_not_change_the_estimates(duration: float) -> None:
    undisturbed = long_run(duration)
    recording = long_run(duration, *disturbed(0, duration + 2.0))
    assert recording.late is not None
    assert undisturbed.late is None
    expected, found = (jid.identify(r, JOINT, search="separable") for r in (undisturbed, recording))
    for name, parameter in expected.parameters.items():
        if parameter.stderr is None:
            continue  # it is given
        allowed = max(0.01 * abs(parameter.value), 2.0 * parameter.stderr)
        assert abs(found.parameters[name].value - parameter.value) <= allowed, name
    (late,) = (each for each in found.findings if each.code == "late_samples")
    assert late.evidence["left_out"].value == len(recording.doubtful) > 10
    cycles = round(duration / PERIOD) - 1
    assert late.evidence["missing_cycles"].value == cycles - (len(recording) - 1)
    assert "late_samples" not in {each.code for each in expected.findings}


def test_a_lost_sample_is_missing_and_the_torque_is_held() -> None:
    plain, recording = short_run(), short_run(fault("drop", 0x4FF))
    timing = recording.metadata["timing"]
    assert (timing["lost"], timing["skipped"], timing["most_in_row"]) == (2, 0, 2)
    assert recording.late is not None
    (row,) = np.flatnonzero(recording.late)
    assert recording.late[row] == 3.0  # two lost; the one behind them is not recorded
    assert list(recording.doubtful) == [row - 1]
    assert len(recording) == len(plain) - 3
    assert recording.time[row] - recording.time[row - 1] == pytest.approx(4 * PERIOD)
    # It goes on in time: the reference of each row is that of its instant.
    assert recording.reference is not None
    assert plain.reference is not None
    assert np.allclose(recording.reference[row:], plain.reference[row + 3 :], rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("kind", ["drop", "delay"])
def test_a_command_that_is_not_confirmed_is_marked(kind: str) -> None:
    recording = short_run(fault(kind, 0x37F))
    assert recording.late is not None
    marked = np.flatnonzero(recording.late)
    assert recording.late[marked].tolist() == [0.5, 0.5]  # its cycle, and the beginning of the next
    assert marked[1] == marked[0] + 1
    assert recording.metadata["timing"]["lost"] == 0


def test_left_out_intervals_are_unusable_for_the_core() -> None:
    recording = short_run(fault("drop", 0x4FF))
    flags = _usable(recording, list(recording.doubtful))
    plain = _usable(recording, [])
    assert np.flatnonzero(plain != flags).tolist() == list(recording.doubtful)
    with pytest.raises(ValueError, match="doubtful must lie inside"):
        _usable(recording, [len(recording) - 1])


def _usable(recording: jid.Recording, doubtful: list[int]) -> Any:
    assert recording.torque is not None
    core = _core.Recording(
        time=recording.time,
        position=recording.position,
        velocity=recording.velocity,
        torque=recording.torque,
        sensor=None,
        torque_hold=_core.Hold.zero_order,
        gap_after=[],
        doubtful=doubtful,
    )
    return np.asarray(_core.usable_intervals(core))


def test_cycles_that_are_over_are_skipped(tmp_path: Path) -> None:
    bus = EmulatedBus(*devices(seed=1))
    stalled = False

    def stall(phase: str, time: float, *_: object) -> None:
        nonlocal stalled
        if phase == "run" and time > 0.5 and not stalled:
            stalled = True
            bus.sleep_until(bus.now() + 3.3 * PERIOD)

    with bus:
        recording = session(bus, observer=stall, output=tmp_path / "run.csv").run()
    plain = short_run()
    assert recording is not None
    assert recording.late is not None
    (row,) = np.flatnonzero(recording.late >= 1.0)
    assert recording.late[row] == 2.0
    assert recording.metadata["timing"]["skipped"] == 2
    assert len(recording) == len(plain) - 2
    assert recording.reference is not None
    assert plain.reference is not None
    # The first sample is late by a part of a period; no reference is further ahead of its cycle.
    late = recording.time[row] - plain.time[row + 2]
    assert 0.0 < late < PERIOD
    step = abs(plain.reference[row + 3] - plain.reference[row + 2])
    assert abs(recording.reference[row] - plain.reference[row + 2]) <= 1.01 * step
    # The next SYNC waits for our late heartbeat.
    assert abs(recording.reference[row + 1] - plain.reference[row + 3]) <= 0.05 * step
    assert np.allclose(recording.reference[row + 2 :], plain.reference[row + 4 :], atol=1e-9)
    again = jid.hardware.replay(tmp_path / "run.log", JOINT)
    assert again.late is not None
    assert np.array_equal(again.late, recording.late)
    assert np.array_equal(again.position, recording.position)
    assert np.abs(again.time - recording.time).max() <= 3e-9


def test_a_late_reading_does_not_run_the_reference_ahead() -> None:
    plain = short_run()
    with EmulatedBus(*devices(seed=1)) as bus:
        run = session(bus)
        drive, stalled = run._drive, False
        read = drive.read

        def slow(timeout: float) -> DriveSample:
            nonlocal stalled
            if bus.now() > BEGIN and not stalled:
                stalled = True
                bus.sleep_until(bus.now() + 2.4 * PERIOD)
            return read(timeout)

        drive.read = slow  # type: ignore[method-assign]
        recording = run.run()
    assert recording is not None
    assert recording.reference is not None
    assert plain.reference is not None
    (row,) = np.flatnonzero(recording.time - plain.time[: len(recording)] > 2.0 * PERIOD)[:1]
    assert recording.time[row] - plain.time[row] == pytest.approx(2.4 * PERIOD, rel=0.1)
    step = abs(plain.reference[row + 1] - plain.reference[row])
    assert abs(recording.reference[row] - plain.reference[row]) <= 1.02 * step


def test_a_reference_is_never_further_ahead_than_a_period() -> None:
    assert capped(0.7e-3, PERIOD) == 0.7e-3
    assert capped(0.05, PERIOD) == PERIOD
    assert capped(-0.05, PERIOD) == -PERIOD
    assert np.array_equal(capped(np.array([-1.0, 1e-3, 1.0]), PERIOD), [-PERIOD, 1e-3, PERIOD])


def test_files_keep_what_was_late(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    recording = short_run(fault("drop", 0x4FF), fault("drop", 0x37F, 1.2), output=path)
    kept = jid.load(path)
    assert kept.late is not None
    assert recording.late is not None
    assert np.array_equal(kept.late, recording.late)
    assert len(kept.doubtful) == 3
    again = jid.hardware.replay(path.with_suffix(".log"), JOINT)
    assert again.signals == recording.signals
    for name in ("position", "sensor", "current", "late"):
        assert np.array_equal(getattr(again, name), getattr(recording, name)), name
    assert again.torque is not None
    assert recording.torque is not None
    assert np.abs(again.torque - recording.torque).max() <= 1e-3
    for ending in (".npz", ".csv.gz"):
        kept.save(tmp_path / f"copy{ending}")
        assert jid.load(tmp_path / f"copy{ending}") == kept
    assert len(kept.crop(0.2, 0.4).doubtful) <= 3


def test_a_foreign_column_of_this_name_is_none_of_ours(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = [f"{0.01 * k},{0.02 * k},1.0,yes" for k in range(10)]
    path.write_text("\n".join(["time_s,position_rad,torque_Nm,late", *rows, ""]))
    assert jid.load(path).late is None


def test_a_run_in_which_nothing_was_late_has_no_such_signal(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    assert short_run(output=path).late is None
    assert "late_cycles" in path.read_text().splitlines()[1]
    assert "late" not in jid.load(path).signals


def test_the_sample_that_ends_a_session_is_its_last_row(tmp_path: Path) -> None:
    elmo, converter = devices(seed=1)
    path = tmp_path / "run.csv"
    with EmulatedBus(elmo, converter) as bus:
        bus.at(BEGIN, lambda: setattr(elmo, "slipped_counts", 4000))
        with pytest.raises(SessionStoppedError) as caught:
            session(bus, output=path, limits=limits(tracking_error=0.02, velocity=1e3)).run()
    stop = caught.value.stop
    assert stop.limit == "tracking_error"
    kept = jid.load(path)
    assert kept.reference is not None
    error = kept.position - kept.reference
    assert abs(error[-1]) > 0.02 >= np.abs(error[:-1]).max()
    assert error[-1] == pytest.approx(stop.measured)
    again = jid.hardware.replay(path.with_suffix(".log"), JOINT)
    assert np.array_equal(again.position, kept.position)


def lateness(**changes: Any) -> Lateness:
    """At 2 ms: 2500 cycles in 5 s."""
    return Lateness(SessionLimits(**changes), PERIOD)


def test_some_in_a_row_are_allowed_and_no_more() -> None:
    watched = lateness(late_samples=3)
    for _ in range(2):
        for _ in range(3):
            watched.late("why")
        watched.on_time()
    assert (watched.lost, watched.most_in_row) == (6, 3)
    for _ in range(3):
        watched.late("why")
    with pytest.raises(LimitError, match=r"4 cycles in a row .*, more than 3: why") as stopped:
        watched.late("why")
    assert stopped.value.limit == "late_samples"


def test_a_share_of_the_last_five_seconds_is_allowed() -> None:
    watched = lateness()  # 25 of 2500
    for _ in range(3):
        for _ in range(25):
            watched.late("why")
            watched.on_time()
        for _ in range(2500):
            watched.on_time()
    for _ in range(25):
        watched.late("why")
        watched.on_time()
    with pytest.raises(LimitError, match=r"26 cycles of the last 5 s .* more than 25") as stopped:
        watched.skip(1, 0.003)
    assert stopped.value.limit == "late_share"


def test_at_a_long_period_as_many_as_in_a_row_are_no_excess() -> None:
    watched = Lateness(SessionLimits(late_samples=3), 0.03)  # 1 % is 1.7 samples
    for _ in range(3):
        watched.late("why")
        watched.on_time()
    with pytest.raises(LimitError) as stopped:
        watched.late("why")
    assert stopped.value.limit == "late_share"


def test_a_loop_that_stands_still_beyond_the_end_has_not_done_its_motion() -> None:
    """The drive has stopped by itself meanwhile: that is not the end of the motion."""
    with EmulatedBus(*devices()) as bus:

        def stand_still(phase: str, time: float, *_: object) -> None:
            if phase == "run" and 0.9 <= time < 0.9 + PERIOD:
                bus.sleep_until(bus.now() + 0.3)

        with pytest.raises(SessionStoppedError) as stopped:
            session(bus, 1.0, observer=stand_still).run()
    assert stopped.value.stop.limit == "host_heartbeat_lost"


def test_cycles_that_are_skipped_at_the_end_count() -> None:
    with EmulatedBus(*devices()) as bus:

        def stand_still(phase: str, time: float, *_: object) -> None:
            if phase == "run" and 0.98 <= time < 0.98 + PERIOD:
                bus.sleep_until(bus.now() + 0.03)

        with pytest.raises(SessionStoppedError, match=r"skipped 1[0-9] cycles") as stopped:
            session(bus, 1.0, observer=stand_still).run()
    assert stopped.value.stop.limit == "late_samples"
