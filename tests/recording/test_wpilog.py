"""WPILib's logs: entries with stamps of their own become one table, and SysId's tests its runs."""

import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from recording_files import refusal

import jointid as jid
from jointid.recording.readers.loading import load, load_runs

N = 300
PERIOD = 20_000  # us
ENTRIES = {
    1: ("position-elbow-arm", "double", "Rotation"),
    2: ("velocity-elbow-arm", "double", "Rotation per Second"),
    3: ("voltage-elbow-arm", "double", "Volt"),
    4: ("sysid-test-state-arm", "string", ""),
    5: ("/camera", "raw", ""),
}


def position(stamp: float) -> float:
    return 0.25 * float(np.sin(1e-6 * stamp))


def records(state: bool = True) -> Iterator[tuple[int, int, Any]]:
    """Entry, stamp and value of each record."""
    for k in range(N):
        stamp = 5_000_000 + k * PERIOD
        if state and k in (50, 120, 200, 260):
            yield 4, stamp, {50: "quasistatic-forward", 200: "dynamic-reverse"}.get(k, "none")
        yield 3, stamp + 4, 0.1 * k
        yield 1, stamp + 10, position(stamp + 10)
        yield 2, stamp + 40, 0.25 * float(np.cos(1e-6 * (stamp + 40)))
        yield 5, stamp, b""


class FakeReader:
    """What of WPILib's `DataLogReader` is used."""

    def __init__(self, path: str) -> None:
        self._content = Path(path).read_bytes()

    def isValid(self) -> bool:  # noqa: N802
        return self._content.startswith(b"WPILOG")

    def __iter__(self) -> Iterator[SimpleNamespace]:
        for entry, (name, kind, metadata) in ENTRIES.items():
            start = SimpleNamespace(entry=entry, name=name, type=kind, metadata=metadata)
            yield SimpleNamespace(isStart=lambda: True, getStartData=lambda start=start: start)
        for entry, stamp, value in records(state=b"state" in self._content):
            yield SimpleNamespace(
                isStart=lambda: False,
                isControl=lambda: False,
                getEntry=lambda entry=entry: entry,
                getTimestamp=lambda stamp=stamp: stamp,
                getDouble=lambda value=value: float(value),
                getString=lambda value=value: value,
            )


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> None:
    log = ModuleType("wpiutil.log")
    log.DataLogReader = FakeReader  # type: ignore[attr-defined]
    package = ModuleType("wpiutil")
    package.log = log  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "wpiutil", package)
    monkeypatch.setitem(sys.modules, "wpiutil.log", log)


def check(path: Path) -> None:
    """The two tests of `records`, at the stamps of the position."""
    slow, fast = load_runs(path, by="run")
    assert (len(slow), len(fast)) == (70, 60)
    stamps = 1e6 * slow.time + 5_000_010 + 50 * PERIOD
    turn = 2.0 * np.pi
    assert slow.position == pytest.approx([turn * position(each) for each in stamps])
    assert slow.velocity == pytest.approx(turn * 0.25 * np.cos(1e-6 * stamps), abs=1e-6)
    whole = load(path, columns={"torque": "elbow-arm.voltage [V]"}, scale={"torque": 1.0})
    assert len(whole.gaps) == 1
    assert whole.torque is not None
    assert whole.torque[0] == pytest.approx(5.0, abs=1e-4)


@pytest.mark.usefixtures("fake")
def test_entries_are_columns_and_tests_are_runs(tmp_path: Path) -> None:
    (tmp_path / "a.wpilog").write_bytes(b"WPILOG state")
    check(tmp_path / "a.wpilog")


@pytest.mark.usefixtures("fake")
def test_a_log_without_tests_is_read_whole(tmp_path: Path) -> None:
    (tmp_path / "a.wpilog").write_bytes(b"WPILOG")
    recording = load(tmp_path / "a.wpilog")
    assert len(recording) == N
    assert isinstance(recording, jid.Recording)


@pytest.mark.usefixtures("fake")
def test_another_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.wpilog").write_bytes(b"time,position")
    assert "not a .wpilog file" in refusal(tmp_path / "a.wpilog")


def test_the_package_is_named_where_it_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "wpiutil", None)
    (tmp_path / "a.wpilog").write_bytes(b"WPILOG")
    assert "pip install robotpy-wpiutil" in refusal(tmp_path / "a.wpilog")


def test_what_wpilib_writes_is_read(tmp_path: Path) -> None:
    wpiutil = pytest.importorskip("wpiutil")
    log = pytest.importorskip("wpiutil.log")
    path = tmp_path / "a.wpilog"
    writer = wpiutil.DataLogWriter(str(path))
    kinds = {"double": log.DoubleLogEntry, "string": log.StringLogEntry}
    entries = {
        number: kinds[kind](writer, name, metadata)
        for number, (name, kind, metadata) in ENTRIES.items()
        if kind in kinds
    }
    for entry, stamp, value in records():
        if entry in entries:
            entries[entry].append(value, stamp)
    writer.flush()
    check(path)
