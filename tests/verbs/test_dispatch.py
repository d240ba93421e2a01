"""Each verb does for each subject what the subject's own function does."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import simulated_servo
import small_arm
from example_recordings import WELL_EXCITED

import jointid as jid

JOINT = jid.thesis_joint()
SERVO = simulated_servo.servo_joint()
LAW, MOTION = jid.Pd(stiffness=8000.0, damping=400.0), jid.Trajectory.thesis(duration=2.0)


@pytest.fixture(scope="module")
def run() -> jid.Recording:
    return jid.load(WELL_EXCITED)


@pytest.fixture(scope="module")
def estimate(run: jid.Recording) -> jid.Estimate:
    return jid.identify(run, JOINT)


@pytest.fixture(scope="module")
def runs() -> list[jid.Recording]:
    return simulated_servo.bench_runs(simulated_servo.Truth(), seed=1)


@pytest.fixture(scope="module")
def servo(runs: list[jid.Recording]) -> jid.ServoEstimate:
    return jid.identify(runs, SERVO, draws=0)


@pytest.fixture(scope="module")
def arm_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The URDF of a small arm, and a log beside it."""
    pytest.importorskip("pinocchio")
    path = small_arm.urdf(tmp_path_factory.mktemp("arm"))
    small_arm.recording(path, duration=6.0).save(path.with_name("arm.csv"))
    return path


@pytest.fixture(scope="module")
def arm(arm_file: Path) -> jid.RobotRecording:
    return jid.load(arm_file.with_name("arm.csv"), joints="all")


# --- identify ---


def test_a_joint_is_identified(run: jid.Recording, estimate: jid.Estimate) -> None:
    from jointid.identification.identification import identify

    assert estimate["coulomb"].value == identify(run, JOINT)["coulomb"].value
    assert isinstance(jid.identify([run]), jid.Estimate)
    assert jid.identify(run, joint=JOINT).joint == estimate.joint  # type: ignore[call-overload]


def test_a_servo_is_identified(runs: list[jid.Recording], servo: jid.ServoEstimate) -> None:
    expected = jid.identify_servo(runs, SERVO, draws=0)
    assert dict(servo.parameters) == dict(expected.parameters)
    once = jid.identify(iter(runs), SERVO, draws=0)  # type: ignore[call-overload]
    assert dict(once.parameters) == dict(expected.parameters)


def with_torque(run: jid.Recording, name: str) -> jid.Recording:
    fields: dict[str, Any] = {name: np.sin(run.time)} | {
        each: getattr(run, each) for each in ("time", "position", "reference", "extra")
    }
    return jid.Recording(**fields, name=f"{run.name} {name}")


def test_a_servo_with_a_measured_torque_is_identified_by_it(runs: list[jid.Recording]) -> None:
    measured = [with_torque(each, "torque") for each in runs[:2]]
    assert type(jid.identify(measured, SERVO)) is jid.Estimate
    assert type(jid.identify([*measured, *runs[2:]], SERVO, draws=0)) is jid.ServoEstimate
    current = [with_torque(each, "current") for each in runs[:2]]
    assert type(jid.identify(current, SERVO.replace(torque_constant=0.3))) is jid.Estimate
    assert type(jid.identify([*current, *runs[2:]], SERVO, draws=0)) is jid.ServoEstimate
    alone = jid.identify(simulated_servo_with_current(runs), SERVO, draws=0)
    assert type(alone) is jid.ServoEstimate  # no constant says what torque the current is


def simulated_servo_with_current(runs: list[jid.Recording]) -> list[jid.Recording]:
    return [with_torque(each, "current") for each in runs]


def test_several_joints_are_identified(arm: jid.RobotRecording) -> None:
    found = jid.identify(arm, joints=["elbow"], couplings=False)
    assert isinstance(found, jid.JointEstimates)
    assert [*found.results] == ["elbow"]
    known = jid.identify(arm, {"elbow": jid.Joint(inertia=0.3)}, couplings=False)
    assert known.results["elbow"].estimate.joint.inertia == 0.3  # type: ignore[union-attr]


def test_a_robot_is_identified(arm: jid.RobotRecording, arm_file: Path) -> None:
    robot = jid.Robot.from_urdf(arm_file)
    found = jid.identify([arm], robot, inertia="scaled", windows=0.1)
    assert isinstance(found, jid.RobotEstimate)
    assert found.inertia == "scaled"
    assert found.settings["window_duration"] == pytest.approx(0.1, rel=0.05)


# --- compare ---


def test_a_joints_models_are_compared(run: jid.Recording) -> None:
    found = jid.compare(run, JOINT, models=["coulomb_viscous", "stribeck"], folds=2)
    assert (type(found), found.winner) == (jid.Comparison, "stribeck")


def test_a_servos_models_are_compared(runs: list[jid.Recording]) -> None:
    found: Any = jid.compare(runs, SERVO, models="coulomb_viscous")
    assert type(found) is jid.ServoComparison
    assert found.models == ("coulomb_viscous",)
    measured = [with_torque(each, "torque") for each in runs]
    rolled = jid.compare(measured, SERVO, score="rollout", models=["coulomb_viscous"])
    assert type(rolled) is jid.ServoComparison
    assert rolled.medians == pytest.approx(found.medians)


def test_a_robots_models_are_compared(arm: jid.RobotRecording, arm_file: Path) -> None:
    robot = jid.Robot.from_urdf(arm_file)
    found = jid.compare(arm, robot, inertia="urdf", models="coulomb_viscous", folds=2)
    assert isinstance(found, jid.RobotComparison)


