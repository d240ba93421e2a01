"""`jointid identify --rollout` of a robot: values are worth more than their rollout."""

from __future__ import annotations

from pathlib import Path

import pytest
import small_arm

import jointid as jid
from jointid.cli.command_line import main

pytest.importorskip("pinocchio")


@pytest.mark.parametrize("factor", [1.0, 1e4])
def test_the_answer_comes_also_without_a_rollout(
    factor: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = small_arm.urdf(tmp_path)
    run = small_arm.recording(path, duration=3.0)
    assert run.torque is not None
    saved = tmp_path / "run.csv"
    jid.RobotRecording(**{**run.fields(), "torque": factor * run.torque}).save(saved)
    page = tmp_path / "arm.html"
    line = ["identify", str(saved), "--robot", str(path), "--rollout", "--report", str(page)]
    assert main([*line, "--quiet"]) == 0
    said = capsys.readouterr().out
    assert "shoulder  coulomb" in said
    assert ("no rollout: the simulation diverges" in said) == (factor > 1.0)
    assert ('id="rollouts"' in page.read_text("utf-8")) == (factor == 1.0)
