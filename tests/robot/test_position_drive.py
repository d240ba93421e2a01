"""Robots without a torque signal: wanted positions and the gains of the loop, against MuJoCo's dynamics."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pd_driven
import pytest
import small_arm
from numpy.typing import NDArray
from pd_driven import ARM_TRUTH, LEG_TRUTH, Truth

import jointid as jid

pytest.importorskip("mujoco")
Array = NDArray[np.float64]

NAMES = ("rotor_inertia", "coulomb", "viscous")
DELAYS = (0.0, 0.0021, 0.0074, 0.0163, 0.004)
LEG_DRIVE: dict[str, Any] = {"kp": 20, "kd": 1.5}


def errors(found: jid.RobotEstimate, truth: Truth) -> Array:
    """Relative errors of armature, Coulomb and viscous friction, (joints, 3)."""
    true = np.array([truth.armature, truth.coulomb, truth.viscous]).T
    values = [[each.parameters[name].value for name in NAMES] for each in found.joints.values()]
    return np.asarray(np.array(values) / true - 1.0)


def drive_of(truth: Truth) -> dict[str, Any]:
    """The gains as facts."""
    return {"kp": truth.kp.tolist(), "kd": truth.kd.tolist()}


@pytest.mark.parametrize(("truth", "seed", "delay"), [(LEG_TRUTH, 1, 0.0021), (ARM_TRUTH, 2, 0.0)])
def test_gains_stand_for_a_torque(tmp_path: Path, truth: Truth, seed: int, delay: float) -> None:
    path, log = pd_driven.driven(truth, tmp_path, seed, delay=delay, duration=10.0)
    robot = jid.Robot.from_urdf(path, drive=drive_of(truth))
    found = jid.identify(log, robot)
    assert np.abs(errors(found, truth)).max() < 0.02
    assert found.settings["shift"].get("reference", 0.0) == pytest.approx(delay, abs=2e-4)
    assert found.verdict.level == "usable"


def test_the_closed_loop_moves_the_leg_as_mujoco_does(tmp_path: Path) -> None:
    drive = drive_of(LEG_TRUTH)
    (path, log), (_, other) = (
        pd_driven.driven(LEG_TRUTH, tmp_path, seed, delay=0.0021, duration=duration)
        for seed, duration in ((1, 8.0), (2, 2.0))
    )
    found = jid.identify(log, jid.Robot.from_urdf(path, drive=drive))
    rolled = jid.simulate(found, recordings=other)
    assert rolled.horizon is None
    for run in rolled.runs:
        assert run.closed
        assert run.before is not None
        assert run.error < np.radians(0.1)
        assert run.before > 10.0 * run.error
    ratios = np.array([9.0, -9.0, 9.0])
    geared = replace(found.robot, gear_ratios=tuple(ratios), side="motor")
    assert geared.drive is not None
    assert other.reference is not None
    motors = jid.RobotRecording(
        time=other.time,
        position=other.position * ratios,
        reference=other.reference * ratios,
        names=other.names,
    )
    small = tuple(tuple(np.array(each) / 81.0) for each in (geared.drive.kp, geared.drive.kd))
    geared = replace(geared, drive=replace(geared.drive, kp=small[0], kd=small[1]))
    again = jid.simulate(replace(found, robot=geared), recordings=motors)
    assert again.errors == pytest.approx(rolled.errors, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("truth", [LEG_TRUTH, ARM_TRUTH])
def test_twenty_motions(tmp_path: Path, truth: Truth) -> None:
    every, late, inside = [], [], []
    for seed in range(20):
        delay = DELAYS[seed % len(DELAYS)]
        path, log = pd_driven.driven(truth, tmp_path, seed, delay=delay)
        found = jid.identify(log, jid.Robot.from_urdf(path, drive=drive_of(truth)))
        every.append(errors(found, truth))
        late.append(found.settings["shift"].get("reference", 0.0) - delay)
        assert found.verdict.level == "usable", (seed, str(found.verdict))
        for row, joint in zip(every[-1], found.joints.values(), strict=True):
            for error, name in zip(row, NAMES, strict=True):
                p = joint.parameters[name]
                assert p.interval is not None
                true = p.value / (1.0 + error)
                inside.append(p.interval[0] <= true <= p.interval[1])
    far = np.abs(np.array(every))
    assert np.median(far, axis=0).max() < 0.03
    assert far.max() < 0.06
    assert np.abs(late).max() < 1e-3
    assert np.mean(inside) > 0.5


@pytest.mark.parametrize(("truth", "delay"), [(LEG_TRUTH, 0.0074), (ARM_TRUTH, 0.0021)])
def test_the_weight_of_links_tells_a_gain(tmp_path: Path, truth: Truth, delay: float) -> None:
    path, log = pd_driven.driven(truth, tmp_path, 2, delay=delay, duration=10.0)
    found = jid.identify(log, jid.Robot.from_urdf(path, drive={"kp": "free", "kd": "free"}))
    both = replace(truth, viscous=truth.viscous + truth.kd)  # nothing divides the two
    assert np.abs(errors(found, both)).max() < 0.03
    gains = [joint.parameters["position_gain"] for joint in found.joints.values()]
    assert [each.value for each in gains] == pytest.approx(truth.kp, rel=0.01)
    assert all(
        each.unit == "N·m/rad" and (each.stderr or 9e9) < 0.01 * each.value for each in gains
    )
    assert found.settings["shift"]["reference"] == pytest.approx(delay, abs=2e-4)
    again = jid.RobotEstimate.load(found.save(tmp_path / "found.json"))
    assert again.robot.drive == found.robot.drive
    assert again.predict(log).relative_residual < 0.01


@pytest.mark.parametrize(
    ("gravity", "gains"), [((3.0, -4.0, 8.4546), True), ((1.95, 0.0, -9.6142), False)]
)
def test_the_links_weight_tells_where_gravity_pulls(
    tmp_path: Path, gravity: tuple[float, float, float], gains: bool
) -> None:
    path, log = pd_driven.driven(ARM_TRUTH, tmp_path, 2, duration=10.0, gravity=gravity)
    drive = drive_of(ARM_TRUTH) if gains else {"kp": "free", "kd": "free"}
    robot = jid.Robot.from_urdf(path, drive=drive, gravity="free")
    found = jid.identify(log, robot)
    assert found.robot.tree.gravity == pytest.approx(gravity, abs=0.02)
    assert np.abs(errors(found, ARM_TRUTH)[:, :2]).max() < 0.02
    finding = next(each for each in found.findings if each.code == "gravity_found")
    assert finding.severity == "info"
    assert float(finding.evidence["error"].value) < 1e-3
    again = jid.RobotEstimate.load(found.save(tmp_path / "found.json"))
    assert again.robot.tree.gravity == pytest.approx(found.robot.tree.gravity)


def test_gravity_of_a_robot_with_torques_is_found(tmp_path: Path) -> None:
    path = small_arm.urdf(tmp_path)
    robot = jid.Robot.from_urdf(path, gravity="free")
    found = jid.identify(small_arm.recording(path), robot)
    # Both axes are horizontal and parallel: gravity along them moves nothing.
    assert found.robot.tree.gravity == pytest.approx((0.0, 0.0, -9.81), abs=0.05)
    with pytest.raises(jid.InputError, match='3 numbers or "free"'):
        jid.Robot.from_urdf(path, gravity="down")


def test_a_limit_of_the_torque_is_respected(tmp_path: Path) -> None:
    path, log = pd_driven.driven(ARM_TRUTH, tmp_path, 3, duration=10.0, limit=9.0)
    limited = drive_of(ARM_TRUTH) | {"torque_limits": 9.0}
    found = jid.identify(log, jid.Robot.from_urdf(path, drive=limited))
    other = jid.identify(log, jid.Robot.from_urdf(path, drive=drive_of(ARM_TRUTH)))
    assert np.abs(errors(found, ARM_TRUTH)).max() < 0.05
    assert found.relative_residual < 0.2 * other.relative_residual


def test_the_error_without_gains_says_what_the_facts_need(tmp_path: Path) -> None:
    path, log = pd_driven.driven(LEG_TRUTH, tmp_path, 1, duration=2.0)
    with pytest.raises(jid.InputError, match="the recording has no torque") as caught:
        jid.identify(log, jid.Robot.from_urdf(path))
    text = str(caught.value)
    line = text[text.index("drive = {") : text.index("}") + 1]
    (tmp_path / "facts.toml").write_text(line, encoding="utf-8")
    robot = jid.Robot.from_urdf(path, facts=tmp_path / "facts.toml")
    assert robot.drive is not None
    assert robot.drive.kp == (20.0, 20.0, 20.0)
    assert jid.identify(log, robot).joints.keys() == {"hip", "thigh", "calf"}


def test_it_is_saved_with_the_estimate(tmp_path: Path) -> None:
    path, log = pd_driven.driven(LEG_TRUTH, tmp_path, 1, duration=6.0, delay=0.004)
    robot = jid.Robot.from_urdf(path, drive=LEG_DRIVE | {"torque_limits": [24, 24, 45]})
    found = jid.identify(log, robot)
    again = jid.RobotEstimate.load(found.save(tmp_path / "leg.json"))
    assert again.robot.drive == robot.drive
    assert again.predict(log).relative_residual == pytest.approx(found.relative_residual, rel=0.2)


def test_a_stated_delay_is_taken_and_a_wrong_one_named(tmp_path: Path) -> None:
    path, log = pd_driven.driven(LEG_TRUTH, tmp_path, 2, duration=10.0, delay=0.004)
    right = jid.identify(log, jid.Robot.from_urdf(path, drive=LEG_DRIVE | {"delay": 0.004}))
    assert right.settings["shift"] == {"reference": 0.004}
    assert not [each for each in right.findings if each.code == "signal_lag"]
    wrong = jid.identify(log, jid.Robot.from_urdf(path, drive=LEG_DRIVE | {"delay": 0.008}))
    assert "earlier than stated" in next(e.title for e in wrong.findings if e.code == "signal_lag")


@pytest.mark.parametrize(
    ("drive", "argument"),
    [
        (3.0, "drive"),
        ({"kp": 20}, "drive.kd"),
        ({"kp": [20, 20], "kd": 1}, "drive.kp"),
        ({"kp": -1, "kd": 1}, "drive.kp"),
        ({"kp": "free", "kd": 1}, "drive.kd"),
        ({"kp": "free", "kd": "free", "torque_limits": 5}, "drive.torque_limits"),
        ({"kp": 20, "kd": 1, "hold": "foh"}, "drive.hold"),
        ({"kp": 20, "kd": 1, "delay": 2.0}, "drive.delay"),
        ({"kp": 20, "kd": 1, "ki": 2.0}, "drive.ki"),
    ],
)
def test_a_drive_that_cannot_be_is_refused(tmp_path: Path, drive: Any, argument: str) -> None:
    path = tmp_path / "leg.urdf"
    path.write_text(pd_driven.LEG, encoding="utf-8")
    with pytest.raises(jid.InputError) as caught:
        jid.Robot.from_urdf(path, drive=drive)
    assert caught.value.argument == argument


def test_a_gain_that_the_motion_does_not_show_stays_free(tmp_path: Path) -> None:
    path, log = pd_driven.driven(LEG_TRUTH, tmp_path, 1, duration=6.0)
    assert log.reference is not None
    position, wanted = np.array(log.position), np.array(log.reference)
    position[:, 0] = wanted[:, 0] = position[0, 0]
    still = jid.RobotRecording(time=log.time, position=position, reference=wanted, names=log.names)
    robot = jid.Robot.from_urdf(path, drive={"kp": "free", "kd": "free"})
    found = jid.identify(still, robot)
    assert found.robot.drive is not None
    gains = found.robot.drive.kp
    assert gains[0] is None
    assert gains[1] == pytest.approx(20.0, rel=0.05)
    again = jid.RobotEstimate.from_json(found.to_json())
    assert again.robot.drive == found.robot.drive
    (named,) = [
        each.parameters
        for each in found.findings
        if each.code == "undetermined" and "position gain" in each.title
    ]
    assert named == ("hip.position_gain",)
    with pytest.raises(jid.InputError, match="the gain of hip is free"):
        jid.simulate(found, recordings=still)
    page = jid.save_report(found, tmp_path / "leg.html").read_text("utf-8")
    assert "hip" in page
    with pytest.raises(jid.InputError, match="links give the scale of the torque"):
        jid.identify(still, robot, inertia="free")
