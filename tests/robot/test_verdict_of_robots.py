"""The verdict on a robot's estimate: what a person who knows the arm would say, listed before it was computed."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import small_arm

import jointid as jid
from jointid.estimate.findings import Finding


@pytest.fixture(name="robot", scope="module")
def _robot(tmp_path_factory: pytest.TempPathFactory) -> jid.Robot:
    pytest.importorskip("pinocchio")
    return jid.Robot.from_urdf(small_arm.urdf(tmp_path_factory.mktemp("arm")))


@pytest.fixture(name="run", scope="module")
def _run(tmp_path_factory: pytest.TempPathFactory) -> jid.RobotRecording:
    return small_arm.recording(small_arm.urdf(tmp_path_factory.mktemp("run")), duration=8.0)


def changed(run: jid.RobotRecording, **signals: object) -> jid.RobotRecording:
    kept = {"time": run.time, "position": run.position, "torque": run.torque, "names": run.names}
    return jid.RobotRecording(**{**kept, **signals})  # type: ignore[arg-type]


def of_one(run: jid.RobotRecording, torque: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """The torques, the elbow's changed."""
    assert run.torque is not None
    return np.column_stack([run.torque[:, 0], torque(run.torque[:, 1])])


def noise(values: np.ndarray) -> np.ndarray:
    return np.random.default_rng(1).normal(scale=np.std(values), size=values.shape)


def test_a_good_arm_is_usable(robot: jid.Robot, run: jid.RobotRecording) -> None:
    found = jid.identify_robot(run, robot)
    assert found.verdict.level == "usable"
    assert found.report().splitlines()[0] == "small: usable"
    assert json.loads(found.to_json())["verdict"] == found.verdict.document()
    assert jid.RobotEstimate.from_json(found.to_json()).verdict == found.verdict


def test_a_joint_whose_torque_is_noise_is_not_usable_and_named(
    robot: jid.Robot, run: jid.RobotRecording
) -> None:
    found = jid.identify_robot(changed(run, torque=of_one(run, noise)), robot)
    verdict = found.verdict
    assert {use.level for use in verdict.uses.values()} == {"not usable"}
    assert "elbow.coulomb" in verdict.uses["compensation"].parameters
    assert any("of the variance of elbow's torque" in reason for reason in verdict.reasons)
    assert not any("of shoulder's torque" in reason for reason in verdict.reasons)


def test_a_wrong_link_needs_care(robot: jid.Robot, run: jid.RobotRecording, tmp_path: Path) -> None:
    heavier = small_arm.URDF.replace('<mass value="3"/>', '<mass value="3.6"/>')
    wrong = jid.Robot.from_urdf(small_arm.urdf(tmp_path, heavier))
    assert jid.identify_robot(run, wrong).verdict.level == "usable with care"


def test_each_purpose_minds_its_own(robot: jid.Robot, run: jid.RobotRecording) -> None:
    found = jid.identify_robot(run, robot)
    vague = Finding(
        code="undetermined", title="it hardly moves", parameters=("elbow.rotor_inertia",)
    )
    uses = replace(found, findings=(vague,)).verdict.uses
    assert uses["compensation"].level == "usable"
    assert str(uses["simulation"]) == "usable with care (elbow.rotor_inertia)"
    assert uses["monitoring"].level == "usable"  # a change of a tenth would be seen
    drift = replace(vague, code="drift")
    assert replace(found, findings=(drift,)).verdict.uses["monitoring"].level == "usable with care"
    impossible = Finding(code="impossible_inertia", title="no body is so")
    verdict = replace(found, findings=(impossible,)).verdict
    assert verdict.uses["simulation"].level == "not usable"
    assert verdict.uses["compensation"].level == "usable"
    assert verdict.uses["monitoring"].level == "usable"
    assert verdict.reasons == ("no body is so",)
    told = replace(vague, severity="info")
    assert replace(found, findings=(told,)).verdict.level == "usable"


def test_a_joint_that_stands_needs_care_alone(robot: jid.Robot, run: jid.RobotRecording) -> None:
    position = run.position.copy()
    half = len(run.time) // 2
    position[half:, 1] = position[half, 1]
    found = jid.identify_robot(changed(run, position=position), robot)
    standing = [each for each in found.findings if each.code == "standing" and each.parameters]
    assert standing
    assert all(name.startswith("elbow.") for each in standing for name in each.parameters)


def test_friction_that_is_not_there_is_a_good_value(
    robot: jid.Robot, run: jid.RobotRecording
) -> None:
    """The elbow's viscous friction is taken away, then as much again: 0 is right, then it is no value."""
    found = jid.identify_robot(run, robot)
    viscous = found.parameters["elbow.viscous"].value
    speed = np.gradient(run.position[:, 1], run.time)
    for times, level in ((1.0, "usable"), (2.0, "not usable")):
        assert run.torque is not None
        less = run.torque - np.column_stack([0.0 * speed, times * viscous * speed])
        each = jid.identify_robot(changed(run, torque=less), robot)
        uses = each.verdict.uses
        assert (uses["compensation"].level, uses["simulation"].level) == (level, level)
        if level == "not usable":
            assert any("need elbow.viscous" in reason for reason in each.verdict.reasons)


def test_each_purpose_says_how_good(robot: jid.Robot, run: jid.RobotRecording) -> None:
    found = jid.identify_robot(run, robot)
    assert 0.0 < found.within["compensation"] < 0.02
    assert found.verdict.uses["simulation"].within == found.within["simulation"]
    assert "  compensation to ± " in found.report()
