"""What is advised at the shell fits the command that says it, and the options that it names are taken."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from command_line_answers import answer
from moving_joints import recorded, sines, torques

import jointid as jid
from jointid.cli.command_line import main

FOREIGN = Path(__file__).with_name("foreign_logs")
JOINTS = FOREIGN / "kr300_125_hz.csv.gz"


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The estimates of two joints, saved by the command line; its report lies beside them."""
    motion = sines(2, 1, duration=6.0)
    path = tmp_path_factory.mktemp("arm") / "arm.csv"
    recorded(motion, torques(motion, 1)).save(path)
    saved = path.with_name("arm.json")
    assert main(["identify", str(path), "--joints", "all", "--save", str(saved), "--quiet"]) == 0
    return saved


def test_only_identify_is_named_for_all_joints(capsys: pytest.CaptureFixture[str]) -> None:
    code, said = answer(["compare", str(JOINTS)], capsys)
    assert code == 2
    assert "or identify with --joints all" in said


def test_all_joints_need_a_ratio_each(capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        "one ratio for each joint, separated by commas"
        in answer(["identify", str(JOINTS)], capsys)[1]
    )
    assert main(["identify", str(JOINTS), "--joints", "1,2", "--quiet"]) == 2
    assert "joint angle; one value for each joint, separated by commas)" in capsys.readouterr().out


def test_a_joint_file_is_no_joint_of_a_file(capsys: pytest.CaptureFixture[str]) -> None:
    code, said = answer(["info", str(JOINTS), "--joint", "joint.toml"], capsys)
    assert code == 2
    assert "there is no option --joint; did you mean --joints?" in said
    assert "--where COLUMN=VALUE" in answer(["info", str(JOINTS), "--by", "run"], capsys)[1]


def test_a_negative_angle_is_a_value(capsys: pytest.CaptureFixture[str]) -> None:
    log = FOREIGN / "ak80_swing_up.csv.gz"
    weight = ["--mass", "0.5", "--centre-of-mass", "0.1", "--link-angle", "-90deg"]
    assert main(["identify", str(log), *weight, "--quiet", "--json"]) == 0
    link = json.loads(capsys.readouterr().out)["joint"]["link"]
    assert link["angle"] == pytest.approx(-np.pi / 2)


def test_a_design_follows_one_of_several_joints(
    arm: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    joint, motion = tmp_path / "joint.toml", tmp_path / "motion.toml"
    jid.Estimate.from_json(
        json.dumps(json.loads(arm.read_text("utf-8"))["joints"]["2"]["estimate"])
    ).joint.save(joint)
    line = ["design", str(joint), "--after", str(arm), "--position", "-60deg,60deg", "--quiet"]
    line += ["--velocity", "2", "--torque", "300", "--duration", "4", "--evaluations", "64"]
    line += ["--output", str(motion), "--rehearsals", "10"]
    code, said = answer(line, capsys)
    assert code == 2
    assert "with --after-joint 1 (or another joint)" in said
    assert "--after-joint 9" in answer([*line, "--after-joint", "9"], capsys)[1]
    assert main([*line, "--after-joint", "2"]) == 0
    assert motion.is_file()


def test_the_advised_design_names_the_joint(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    saved = str(tmp_path / "arm.json")
    line = ["identify", str(FOREIGN / "tx40_200_hz.csv.gz"), "--joints", "4,6", "--save", saved]
    assert main([*line, "--quiet", "-v"]) == 0
    assert f"--after {saved} --after-joint 6 " in capsys.readouterr().out


def test_a_file_of_another_kind_is_named(
    arm: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    servo = tmp_path / "servo.json"
    servo.write_text('{"schema": 1, "kind": "jointid servo"}', encoding="utf-8")
    line = ["report", str(servo), "--output", str(tmp_path / "page.html")]
    assert "servo.json: joint: this is missing" in answer(line, capsys)[1]
    with pytest.raises(jid.InputError, match="this is a servo's estimate"):
        jid.Estimate.load(servo)
    with pytest.raises(jid.InputError, match="the estimates of several joints"):
        jid.Estimate.load(arm)


def test_two_files_to_save_to_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    saves = [word for end in ("json", "toml") for word in ("--save", str(tmp_path / f"a.{end}"))]
    code, said = answer(["identify", str(FOREIGN / "ak80_swing_up.csv.gz"), *saves], capsys)
    assert code == 2
    assert "--save: this option is given twice" in said
    assert not list(tmp_path.iterdir())


def test_a_folder_is_called_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copy(FOREIGN / "ak80_swing_up.csv.gz", tmp_path)
    code, said = answer(["identify", str(tmp_path)], capsys)
    assert code == 2
    assert "this is a folder" in said
    assert f"name the files in it, as in {tmp_path}" in said


def test_all_that_a_simulator_needs_is_advised_at_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    joint = tmp_path / "joint.toml"
    parameters = {"coulomb": 1.0, "viscous": 2.0, "static": 0.5, "stribeck": 0.1}
    jid.Joint(model=jid.Model.of("stribeck"), inertia=1.0).with_parameters(parameters).save(joint)
    line = ["export", str(joint), "--to", str(tmp_path / "joint.xml")]
    code, said = answer(line, capsys)
    assert code == 2
    assert "export with --approximate --speed VALUE" in said
    assert main([*line, "--approximate", "--speed", "3"]) == 0