# --- load ---


def test_a_file_of_several_joints_is_loaded(arm_file: Path) -> None:
    path = arm_file.with_name("arm.csv")
    every = jid.load(path, joints="all")
    assert (type(every), every.names) == (jid.RobotRecording, ("shoulder", "elbow"))
    assert jid.load(path, joints=["elbow"]).names == ("elbow",)
    assert jid.load(path, jid.Robot.from_urdf(arm_file)) == every
    assert jid.load([path], joints="all") == (every,)
    assert type(jid.load(path, joint="elbow")) is jid.Recording


def test_a_file_of_several_runs_is_loaded(tmp_path: Path, run: jid.Recording) -> None:
    path = tmp_path / "week.csv"
    rows = [f"{t},{q},{tau},{1 + (k >= 500)}" for k, (t, q, tau) in enumerate(first(run, 1000))]
    path.write_text("\n".join(["time_s,position_rad,torque_Nm,run", *rows]), encoding="utf-8")
    found = jid.load(path, by="run")
    assert [each.name for each in found] == ["week run=1", "week run=2"]
    assert found == jid.load_runs(path, by="run")


def first(run: jid.Recording, count: int) -> list[tuple[float, float, float]]:
    assert run.torque is not None
    columns = (each[:count].tolist() for each in (run.time, run.position, run.torque))
    return list(zip(*columns, strict=True))


def test_several_files_and_folders_are_loaded(tmp_path: Path, run: jid.Recording) -> None:
    parts = [run[:2.0], run[2.0:4.0]]
    for number, part in enumerate(parts):
        part.save(tmp_path / f"run_{number}.csv")
    (tmp_path / ".run_0.csv").write_text("a lock of an editor", encoding="utf-8")
    (tmp_path / "estimate.json").write_text("{}", encoding="utf-8")
    of_folder: Any = jid.load(str(tmp_path))
    of_files = jid.load([tmp_path / "run_0.csv", tmp_path / "run_1.csv"])
    assert [each.duration for each in of_folder] == [parts[0].duration, parts[1].duration]
    assert of_folder == of_files
    assert jid.identify(of_files, JOINT, model="stribeck")["viscous"].value > 0.0


def test_a_servos_columns_are_loaded(tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    rows = [f"{0.005 * k},{np.sin(0.01 * k)},{np.cos(0.01 * k)},7.4" for k in range(200)]
    log.write_text("\n".join(["time_s,position_rad,duty,supply_V", *rows]), encoding="utf-8")
    assert jid.load(log).extra == {}
    assert [*jid.load(log, SERVO).extra] == ["duty", "supply"]
    with log.open(encoding="utf-8") as file:
        assert [*jid.load(file, SERVO).extra] == ["duty", "supply"]
    other = SERVO.replace(voltage=jid.VoltageDrive(supply=7.4, signals={"duty": "supply_V"}))
    assert jid.load(log, other).extra["duty"][0] == 7.4


def test_a_motors_columns_are_loaded_with_the_joints_gear_ratio(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = [f"{0.001 * k},{np.sin(0.01 * k)},{np.cos(0.01 * k)}" for k in range(1000)]
    header = "time_s,motor_position_1_rad,motor_torque_1_Nm"
    path.write_text("\n".join([header, *rows]), encoding="utf-8")
    joint = jid.Joint(gear_ratio=50.0)
    assert jid.load(path, joint) == jid.load(path, gear_ratio=50.0)
    assert jid.load(path, joint, gear_ratio=20.0) == jid.load(path, gear_ratio=20.0)


# --- simulate, design, export ---


def test_a_joint_is_simulated(estimate: jid.Estimate) -> None:
    of_joint = jid.simulate(estimate.joint, LAW, MOTION)
    assert isinstance(of_joint, jid.SimulatedRecording)
    assert jid.simulate(estimate, LAW, MOTION) == of_joint


def test_a_servo_is_simulated_along_its_logs(
    runs: list[jid.Recording], servo: jid.ServoEstimate
) -> None:
    expected = jid.rollout(servo, runs[:1], threads=1).errors.tolist()
    assert jid.simulate(servo, recordings=runs[:1], threads=1).errors.tolist() == expected
    short: Any = jid.simulate
    assert short(servo, runs[0]).errors.tolist() == expected
    assert jid.simulate(servo.identified, recordings=runs[0]).errors.tolist() == expected
    law = jid.Pd(stiffness=2.0, damping=0.1)
    assert isinstance(jid.simulate(servo, law, MOTION), jid.SimulatedRecording)


def test_a_motion_is_designed_before_and_after(estimate: jid.Estimate) -> None:
    limits: Any = {"position": (-1.0, 1.0), "velocity": 3.4, "torque": 160.0}
    search = jid.DesignSearch(evaluations=64, joints=2, rehearsals=10)
    values = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
    known = JOINT.with_parameters({**values, "sensor_gain": 2.4, "sensor_offset": 15.0})
    before = jid.design(known, limits, 4.0, search=search)
    assert (type(before), before.duration) == (jid.Design, 4.0)
    after = jid.design(estimate, limits, 4.0, search=search)
    assert after.trajectory == estimate.next_motion(limits, 4.0, search=search).trajectory
    assert all(row.before is not None for row in after.parameters.values())


def test_a_servo_is_exported(servo: jid.ServoEstimate, tmp_path: Path) -> None:
    path = jid.export(servo, tmp_path / "servo.h")
    expected = jid.export(servo.identified, tmp_path / "joint.h")
    assert path.read_text("utf-8") == expected.read_text("utf-8")
