"""What a session leaves on the disk: complete, in time, and when it is killed."""

from __future__ import annotations

import json
import os
import queue
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import can
import numpy as np
import pytest
from killed_session import DURATION
from session_bench import JOINT, devices, law, limits, motion, session

import jointid as jid
from jointid.hardware import EmulatedBus, SessionRefusedError, SessionStoppedError
from jointid.hardware.elmo import ElmoOptions
from jointid.hardware.session.appended_file import AppendedFile
from jointid.hardware.session.recorder import Recorder
from jointid.joint.joint_file import joint_document

CHILD = Path(__file__).parents[1] / "killed_session.py"
PATIENCE = 60.0  # [s] for what takes a fraction of one
# Of rows that may be missing, by their age when the program was killed: the recorder writes every 20 ms. This machine
# stands still for longer than what is promised now and then, hence ten times as much.
PROMISE = 0.05  # [s]
BOUND = 10.0 * PROMISE


def until(done: Callable[[], bool]) -> None:
    """Look again and again, but not for ever."""
    end = time.monotonic() + PATIENCE
    pause = threading.Event()
    while not done():
        assert time.monotonic() < end, "it does not happen"
        pause.wait(1e-3)


@pytest.fixture(scope="module")
def whole() -> jid.Recording:
    """The session that is killed, not killed."""
    with EmulatedBus(*devices(seed=5)) as bus:
        recording = session(bus, DURATION).run()
    assert recording is not None
    return recording


