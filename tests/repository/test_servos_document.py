"""The code in docs/servos.md runs and finds what it simulates; its joint file is one."""

from pathlib import Path

import pytest
from documents import read, run_python_blocks

import jointid as jid
from jointid.identification.warnings.table import table_rows
from jointid.servo.finding_types import TYPES


def test_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run_python_blocks(read("docs/servos.md"), tmp_path, monkeypatch)
    estimate, truth = names["estimate"], names["truth"]
    assert estimate["torque_constant"] == pytest.approx(truth.torque_constant, rel=0.06)
    assert estimate["inertia"] == pytest.approx(truth.inertia, rel=0.05)
    assert estimate["load_friction"] == pytest.approx(0.15, rel=0.06)
    assert names["rolled"].median < 0.01


def test_its_joint_file_is_read(tmp_path: Path) -> None:
    text = read("docs/servos.md").split("```toml\n")[1].split("```")[0]
    path = tmp_path / "servo.toml"
    path.write_text(text, encoding="utf-8")
    joint = jid.Joint.load(path)
    assert joint.voltage is not None
    assert joint.voltage.position_loop is not None
    commented = text.replace("# resistance", "resistance").replace("# duty_scale", "duty_scale")
    path.write_text(commented, encoding="utf-8")
    assert jid.Joint.load(path).voltage is not None


def test_its_table_is_that_of_the_findings() -> None:
    assert table_rows(TYPES.values()) in read("docs/servos.md")
