"""The code in docs/robots.md runs, and its facts are what a robot takes."""

from pathlib import Path

import pytest
from documents import blocks, read, run_python_blocks

import jointid as jid
from jointid.identification.warnings.table import table_rows
from jointid.robot.links.facts import read_facts
from jointid.robot.result.finding_types import TYPES

pytest.importorskip("pinocchio")


def test_the_page_on_robots_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run_python_blocks(read("docs/robots.md"), tmp_path, monkeypatch)
    assert names["coulomb"].value == pytest.approx(4.0, rel=0.02)
    assert 'friction="' in (tmp_path / "arm_with_friction.urdf").read_text(encoding="utf-8")


def test_its_facts_are_read(shared_data: Path, tmp_path: Path) -> None:
    (text,) = blocks(read("docs/robots.md"), "toml")
    path = tmp_path / "robot.toml"
    path.write_text(text, encoding="utf-8")
    assert read_facts(path)["zero_offsets"][1] == pytest.approx(-1.5707963)
    robot = jid.Robot.from_urdf(shared_data / "tx40" / "tx40.urdf", facts=path)
    assert robot.couplings[5].tolist() == [0.0, 0.0, 0.0, 0.0, 1.0, 1.0]
    assert robot.rotor_inertias == (None,) * 6


def test_its_table_is_that_of_the_findings() -> None:
    assert table_rows(TYPES.values()) in read("docs/robots.md")
