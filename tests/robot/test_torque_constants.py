"""Currents of a robot: a torque constant for each joint gives its torque; one for all joints is asked about."""

from pathlib import Path

import numpy as np
import pytest
from command_line_answers import answer
from shared_cases import case
from small_arm import COULOMB, VISCOUS, recording, urdf

import jointid as jid

pytest.importorskip("pinocchio")
TRUTH = {
    "coulomb": [4.0, 5.0, 3.0, 1.2],
    "viscous": [6.0, 7.0, 3.5, 1.5],
}


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return urdf(tmp_path_factory.mktemp("arm"))


def currents(arm: Path, constants: list[float], ratios: list[float] | None) -> jid.RobotRecording:
    """A recording of the motors' currents, positions at the joints."""
    run = recording(arm)
    assert run.torque is not None
    per_ampere = np.array(constants) * np.array(ratios or [1.0, 1.0])
    return jid.RobotRecording(
        time=run.time, position=run.position, current=run.torque / per_ampere, names=run.names
    )


@pytest.mark.parametrize(
    ("constants", "ratios"),
    [([14.0, 11.0], None), ([0.2, -0.1], [50.0, -101.0]), ([-3.0, 8.0], None)],
)
def test_each_joint_has_its_constant(
    arm: Path, constants: list[float], ratios: list[float] | None
) -> None:
    run = currents(arm, constants, ratios)
    robot = jid.Robot.from_urdf(arm, torque_constants=constants, gear_ratios=ratios)
    found = jid.identify(run, robot)
    of_torques = jid.identify(recording(arm), jid.Robot.from_urdf(arm))
    for name, coulomb, viscous in zip(run.names, COULOMB, VISCOUS, strict=True):
        values = found.joints[name].parameters
        assert values["coulomb"].value == pytest.approx(coulomb, rel=0.01)
        assert values["viscous"].value == pytest.approx(viscous, rel=0.01)
        same = of_torques.joints[name].parameters["coulomb"].value
        assert values["coulomb"].value == pytest.approx(same, rel=1e-6)


def test_a_saved_estimate_keeps_the_constants(arm: Path, tmp_path: Path) -> None:
    run = currents(arm, [14.0, 11.0], None)
    found = jid.identify(run, jid.Robot.from_urdf(arm, torque_constants=[14.0, 11.0]))
    found.save(tmp_path / "arm.json")
    again = jid.RobotEstimate.load(tmp_path / "arm.json")
    assert again.robot.torque_constants == (14.0, 11.0)
    assert again.predict(run).joints == found.predict(run).joints


def test_each_joint_by_itself(arm: Path) -> None:
    run = currents(arm, [14.0, -11.0], None).with_torque_constants([14.0, -11.0])
    direct = recording(arm)
    assert run.torque is not None
    assert direct.torque is not None
    assert np.allclose(run.torque, direct.torque, rtol=1e-12)
    assert run.metadata["torque_constants"] == [14.0, -11.0]


def test_the_command_names_both_ways_and_takes_them(
    arm: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    currents(arm, [14.0, 11.0], None).save(tmp_path / "arm.csv")
    line = ["identify", "arm.csv", "--robot", str(arm)]
    code, said = answer(line, capsys)
    assert code == 2
    assert "--torque-constant VALUE,VALUE; or write torque_constants = [VALUE, VALUE] in" in said
    assert answer([*line, "--torque-constant", "14,11"], capsys)[0] == 0
    (tmp_path / "robot.toml").write_text("torque_constants = [14, 11]", encoding="utf-8")
    assert answer([*line, "--facts", "robot.toml"], capsys)[0] == 0
    assert (
        answer(["identify", "arm.csv", "--joints", "all", "--torque-constant", "14,11"], capsys)[0]
        == 0
    )


@pytest.mark.parametrize("subject", [["--robot", "small.urdf"], ["--joints", "all"]])
@pytest.mark.parametrize("option", ["--torque-constant", "--gear-ratio"])
def test_one_value_for_several_joints_is_asked_about(
    option: str,
    subject: list[str],
    arm: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(arm.parent)
    currents(arm, [14.0, 14.0], None).save(tmp_path / "arm.csv")
    line = ["identify", str(tmp_path / "arm.csv"), *subject]
    constant = ["--torque-constant", "14,14"] if option == "--gear-ratio" else []
    code, said = answer([*line, *constant, option, "14"], capsys)
    assert code == 2
    assert f"{option} 14,14 (if all joints have this value)" in said
    assert answer([*line, *constant, option, "14,14"], capsys)[0] == 0
    code, said = answer([*line, *constant, option, "14,14,14"], capsys)
    assert code == 2
    assert "for each of the 2 joints" in said


def test_the_case_has_its_right_values() -> None:
    folder = case("robot-08-current-of-each-joint")
    robot = jid.Robot.from_urdf(folder / "arm.urdf", torque_constants=[14, 13, 11, 10])
    found = jid.identify(jid.load(folder / "log.csv", joints="all"), robot)
    for k, joint in enumerate(found.joints.values()):
        for name, values in TRUTH.items():
            assert joint.parameters[name].value == pytest.approx(values[k], rel=0.05)


@pytest.mark.parametrize(
    "header", ["{joint}.effort [A]", "{joint}.torque [mA]", "{joint}_current_A"]
)
def test_amperes_are_a_current_whatever_the_column_is_called(
    header: str, arm: Path, tmp_path: Path
) -> None:
    """A header's unit is evidence, and a torque is never in amperes."""
    run = currents(arm, [14.0, 11.0], None)
    assert run.current is not None
    factor = 1e3 if "mA" in header else 1.0
    names = ["time [s]", *(f"{n}.position [rad]" for n in run.names)]
    names += [header.replace("{joint}", n) for n in run.names]
    table = np.column_stack([run.time, run.position, factor * run.current])
    np.savetxt(tmp_path / "a.csv", table, delimiter=",", header=",".join(names), comments="")
    read = jid.load(tmp_path / "a.csv", joints="all")
    assert read.torque is None
    assert read.current is not None
    assert np.allclose(read.current, run.current, rtol=1e-12)


def test_a_number_stands_for_the_named_joint(arm: Path, tmp_path: Path) -> None:
    """``joint_1.position`` and ``joint_1_effort`` are of one joint."""
    run = recording(arm)
    names = ["time_s", "joint_1.position", "joint_2.position", "joint_1_effort", "joint_2_effort"]
    assert run.torque is not None
    table = np.column_stack([run.time, run.position, run.torque])
    np.savetxt(tmp_path / "a.csv", table, delimiter=",", header=",".join(names), comments="")
    read = jid.load(tmp_path / "a.csv", joints="all")
    assert read.names == ("joint_1", "joint_2")
    assert read.torque is not None
    assert np.allclose(read.torque, run.torque, rtol=1e-12)
