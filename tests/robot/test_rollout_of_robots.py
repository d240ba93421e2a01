"""A robot rolled out along logs: the arm moves as it did and as MuJoCo says, and sticks where friction holds."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import small_arm

import jointid as jid
from jointid.estimate.rollout import Rollout
from jointid.robot.rollout.arm import Arm
from jointid.robot.rollout.stepping import Push, State, moved

pytest.importorskip("pinocchio")


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return small_arm.urdf(tmp_path_factory.mktemp("arm"))


@pytest.fixture(scope="module")
def found(path: Path) -> jid.RobotEstimate:
    return jid.identify(small_arm.recording(path, duration=8.0), jid.Robot.from_urdf(path))


@pytest.fixture(scope="module")
def rolled(path: Path, found: jid.RobotEstimate) -> Rollout:
    return jid.simulate(found, recordings=small_arm.recording(path, duration=3.0, seed=3))


def test_the_arm_moves_as_logged_and_without_friction_it_does_not(rolled: Rollout) -> None:
    assert [run.name for run in rolled.runs] == ["shoulder", "elbow"]
    for run in rolled.runs:
        assert run.error < np.radians(0.1)
        assert run.before is not None
        assert run.before > 50.0 * run.error


def test_a_wrong_friction_is_seen(path: Path, found: jid.RobotEstimate, rolled: Rollout) -> None:
    shoulder = found.joints["shoulder"]
    coulomb = replace(
        shoulder.parameters["coulomb"], value=1.2 * shoulder.parameters["coulomb"].value
    )
    changed = replace(shoulder, parameters={**shoulder.parameters, "coulomb": coulomb})
    wrong = replace(found, joints={**found.joints, "shoulder": changed})
    again = jid.simulate(wrong, recordings=small_arm.recording(path, duration=3.0, seed=3))
    assert again.runs[0].error > 10.0 * rolled.runs[0].error


def test_friction_under_load_moves_the_arm_as_logged(path: Path) -> None:
    share = (0.15, 0.1)
    first, second = (
        small_arm.recording(path, seed=seed, under_load=share, duration=8.0) for seed in (0, 3)
    )
    model = "coulomb_viscous:load_friction"
    found = jid.identify(first, jid.Robot.from_urdf(path), model=model)
    rolled = jid.simulate(found, recordings=second)
    assert max(run.error for run in rolled.runs) < np.radians(0.1)


def test_a_joint_that_friction_holds_stands_still(found: jid.RobotEstimate) -> None:
    arm = Arm.of(found)
    still, position = np.zeros(2), np.array([0.1, 0.0])
    state = State(position, still, still)
    below = np.array([3.9, -1.9])  # Coulomb friction is 4 and 2 N·m
    held = arm.bias(position, still) + below
    for _ in range(200):
        state = moved(arm, state, Push(held, still), 1e-3)
    assert state.velocity == pytest.approx([0.0, 0.0], abs=1e-12)
    assert state.position == pytest.approx([0.1, 0.0], abs=1e-12)
    beyond = arm.bias(position, still) + np.array([4.1, 0.0])
    assert moved(arm, state, Push(beyond, still), 1e-3).velocity[0] > 0.0


def test_mujoco_moves_alike(path: Path, found: jid.RobotEstimate) -> None:
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.timestep = 1e-3
    for k, joint in enumerate(found.joints.values()):
        values = {name: p.value for name, p in joint.parameters.items()}
        model.dof_frictionloss[k], model.dof_damping[k] = values["coulomb"], values["viscous"]
        model.dof_armature[k] = values["rotor_inertia"]
    data = mujoco.MjData(model)
    arm = Arm.of(found)
    still = np.zeros(2)
    state = State(np.array([0.5, -0.3]), still, still)
    data.qpos[:], data.qvel[:] = state.position, state.velocity
    for number in range(1000):
        torque = np.array([15.0, 6.0]) * np.sin(np.array([5.0, 8.0]) * number * 1e-3)
        data.qfrc_applied[:] = torque
        mujoco.mj_step(model, data)
        state = moved(arm, state, Push(torque, still), 1e-3)
    assert np.abs(state.position).max() > 0.2
    assert state.position == pytest.approx(data.qpos, abs=np.radians(1.0))


def test_the_page_shows_each_joint(
    found: jid.RobotEstimate, rolled: Rollout, tmp_path: Path
) -> None:
    page = jid.save_report(found, tmp_path / "arm.html", rollout=rolled).read_text("utf-8")
    section = page.partition('id="rollouts"')[2]
    assert "with the URDF and without friction" in section
    assert section.count("deg mean error") >= 2


def test_what_a_rollout_refuses(path: Path, found: jid.RobotEstimate) -> None:
    run = small_arm.recording(path, duration=1.0)
    with pytest.raises(jid.InputError, match="its options are horizon, step"):
        jid.simulate(found, recordings=run, threads=2)  # type: ignore[call-overload]
    with pytest.raises(jid.InputError, match="horizon"):
        jid.simulate(found, recordings=run, horizon=0.0)
    with pytest.raises(jid.InputError, match="at least one recording"):
        jid.simulate(found, recordings=[])