@pytest.mark.parametrize("rows", [20, pytest.param(150, marks=pytest.mark.slow), 500])
def test_a_killed_session_has_left_its_rows(
    tmp_path: Path, whole: jid.Recording, rows: int
) -> None:
    path = tmp_path / "run.csv"
    with subprocess.Popen([sys.executable, str(CHILD), str(path)], stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        until(lambda: path.exists() and path.read_bytes().count(b"\n") > rows + 3)
        child.kill()
        handed = [int(line.split()[1]) for line in child.stdout.read().splitlines()]
    left = jid.load(path)
    kept = len(left.time)
    assert kept >= rows
    missing = handed[kept:]
    assert not missing or handed[-1] - missing[0] <= 1e9 * BOUND
    assert left.metadata["truncated"] is True
    for name in ("time", "position", "torque", "sensor", "reference", "current"):
        assert np.array_equal(getattr(left, name), getattr(whole, name)[:kept]), name
    # The frames, to the last whole line.
    log = path.with_suffix(".log")
    log.write_bytes(log.read_bytes()[: log.read_bytes().rfind(b"\n") + 1])
    with can.LogReader(str(log)) as frames:
        assert sum(frame.arbitration_id == 0x80 for frame in frames) >= kept
    replayed = jid.hardware.replay(log, JOINT, trajectory=motion(DURATION))
    assert len(replayed.time) >= kept
    assert np.array_equal(replayed.position, whole.position[: len(replayed.time)])


def header(path: Path) -> dict[str, Any]:
    """What the first line says."""
    with path.open() as file:
        found: dict[str, Any] = json.loads(file.readline().partition("recording ")[2])
    return found


def test_a_recording_says_how_it_was_made(tmp_path: Path) -> None:
    before = datetime.now(UTC) - timedelta(seconds=1)
    path = tmp_path / "run.csv"
    wired = ElmoOptions(mantissa_bits=5)
    with EmulatedBus(*devices()) as bus:
        recording = session(bus, 1.0, output=path, drive=wired).run()
    assert recording is not None
    said = dict(jid.load(path).metadata)
    assert before <= datetime.fromisoformat(said.pop("started")) <= datetime.now(UTC)
    assert said == json.loads(json.dumps(dict(recording.metadata)))
    assert said["joint"] == joint_document(JOINT)
    assert said["controller"]["kind"] == "AdaptiveRobust"
    gains = said["controller"]["gains"]
    assert jid.AdaptiveRobust(**gains) == law()
    assert said["trajectory"]["form"] == motion(1.0).form
    assert said["trajectory"]["duration"] == 1.0
    assert said["limits"]["tracking_error"] == limits().tracking_error
    assert said["limits"]["torque_rate"] is None  # there is none
    assert said["options"]["settle"] == 0.05
    assert said["drive_options"]["mantissa_bits"] == 5
    assert said["drive_options"]["torque"]["source"] == "SyncedConverter"
    assert said["drive"]["product"].startswith("0x")
    assert said["versions"]["python"] == sys.version.split()[0]
    assert said["versions"]["numpy"] == np.__version__
    assert said["versions"]["python-can"] == can.__version__
    assert said["versions"]["jointid"] == jid.__version__


def test_a_slow_disk_does_not_delay_the_session(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stuck, released = threading.Event(), threading.Event()
    sync = AppendedFile.sync

    def slow(self: AppendedFile) -> None:
        if threading.current_thread().name == "recorder disk":
            stuck.set()
            assert released.wait(PATIENCE)
        sync(self)

    monkeypatch.setattr(AppendedFile, "sync", slow)
    path = tmp_path / "run.csv"
    recorder = Recorder(path, {})
    try:
        assert stuck.wait(PATIENCE)
        recorder.sample((0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 0.0))
        recorder.frame(0.25, 0x80, b"\x01", True)
        recorder.frame(0.5, 0x8001, b"\x02", False, fd=True, extended=True)
        lines = "(0.250000000) can0 080#01 T\n(0.500000000) can0 00008001##102 R\n"
        until(lambda: path.read_text().endswith("4.0,5.0,0.0\n"))
        until(lambda: path.with_suffix(".log").read_text() == lines)
    finally:
        released.set()
        recorder.close({"stop": None})
    assert path.read_text().endswith('# jointid session {"stop": null}\n')


def test_a_row_is_in_the_file_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is waited for is asked for, not measured: the machine stands still now and then."""
    waits: list[float | None] = []

    class Noting(queue.SimpleQueue[Any]):
        def get(self, block: bool = True, timeout: float | None = None) -> Any:
            waits.append(timeout)
            return super().get(block, timeout)

    monkeypatch.setattr(queue, "SimpleQueue", Noting)
    recorder = Recorder(tmp_path / "run.csv", {})
    try:
        for number in range(4):
            recorder.sample((1e-3 * number, 1.0, 2.0, 3.0, 4.0, 5.0, 0.0))
            until(lambda: recorder.path.read_text().count("4.0,5.0,0.0\n") == number + 1)  # noqa: B023
    finally:
        recorder.close()
    assert waits
    assert all(wait is not None and 0.0 < wait <= PROMISE for wait in waits)


def test_rows_reach_the_disk_while_the_session_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Less than a second of them may be lost with the power, most of which is left for a slow disk."""
    synced: list[Path] = []
    waits: list[float | None] = []
    sync, wait = AppendedFile.sync, threading.Event.wait

    def watched(self: AppendedFile) -> None:
        sync(self)
        if threading.current_thread().name == "recorder disk":
            synced.append(self.path)

    def noted(self: threading.Event, timeout: float | None = None) -> bool:
        if threading.current_thread().name == "recorder disk":
            waits.append(timeout)
        return wait(self, timeout)

    monkeypatch.setattr(AppendedFile, "sync", watched)
    monkeypatch.setattr(threading.Event, "wait", noted)
    recorder = Recorder(tmp_path / "run.csv", {})
    try:
        until(lambda: all(synced.count(path) > 1 for path in (recorder.path, recorder.log)))
    finally:
        recorder.close()
    assert all(each is not None and 0.0 < each < 0.5 for each in waits)
    assert len(waits) >= 2


def test_files_and_folder_are_on_the_disk_before_the_motor_is_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    synced: list[int] = []
    fsync = os.fsync

    def watched(descriptor: int) -> None:
        synced.append(os.fstat(descriptor).st_ino)
        fsync(descriptor)

    monkeypatch.setattr("jointid.hardware.session.appended_file.os.fsync", watched)
    path = tmp_path / "run.csv"
    recorder = Recorder(path, {})
    files = [path.stat().st_ino, path.with_suffix(".log").stat().st_ino]
    assert synced[:3] == [*files, tmp_path.stat().st_ino]
    recorder.close()
    assert set(synced[-2:]) == set(files)


needs_full = pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")


@pytest.fixture
def full() -> Iterator[int]:
    """A disk that is full."""
    descriptor = os.open("/dev/full", os.O_WRONLY)
    yield descriptor
    os.close(descriptor)


@pytest.mark.parametrize(
    ("name", "there", "said"),
    [
        ("run.txt", None, "a session writes .csv"),
        ("none/run.csv", None, "the folder of this file does not exist"),
        ("run.csv", "run.csv", "a session does not overwrite files"),
        ("run.csv", "run.log", "a session does not overwrite files"),
    ],
)
def test_a_name_that_cannot_be_used_is_refused(
    name: str, there: str | None, said: str, tmp_path: Path
) -> None:
    if there is not None:
        (tmp_path / there).write_text("mine")
    with pytest.raises(jid.InputError, match=said):
        Recorder(tmp_path / name, {})
    left = [each.name for each in tmp_path.iterdir()]
    assert left == ([] if there is None else [there])


@needs_full
def test_a_disk_that_is_full_refuses_the_start(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, full: int
) -> None:
    made = AppendedFile.__init__

    def onto_full(self: AppendedFile, path: Path) -> None:
        made(self, path)
        os.dup2(full, self.descriptor)

    monkeypatch.setattr(AppendedFile, "__init__", onto_full)
    emulated = devices()
    with (
        EmulatedBus(*emulated) as bus,
        pytest.raises(
            SessionRefusedError,
            match=r"^not started: the recording cannot be written: No space left on device$",
        ),
    ):
        session(bus, output=tmp_path / "run.csv").run()
    assert not emulated[0].motor_on
    assert not emulated[0].switchings
    assert not list(tmp_path.iterdir())


@needs_full
@pytest.mark.parametrize("ending", [".csv", ".log"])
def test_a_disk_that_fills_up_is_one_stop(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, full: int, ending: str
) -> None:
    made = AppendedFile.__init__
    files: dict[str, int] = {}

    def noted(self: AppendedFile, path: Path) -> None:
        made(self, path)
        files[path.suffix] = self.descriptor

    monkeypatch.setattr(AppendedFile, "__init__", noted)
    # Linux's full device takes no sync either, and says so in other words: writing is to meet it first.
    monkeypatch.setattr("jointid.hardware.session.recorder._SYNC", PATIENCE)

    cycles = 0

    def fill(phase: str, *_: object) -> None:
        nonlocal cycles
        cycles += phase == "run"
        # A row may be written at once: with the first cycle there would be too few samples to keep.
        if cycles > 50 and ending in files:
            os.dup2(full, files.pop(ending))

    emulated, path = devices(), tmp_path / "run.csv"
    with EmulatedBus(*emulated) as bus, pytest.raises(SessionStoppedError) as caught:
        session(bus, 4.0, output=path, observer=fill).run()
    stop = caught.value.stop
    assert stop.limit == "recording"
    assert stop.message == "the recording cannot be written: No space left on device"
    assert stop.motor_off is True
    assert not emulated[0].motor_on
    assert caught.value.recording is not None


def test_a_session_that_never_ran_says_so(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"

    def refuse(phase: str, *_: object) -> None:
        if phase == "settle":
            raise OSError("enough")

    with EmulatedBus(*devices()) as bus, pytest.raises(SessionStoppedError):
        session(bus, output=path, observer=refuse).run()
    with pytest.raises(
        jid.InputError, match=r"run\.csv: the session ended before its first sample: .*enough"
    ):
        jid.load(path)
    content = path.read_bytes()
    path.write_bytes(content[: content.rfind(b"# jointid session")])
    with pytest.raises(
        jid.InputError,
        match=r"before its first sample; the program was killed, or the power failed$",
    ):
        jid.load(path)


def test_a_drive_that_does_not_tell_its_current(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    recorder = Recorder(path, {})
    for k in range(10):
        recorder.sample((0.1 * k, 0.2 * k, 1.0, 2.0, 0.0, float("nan"), 0.0))
    recorder.close({"stop": None})
    loaded = jid.load(path)
    assert loaded.current is None
    assert "current" not in loaded.signals
    assert np.array_equal(loaded.position, [0.2 * k for k in range(10)])
    text = path.read_text().replace("2.0,0.0,nan", "nan,0.0,nan", 1)
    path.write_text(text)
    with pytest.raises(jid.InputError, match="sensor"):
        jid.load(path)
