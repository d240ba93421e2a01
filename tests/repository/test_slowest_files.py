"""What CI says of its time, and the order in which files of tests start."""

from pathlib import Path

import pytest
from slowest_files import FIRST, PHASES, phases, place_of, slowest_files


def test_the_files_that_start_first_exist(repo: Path) -> None:
    tests = repo / "tests"
    assert [name for name in FIRST if not (tests / name).is_file()] == []
    starts = [place_of(tests / name, tests) for name in (*FIRST, "joint/test_joint.py")]
    assert starts == list(range(len(FIRST) + 1))
    assert place_of(repo.parent / "elsewhere.py", tests) == len(FIRST)


def test_seconds_are_added_by_file() -> None:
    parts = [("a.py::one", 1.0), ("b.py::one[x::y]", 2.0), ("a.py::two", 3.0), ("c.py::one", 0.4)]
    assert slowest_files(parts, count=2) == ["     4 s  a.py", "     2 s  b.py"]


def test_phases_are_those_that_ci_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(PHASES, raising=False)
    assert phases() == []
    kept = tmp_path / "phases.txt"
    kept.write_text("    12 s  tools\n", encoding="utf-8")
    monkeypatch.setenv(PHASES, str(kept))
    assert phases() == ["    12 s  tools"]
