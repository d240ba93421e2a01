"""A velocity in the log beside the one of the positions: the balance says which is better, joint by joint."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_arm

import jointid as jid

pytest.importorskip("pinocchio")

Array = np.ndarray[Any, np.dtype[np.float64]]


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return small_arm.urdf(tmp_path_factory.mktemp("arm"))


@pytest.fixture(name="robot", scope="module")
def _robot(path: Path) -> jid.Robot:
    return jid.Robot.from_urdf(path)


def logged(
    path: Path,
    *,
    seed: int,
    step: float = 0.0,
    noise: float = 1e-3,
    delay: float = 0.0,
    scale: float = 1.0,
) -> jid.RobotRecording:
    """With a velocity of this noise, delay and scale, and positions in such steps."""
    run = small_arm.recording(path, duration=8.0, seed=seed)
    exact = np.gradient(run.position, run.time, axis=0)
    late = np.column_stack([np.interp(run.time - delay, run.time, each) for each in exact.T])
    velocity = scale * late + np.random.default_rng(seed).normal(0.0, noise, late.shape)
    position = np.round(run.position / step) * step if step else run.position
    return jid.RobotRecording(**{**run.fields(), "position": position, "velocity": velocity})


def without(run: jid.RobotRecording) -> jid.RobotRecording:
    """The same without a velocity."""
    return jid.RobotRecording(**{**run.fields(), "velocity": None})


def used(found: jid.RobotEstimate) -> list[str]:
    """Joints whose recorded velocity was used."""
    return list(found.settings["recorded_velocity"])


def worst(found: jid.RobotEstimate) -> float:
    """The largest relative error of friction."""
    pairs = [
        (joint.parameters[name].value, float(truth))
        for name, truths in (("coulomb", small_arm.COULOMB), ("viscous", small_arm.VISCOUS))
        for joint, truth in zip(found.joints.values(), truths, strict=True)
    ]
    return max(abs(value / truth - 1.0) for value, truth in pairs)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("delay", [0.0, 0.006])
@pytest.mark.parametrize("inertia", ["urdf", "free"])
def test_a_good_velocity_is_taken_where_positions_are_coarse(
    path: Path, robot: jid.Robot, inertia: Any, delay: float, seed: int
) -> None:
    run = logged(path, seed=seed, step=2e-3, delay=delay)
    found = jid.identify_robot(run, robot, inertia=inertia)
    assert used(found) == ["shoulder", "elbow"]
    assert worst(found) < 0.02
    assert worst(found) < worst(jid.identify_robot(without(run), robot, inertia=inertia))
    (said,) = [each for each in found.findings if each.code == "recorded_velocity"]
    assert said.severity == "info"
    assert said.evidence["elbow.recorded"].value < said.evidence["elbow.derived"].value
    assert found.verdict.level == "usable"


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize(
    "bad",
    [
        {"noise": 0.02},
        {"noise": 2e-4, "delay": 0.08},
        *({"noise": 2e-4, "scale": scale} for scale in (1.1, -1.0, 57.3)),
    ],
)
def test_a_bad_velocity_changes_no_value(
    path: Path, robot: jid.Robot, bad: dict[str, float], seed: int
) -> None:
    run = logged(path, seed=seed, step=1e-5, **bad)
    found = jid.identify_robot(run, robot)
    assert used(found) == []
    alone = jid.identify_robot(without(run), robot)
    for name, joint in found.joints.items():
        for key, p in joint.parameters.items():
            assert p.value == alone.joints[name].parameters[key].value


def test_a_velocity_that_is_as_late_as_the_torque_is_no_better(
    path: Path, robot: jid.Robot
) -> None:
    run = logged(path, seed=1, step=1e-5, noise=1e-2, delay=0.005)
    assert run.torque is not None
    late = [np.interp(run.time - 0.005, run.time, each) for each in run.torque.T]
    moved = jid.RobotRecording(**{**run.fields(), "torque": np.column_stack(late)})
    found = jid.identify_robot(moved, robot)
    assert used(found) == []
    assert worst(found) == worst(jid.identify_robot(without(moved), robot))


def test_each_joint_has_its_own_velocity(path: Path, robot: jid.Robot) -> None:
    run = logged(path, seed=0)
    position = np.array(run.position)
    position[:, 1] = np.round(position[:, 1] / 2e-3) * 2e-3
    assert run.velocity is not None
    noisy = run.velocity + np.random.default_rng(0).normal(0.0, [0.02, 0.0], run.velocity.shape)
    mixed = jid.RobotRecording(**{**run.fields(), "position": position, "velocity": noisy})
    found = jid.identify_robot(mixed, robot)
    assert used(found) == ["elbow"]
    assert worst(found) < 0.02


def test_a_prediction_uses_the_same_velocity(path: Path, robot: jid.Robot) -> None:
    run = logged(path, seed=0, step=2e-3)
    found = jid.identify_robot(run, robot)
    read = jid.RobotEstimate.from_json(found.to_json())
    other = logged(path, seed=1, step=2e-3)
    predicted = read.predict(other)
    assert predicted.relative_residual == found.predict(other).relative_residual
    assert predicted.relative_residual < 1.5 * found.relative_residual


def test_where_stamps_hide_all_motion_the_recorded_velocity_is_used_with_care(
    path: Path, robot: jid.Robot
) -> None:
    run = logged(path, seed=0)
    rng = np.random.default_rng(0)
    time = np.cumsum(rng.uniform(0.5e-3, 1.5e-3, run.samples))
    time *= run.time[-1] / time[-1]
    fields = run.fields()
    for name in ("position", "velocity", "torque"):
        moved = [np.interp(time, run.time, each) for each in np.asarray(fields[name]).T]
        fields[name] = np.column_stack(moved)
    stamps = np.maximum.accumulate(time + rng.exponential(2e-4, time.size))
    fields["time"] = stamps + 1e-9 * np.arange(time.size)
    found = jid.identify_robot(jid.RobotRecording(**fields), robot)
    assert used(found) == ["shoulder", "elbow"]
    (said,) = [each for each in found.findings if each.code == "recorded_velocity"]
    assert said.severity == "warning"
    assert found.verdict.level == "usable with care"
    assert worst(found) < 0.05


def test_a_robot_on_a_stand_has_its_better_velocity_and_only_the_gravity_that_it_shows(
    path: Path,
) -> None:
    run = logged(path, seed=0, step=2e-3)
    found = jid.identify_robot(run, jid.Robot.from_urdf(path, gravity="free"))
    assert used(found) == ["shoulder", "elbow"]
    assert worst(found) < 0.02
    (said,) = [each for each in found.findings if each.code == "gravity_found"]
    # Both joints turn about y: no torque shows gravity along it.
    assert ", ?, -9.8" in said.title
    assert "inf" not in str(said)
    assert "y" not in said.evidence
    assert said.evidence["z"].value == pytest.approx(-9.81, abs=0.01)
    again = jid.RobotEstimate.from_json(found.to_json())
    assert found.robot.gravity_free is again.robot.gravity_free is False


def test_a_stated_filter_is_undone_before_velocities_are_compared(
    path: Path, robot: jid.Robot
) -> None:
    run = logged(path, seed=0, step=2e-3)
    assert run.torque is not None
    constant, filtered = 0.006, np.array(run.torque)
    for row in range(1, len(filtered)):
        rise = run.torque[row] - filtered[row - 1]
        filtered[row] = filtered[row - 1] + (1e-3 / constant) * rise
    late = jid.RobotRecording(**{**run.fields(), "torque": filtered})
    found = jid.identify_robot(late, robot, shift={"torque_filter": constant - 5e-4})
    assert used(found) == ["shoulder", "elbow"]
    assert worst(found) < 0.02
