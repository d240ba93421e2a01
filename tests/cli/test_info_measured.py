"""`jointid info` says what the signals show of themselves: resolution, scatter, rest, late velocity, units."""

import json
from pathlib import Path

import numpy as np
import pytest

from jointid.cli.command_line import main

PERIOD = 0.002


def written(path: Path, *, late: float = 0.0, jitter: float = 0.0, turns: float = 1.0) -> Path:
    """A log of a joint that moves for four seconds and rests for one, its position in steps of a milliradian."""
    time = np.arange(2500) * PERIOD
    taken = time + jitter * np.random.default_rng(1).normal(size=len(time)) * PERIOD
    moving = np.clip(taken, 0.0, 4.0)
    position = np.round(np.sin(np.pi * moving) * turns, 3)
    velocity = np.pi * np.cos(np.pi * np.clip(taken - late, 0.0, 4.0)) * turns
    velocity[(taken - late < 0.0) | (taken - late > 4.0)] = 0.0
    rows = np.column_stack([time, position, velocity, np.sign(velocity) * 3.0 + velocity])
    np.savetxt(
        path, rows, delimiter=",", header="time,position,velocity,torque", comments="", fmt="%.9g"
    )
    return path


def told(path: Path, capsys: pytest.CaptureFixture[str]) -> dict[str, object]:
    assert main(["info", str(path), "--json"]) == 0
    found: dict[str, object] = json.loads(capsys.readouterr().out)
    return found


def test_facts_that_nobody_stated_are_measured(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = told(written(tmp_path / "log.csv", late=0.005), capsys)
    signals = found["signals"]
    assert isinstance(signals, dict)
    assert signals["position"]["smallest step"] == pytest.approx(1e-3)
    assert found["slower than 1 % of the peak speed [%]"] == pytest.approx(20.0, abs=2.0)
    assert found["position's rate over the velocity"] == pytest.approx(1.0, abs=0.01)
    assert found["velocity later than the position by [s]"] == pytest.approx(0.005, abs=5e-4)


def test_stamps_that_scatter_show(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    even = told(written(tmp_path / "even.csv"), capsys)["stamps scatter by [s]"]
    shaken = told(written(tmp_path / "shaken.csv", jitter=0.5), capsys)["stamps scatter by [s]"]
    assert isinstance(even, float)
    assert isinstance(shaken, float)
    assert even < 0.1 * PERIOD
    assert shaken == pytest.approx(0.5 * PERIOD, rel=0.5)


def test_a_unit_in_doubt_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", str(written(tmp_path / "log.csv", turns=60.0))]) == 0
    printed = capsys.readouterr().out
    assert "units in doubt: position in deg" in printed
    assert "smallest step" in printed
