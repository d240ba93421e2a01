"""A short `make soak` of sessions: nothing grows, nothing is lost; and growth or loss is reported."""

import sys
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))

from session_soak import Soaked, one_session, soak_sessions
from session_speed import own_times

import jointid as jid
from jointid.hardware.session.recorder import Recorder


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="counts in /proc")
@pytest.mark.parametrize(
    ("sessions", "seconds", "settle"),
    [(3, 1.0, 1), pytest.param(12, 3.0, 2, marks=pytest.mark.slow)],
)
def test_sessions_leave_nothing_behind_and_lose_nothing(
    sessions: int, seconds: float, settle: int
) -> None:
    soaked = soak_sessions(sessions * seconds / 60.0, seconds=seconds, settle=settle)
    assert soaked.sessions == sessions
    assert soaked.samples == sessions * seconds * 500
    assert soaked.sound, str(soaked)


SOUND: dict[str, Any] = {
    "sessions": 1,
    "samples": 1,
    "lost": 0,
    "grown": 1000,
    "threads": (2, 2),
    "files": (5, 5),
}


@pytest.mark.parametrize(
    "defect",
    [{"lost": 1}, {"grown": 30_000_000}, {"threads": (2, 3)}, {"files": (5, 6)}],
)
def test_each_kind_of_leak_is_a_defect(defect: dict[str, Any]) -> None:
    assert Soaked(**SOUND).sound
    assert not Soaked(**(SOUND | defect)).sound


def test_a_lost_sample_is_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    keep = Recorder.sample
    rows = 0

    def forgetful(recorder: Recorder, row: Any) -> None:
        nonlocal rows
        rows += 1
        if rows != 700:
            keep(recorder, row)

    monkeypatch.setattr(Recorder, "sample", forgetful)
    assert one_session(tmp_path / "run.csv", 3.0, seed=0) == (1500, 1)
    assert jid.load(tmp_path / "run.csv").time.size == 1499


def test_the_speed_benchmark_times_each_cycle() -> None:
    cycles = own_times(3.0)
    assert len(cycles) >= 1500
    assert min(cycles) > 0.0
