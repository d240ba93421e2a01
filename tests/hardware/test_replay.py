"""A session's frame log, read again, gives the session's recording; what is missing is said."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import can
import numpy as np
import pytest
from session_bench import JOINT, PERIOD, devices, joint, law, limits, motion, session

import jointid as jid
from jointid.hardware import EmulatedBus, EmulatorThread, SessionStoppedError
from jointid.hardware.elmo import AnalogInput, ElmoOptions, EmulatedElmo
from jointid.hardware.elmo.recorded_options import elmo_options_of

CONVERTER = ElmoOptions()
ANALOG = ElmoOptions(torque=AnalogInput())
NO_SENSOR = ElmoOptions(torque=None)
COARSE = ElmoOptions(mantissa_bits=4)
WIRINGS = {"converter": CONVERTER, "analog": ANALOG, "none": NO_SENSOR, "coarse": COARSE}
ROUNDING = 1e-9  # [s] of a stamp in the log

_BEFORE_CYCLES = 2  # heartbeats of ours while the motor is switched on


def ran(path: Path, drive: ElmoOptions = CONVERTER, **more: Any) -> jid.Recording:
    """A session on an emulated drive, with its files."""
    emulated = devices(seed=1) if isinstance(drive.torque, type(CONVERTER.torque)) else None
    with EmulatedBus(*(emulated or (EmulatedElmo(joint(seed=1)),))) as bus:
        recording = session(bus, drive=drive, output=path, **more).run()
    assert recording is not None
    return recording


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], tuple[jid.Recording, Path]]:
    """Session and log of each wiring, run once."""
    folder, known = tmp_path_factory.mktemp("sessions"), dict[str, tuple[jid.Recording, Path]]()

    def get(name: str) -> tuple[jid.Recording, Path]:
        if name not in known:
            path = folder / f"{name}.csv"
            known[name] = ran(path, WIRINGS[name]), path.with_suffix(".log")
        return known[name]

    return get


def largest(again: jid.Recording, recording: jid.Recording, name: str) -> float:
    """Difference of a signal."""
    return float(np.abs(getattr(again, name) - getattr(recording, name)).max())


def same(again: jid.Recording, recording: jid.Recording, rounding: float = ROUNDING) -> None:
    """The same but for what the rounding of the stamps does."""
    assert again.signals == recording.signals
    assert again.torque_hold == "zoh"
    for name in ("position", "sensor", "current"):
        assert np.array_equal(getattr(again, name), getattr(recording, name)), name
    assert largest(again, recording, "time") <= 3.0 * rounding
    # A share of a cycle is wrong by twice the rounding, of the largest step between two commands.
    assert recording.torque is not None
    step = 2.0 * np.abs(recording.torque).max()
    assert largest(again, recording, "torque") <= 3.0 * rounding / PERIOD * step


@pytest.mark.parametrize("name", WIRINGS)
def test_a_log_gives_the_sessions_recording(
    made: Callable[[str], tuple[jid.Recording, Path]], name: str
) -> None:
    recording, log = made(name)
    again = jid.hardware.replay(log, JOINT, WIRINGS[name])
    same(again, recording)
    assert largest(again, recording, "reference") == 0.0
    assert again.metadata["replayed"] == log.name
    assert again.metadata["cycles_before"] == recording.metadata["cycles_before"] > 0


@pytest.mark.parametrize("name", WIRINGS)
def test_the_recording_knows_how_the_drive_was_wired(
    made: Callable[[str], tuple[jid.Recording, Path]], name: str
) -> None:
    recording, log = made(name)
    assert elmo_options_of(recording.metadata) == WIRINGS[name]
    same(jid.hardware.replay(log, JOINT), recording)
    other = {**recording.metadata, "drive_options": {"torque": None, "servo": 3}}
    with pytest.raises(jid.InputError, match=r"metadata: \[drive_options\]: servo: unknown key"):
        elmo_options_of(other)


def test_a_log_alone_is_enough(
    made: Callable[[str], tuple[jid.Recording, Path]], tmp_path: Path
) -> None:
    recording, log = made("converter")
    alone = tmp_path / log.name
    alone.write_bytes(log.read_bytes())
    with pytest.raises(
        jid.InputError, match="period is None: the session's period is not known; pass"
    ):
        jid.hardware.replay(alone, JOINT)
    before = recording.metadata["cycles_before"]
    with pytest.raises(jid.InputError, match="cycles_before is -1: 0 or more is expected"):
        jid.hardware.replay(alone, JOINT, period=PERIOD, cycles_before=-1)
    whole = jid.hardware.replay(alone, JOINT, period=PERIOD)
    assert len(whole.time) == before + len(recording.time)
    assert whole.reference is None
    again = jid.hardware.replay(
        alone, JOINT, period=PERIOD, cycles_before=before, trajectory=motion()
    )
    same(again, recording)
    assert largest(again, recording, "reference") <= 1e-8  # 3 ns of jitter


@pytest.mark.parametrize("ending", [".asc", ".blf"])
def test_logs_of_other_programs(
    made: Callable[[str], tuple[jid.Recording, Path]], tmp_path: Path, ending: str
) -> None:
    recording, log = made("converter")
    other = tmp_path / f"run{ending}"
    with can.LogReader(str(log)) as frames, can.Logger(str(other)) as written:
        for frame in frames:
            frame.channel = 0
            written(frame)
    again = jid.hardware.replay(other, JOINT, recording=log.with_suffix(".csv"))
    same(again, recording, rounding=1e-6)  # what these formats keep of a stamp


def test_other_options_give_another_recording(
    made: Callable[[str], tuple[jid.Recording, Path]],
) -> None:
    recording, log = made("converter")
    again = jid.hardware.replay(log, JOINT, replace(CONVERTER, position_offset=0.25))
    assert np.allclose(again.position, recording.position + 0.25, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("counted", [-1, 1, 7])
def test_a_run_that_begins_elsewhere_than_counted_is_found_by_its_positions(
    made: Callable[[str], tuple[jid.Recording, Path]], tmp_path: Path, counted: int
) -> None:
    recording, log = made("converter")
    right = recording.metadata["cycles_before"]
    before, other = right + counted, tmp_path / "run.csv"
    rows = log.with_suffix(".csv").read_text(encoding="utf-8")
    other.write_text(
        rows.replace(f'"cycles_before": {right}', f'"cycles_before": {before}'), encoding="utf-8"
    )
    same(jid.hardware.replay(log, JOINT, recording=other), recording)
    moved = replace(CONVERTER, position_offset=0.25, counts_per_turn=4000)
    again = jid.hardware.replay(log, JOINT, moved, recording=other)
    assert np.allclose(again.position, 2.0 * recording.position + 0.25, rtol=0.0, atol=1e-12)


def test_a_log_of_another_session_is_refused(
    made: Callable[[str], tuple[jid.Recording, Path]],
) -> None:
    recording, log = made("converter")
    position = recording.position.copy()
    position[40] += 1e-4
    other = recording.with_signals(position=position)
    with pytest.raises(
        jid.InputError,
        match=r"row 40 has the position .* rad, but the frames .*; state cycles_before=\d+ to use",
    ):
        jid.hardware.replay(log, JOINT, recording=other)
    again = jid.hardware.replay(
        log, JOINT, recording=other, cycles_before=recording.metadata["cycles_before"]
    )
    assert np.array_equal(again.position, recording.position)


def test_a_truncated_log_and_recording_give_their_beginning(
    made: Callable[[str], tuple[jid.Recording, Path]], tmp_path: Path
) -> None:
    recording, log = made("converter")
    torn = tmp_path / "run.log"
    torn.write_bytes(log.read_bytes()[:-20_000])
    rows = log.with_suffix(".csv").read_bytes()
    torn.with_suffix(".csv").write_bytes(rows[: len(rows) // 2])
    begun = jid.load(torn.with_suffix(".csv"))
    again = jid.hardware.replay(torn, JOINT)
    assert len(again.time) == len(begun.time) < len(recording.time)
    assert largest(again, begun, "position") == 0.0
    # The frames know more than the rows, and the trajectory the reference.
    longer = jid.hardware.replay(torn, JOINT, trajectory=motion())
    assert len(begun.time) < len(longer.time) < len(recording.time)
    assert np.array_equal(longer.position, recording.position[: len(longer.time)])


def test_a_session_that_was_stopped(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"

    def refuse(phase: str, time: float, *_: object) -> None:
        if phase == "run" and time > 0.5:
            raise OSError("enough")

    with pytest.raises(SessionStoppedError) as caught:
        ran(path, observer=refuse)
    recording = caught.value.recording
    assert recording is not None
    same(jid.hardware.replay(path.with_suffix(".log"), JOINT), recording)


def test_a_session_in_real_time(tmp_path: Path) -> None:
    # Here the SYNC's sending tells when a sample was taken, and the end of a command lies a little
    # behind its heartbeat's stamp: the torque's mean over the cycle differs by as much.
    path, period = tmp_path / "run.csv", 10e-3
    drive = ElmoOptions(heartbeat=10.0)
    with (
        can.Bus("replay", interface="virtual") as host,
        can.Bus("replay", interface="virtual") as there,
        EmulatorThread(there, *devices(period=period)),
    ):
        recording = session(
            host,
            period=period,
            answer_timeout=5.0,
            drive=drive,
            limits=limits(
                missed_deadlines=10**6,
                saturated_samples=10**6,
                late_samples=10**6,
                late_share=1.0,
                watchdog_travel=1e6,
            ),
            law=law().replace(bandwidth=15.0, robust_term=False),
            output=path,
        ).run()
    assert recording is not None
    assert recording.metadata["drive"]["stamped_frames"] is False
    again = jid.hardware.replay(path.with_suffix(".log"), JOINT, drive)
    assert largest(again, recording, "position") == largest(again, recording, "sensor") == 0.0
    assert largest(again, recording, "time") <= 3.0 * ROUNDING
    assert again.torque is not None
    assert recording.torque is not None
    assert np.median(np.abs(again.torque - recording.torque)) <= 1e-2 * np.ptp(recording.torque)


@pytest.mark.parametrize(
    ("identifier", "sentence"),
    [
        ("080", "the SYNC before the host's heartbeat at"),
        ("4FF", "the position that answers the SYNC at"),
        ("1C0", "the torque sensor's reading that answers the SYNC at"),
        ("37F", "the command that follows the SYNC at"),
        ("701", "the host's heartbeat that follows the SYNC at"),
    ],
)
def test_a_missing_frame_is_named(
    made: Callable[[str], tuple[jid.Recording, Path]],
    tmp_path: Path,
    identifier: str,
    sentence: str,
) -> None:
    recording, log = made("converter")
    cycle = recording.metadata["cycles_before"] + 101
    lines = log.read_text().splitlines(keepends=True)
    ends = [k for k, line in enumerate(lines) if " 701#" in line]
    first, last = (ends[_BEFORE_CYCLES + cycle - k] + 1 for k in (2, 1))
    (missing,) = [k for k in range(first, last) if f" {identifier}#" in lines[k]]
    lacking = tmp_path / "run.log"
    lacking.write_text("".join(lines[:missing] + lines[missing + 1 :]))
    with pytest.raises(jid.InputError) as caught:
        jid.hardware.replay(lacking, JOINT, recording=recording)
    wording = str(caught.value)
    assert re.fullmatch(
        rf"\S+run\.log: {sentence} [\d.]+ s is missing, in cycle {cycle}; frames are missing from the log",
        wording,
    ), wording


def test_a_sample_that_came_early_is_refused(
    made: Callable[[str], tuple[jid.Recording, Path]],
) -> None:
    recording, log = made("converter")
    late = np.zeros(len(recording.time))
    late[40] = -1.0
    with pytest.raises(jid.InputError, match="late is -1 in row 40 of the recording; 0 or more"):
        jid.hardware.replay(log, JOINT, recording=recording.with_signals(late=late))


def test_missing_cycles_are_counted(
    made: Callable[[str], tuple[jid.Recording, Path]], tmp_path: Path
) -> None:
    recording, log = made("converter")
    lines = log.read_text().splitlines(keepends=True)
    ends = [k for k, line in enumerate(lines) if " 701#" in line]
    lacking = tmp_path / "run.log"
    lacking.write_text("".join(lines[: ends[300] + 1] + lines[ends[303] + 1 :]))
    rows = len(recording.time)
    with pytest.raises(
        jid.InputError, match=f"{rows - 3} cycles of the run, but the recording has {rows}; frames"
    ):
        jid.hardware.replay(lacking, JOINT, recording=recording)


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("run.txt", "", r"run\.txt: .*a frame log must end in \.log, \.asc, \.blf"),
        (
            "run.log",
            "(1.0) can0 080# T\nnonsense\n",
            r"run\.log: the data after frame 1 do not form a frame",
        ),
        (
            "run.log",
            "",
            r"run\.log: the log has 0 cycles after the first 0; at least 8 are expected",
        ),
        ("run.asc", None, r"run\.asc: there is no such file"),
    ],
)
def test_what_is_no_log_is_refused(
    tmp_path: Path, name: str, content: str | None, sentence: str
) -> None:
    if content is not None:
        (tmp_path / name).write_text(content)
    with pytest.raises(jid.InputError, match=sentence):
        jid.hardware.replay(tmp_path / name, JOINT, period=PERIOD)
