"""The command `export`: what it writes and says, and which estimates it refuses."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import pytest
from exported_joints import LOADED, THESIS, shipped_estimate

import jointid as jid
from jointid.cli.command_line import main
from jointid.estimate.findings import Finding


@pytest.fixture
def estimate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    shipped_estimate().save("estimate.json")
    return tmp_path / "estimate.json"


@pytest.mark.parametrize("ending", ["xml", "urdf", "h", "st", "mat"])
def test_every_target_is_written(
    estimate: Path, ending: str, capsys: pytest.CaptureFixture[str]
) -> None:
    line = ["export", str(estimate), "--to", f"joint.{ending}", "--approximate"]
    assert main(line) == 0
    said = capsys.readouterr()
    assert said.out == f"exported: joint.{ending}\n"
    assert said.err == ""
    again = jid.export(jid.Estimate.load(estimate), f"again.{ending}", approximate=True)
    written = Path(f"joint.{ending}").read_bytes()
    # The head of a .mat file has the time of day.
    assert written[128:] == again.read_bytes()[128:]


def test_the_target_can_be_named(estimate: Path) -> None:
    assert main(["export", str(estimate), "--to", "friction.inc", "--target", "c"]) == 0
    assert "#ifndef THESIS_JOINT" in Path("friction.inc").read_text(encoding="ascii")


def test_a_joint_file_is_edited_into_a_robot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    LOADED.save("joint.toml")
    text = '<robot><joint name="elbow" type="fixed"><parent link="a"/></joint></robot>'
    Path("arm.urdf").write_text(text, encoding="utf-8")
    line = "export joint.toml --to arm.urdf --into arm.urdf --joint-name elbow --json"
    assert main(line.split()) == 0
    assert json.loads(capsys.readouterr().out) == {"path": "arm.urdf", "warnings": []}
    assert 'damping="1.7" friction="3.1"' in Path("arm.urdf").read_text(encoding="utf-8")


def test_the_speed_is_that_of_the_nearest_friction(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    THESIS.save("joint.toml")
    texts = []
    for speed in ("0.1", "0.5"):
        line = ["export", "joint.toml", "--to", "j.xml", "--approximate", "--speed", speed]
        assert main(line) == 0
        texts.append(Path("j.xml").read_text(encoding="utf-8"))
    assert "speeds up to 0.1 rad/s" in texts[0]
    assert texts[0].partition("frictionloss=")[2] != texts[1].partition("frictionloss=")[2]


@pytest.mark.parametrize("severity", ["warning", "blocking"])
def test_an_estimate_that_cannot_be_used_is_refused(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    severity: str,
) -> None:
    """A controller would obey it, as a session obeys a joint file."""
    monkeypatch.chdir(tmp_path)
    finding = Finding(code="lag", severity=severity, title="a signal is late")  # type: ignore[arg-type]
    dataclasses.replace(shipped_estimate(), findings=(finding,)).save("estimate.json")
    code = main(["export", "estimate.json", "--to", "joint.h"])
    said = capsys.readouterr().err
    assert "lag" in said
    if severity == "blocking":
        assert code == 2
        assert not Path("joint.h").exists()
    else:
        assert code == 0
        assert "lag (warning): a signal is late" in Path("joint.h").read_text(encoding="ascii")
