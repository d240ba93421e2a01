"""`jointid info` of a log of several joints: a line for each, and its torque against the weight of the URDF's links."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared_cases import case
from small_arm import recording, urdf

import jointid as jid
from jointid.cli.command_line import main

pytest.importorskip("pinocchio")


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return urdf(tmp_path_factory.mktemp("arm"))


def told(capsys: pytest.CaptureFixture[str], *words: object) -> dict[str, Any]:
    assert main(["info", *map(str, words), "--json"]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


def log(arm: Path, path: Path, **changes: Any) -> Path:
    run = recording(arm)
    jid.RobotRecording(**{**run.fields(), **changes}).save(path)
    return path


@pytest.mark.parametrize("factors", [[1.0, 1.0], [1 / 14.0, 1 / 11.0], [1000.0, 1000.0]])
def test_the_torques_are_weighed(
    factors: list[float], arm: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    torque = recording(arm).torque
    assert torque is not None
    path = log(arm, tmp_path / "a.csv", torque=torque * np.array(factors))
    found = told(capsys, path, "--robot", arm)["joints"]
    for name, factor in zip(("shoulder", "elbow"), factors, strict=True):
        assert found[name]["scale against the URDF's weight"] == pytest.approx(factor, rel=0.02)
        assert found[name]["signs"] == "both"
        assert found[name]["rate [Hz]"] == 1000.0


@pytest.mark.parametrize("facts", ["", "torque_constants = [7.0, 11.0]"])
def test_an_ampere_is_weighed(
    facts: str, arm: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of currents the torque constant by the links' weight is shown, whatever constants are stated."""
    torque = recording(arm).torque
    assert torque is not None
    current = torque / np.array([14.0, -11.0])
    path = log(arm, tmp_path / "a.csv", torque=None, current=current)
    (tmp_path / "facts.toml").write_text(facts, encoding="utf-8")
    words = [path, "--robot", arm, "--facts", tmp_path / "facts.toml"]
    found = told(capsys, *words)["joints"]
    assert main(["info", *map(str, words)]) == 0
    _, head, _, *lines = capsys.readouterr().out.splitlines()
    assert head.endswith("torque constant [N·m/A]")
    assert "URDF's weight" not in head
    for line, (name, constant) in zip(lines, (("shoulder", 14.0), ("elbow", -11.0)), strict=False):
        assert line.split()[0] == name
        assert float(line.split()[-1]) == pytest.approx(constant, rel=0.02)
        assert found[name]["torque_constant [N·m/A]"] == float(line.split()[-1])
        assert found[name]["scale against the URDF's weight"] is None


@pytest.mark.parametrize("lacks", ["torque", "torque, with wanted positions", "the elbow's"])
def test_a_log_that_cannot_be_weighed_is_shown(
    lacks: str, arm: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = recording(arm)
    assert run.torque is not None
    changes: dict[str, Any] = {"torque": None}
    if "wanted" in lacks:
        changes["reference"] = run.position + 0.01
    if "elbow" in lacks:
        changes["torque"] = np.column_stack([run.torque[:, 0], np.full(run.samples, np.nan)])
    path = log(arm, tmp_path / "a.csv", **changes)
    why = "elbow has no torque" if "elbow" in lacks else "the recording has no torque"
    (remark,) = told(capsys, path, "--robot", arm)["remarks"]
    assert remark.startswith("not compared with the links' weight: ")
    assert why in remark
    assert main(["info", str(path), "--robot", str(arm)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [each.split()[0] for each in lines[3:5]] == ["shoulder", "elbow"]
    assert lines[5:] == [remark]
    assert "weight" not in lines[1]
    assert main(["info", str(path), "--robot", str(tmp_path / "none.urdf")]) == 2


def test_what_each_joint_lacks(
    arm: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = recording(arm)
    assert run.torque is not None
    torque = np.column_stack([np.abs(run.torque[:, 0]), np.full(run.samples, np.nan)])
    kept = (run.time < 3.0) | (run.time > 3.5)
    position = run.position.copy()
    position[1::2, 1] = position[:-1:2, 1]
    path = tmp_path / "a.npz"
    jid.RobotRecording(
        time=run.time[kept],
        position=position[kept],
        torque=torque[kept],
        names=["left", "right"],
    ).save(path)
    found = told(capsys, path)["joints"]
    assert found["left"]["signs"] == "never negative"
    assert found["right"]["signs"] is None
    assert found["left"]["gaps"] == found["right"]["gaps"] == 1
    repeated = [each["rows that repeat the position [%]"] for each in found.values()]
    assert repeated[0] < 1.0
    assert repeated[1] == pytest.approx(50.0, abs=2.0)
    assert found["left"]["signals"]["position"]["max"] == position[kept, 0].max()
    assert found["right"]["scale against the URDF's weight"] is None


def test_one_joint_is_shown_as_before(
    arm: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = log(arm, tmp_path / "a.csv")
    assert "signals" in told(capsys, path, "--joints", "elbow")
    assert list(told(capsys, path, "--joints", "elbow,shoulder")["joints"]) == ["elbow", "shoulder"]


@pytest.mark.parametrize(
    ("name", "file", "joints"),
    [
        ("robot-08-current-of-each-joint", "log.csv", 4),
        ("robot-13-two-publishers-bag", "", 3),
        ("robot-14-formats", "dash.csv", 3),
        ("robot-14-formats", "lists.csv", 3),
        ("robot-14-formats", "tau_est.csv", 12),
    ],
)
def test_the_cases_have_a_line_for_each_joint(
    name: str, file: str, joints: int, capsys: pytest.CaptureFixture[str]
) -> None:
    found = told(capsys, case(name) / file)["joints"]
    assert len(found) == joints
    if file == "tau_est.csv":
        assert all(each["torque"] == "torque" for each in found.values())
