"""The long run keeps what was done, and notices what kills a batch."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from fuzz.__main__ import _Log, _tried

_TESTS = Path(__file__).resolve().parents[1]


def run(log: Path, cases: int) -> str:
    """Of one reader."""
    words = [str(log), "--cases", str(cases), "--first", "3", "--only", "candump"]
    done = subprocess.run(
        [sys.executable, "-m", "fuzz", *words],
        cwd=_TESTS,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout


@pytest.mark.slow
def test_a_run_goes_on_where_its_log_ends(tmp_path: Path) -> None:
    log = tmp_path / "fuzz.jsonl"
    assert "candump: 5 cases, 0 failures" in run(log, 5)
    assert "candump: 12 cases, 0 failures" in run(log, 12)
    lines = [json.loads(line) for line in log.read_text().splitlines()]
    assert [(line["start"], line["cases"]) for line in lines] == [(3, 5), (8, 7)]


def test_what_ends_a_process_is_a_failure_of_its_case() -> None:
    found = _tried("a reader that does not exist", 7, 10)
    assert (found["cases"], found["failures"]) == (1, 1)
    assert found["wrong"][0].startswith("case 7: ends the process (1)")
    assert "KeyError" in found["wrong"][0]


def test_what_a_batch_left_is_tried_after_it_and_the_quick_come_first(tmp_path: Path) -> None:
    log = _Log(tmp_path / "fuzz.jsonl", ["slow", "quick"], 20_000, 0)
    assert [log.next(), log.next()] == [("quick", 0, 5000), ("slow", 0, 5000)]
    found = {"cases": 5000, "failures": 0, "wrong": [], "seconds": 1.0}
    log.add("quick", 0, 5000, found)
    log.add("slow", 0, 5000, found | {"seconds": 9.0})
    assert log.next() == ("quick", 5000, 15_000)
    log.add("quick", 5000, 15_000, found | {"cases": 100, "failures": 1, "wrong": ["case 5099: x"]})
    assert log.next() == ("quick", 5100, 14_900)
    assert "quick: 5,100 cases, 1 failures" in log.report()
    assert "quick, case 5099: x" in log.report()
