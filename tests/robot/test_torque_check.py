"""Torques that are none: one sign, one factor, a magnitude, degrees are the one finding, before anything is tried."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_arm

import jointid as jid
from jointid.problem.low_pass import low_passed
from jointid.robot import examining
from jointid.robot.links.inertia_modes import Inertia

pytest.importorskip("pinocchio")

Array = np.ndarray[Any, np.dtype[np.float64]]
FRICTION = small_arm.COULOMB, small_arm.VISCOUS
DRIVE: dict[str, Any] = {
    "kp": np.array([300.0, 150.0]),
    "kd": np.array([9.0, 4.0]),
    "hold": "linear",
}
# Neither axes nor weights are symmetric: no mirror image of this arm is the arm.
SKEW = (
    small_arm.URDF.replace(
        '<origin xyz="0 0 -0.4"/><axis xyz="0 1 0"/>',
        '<origin xyz="0 0 -0.4"/><axis xyz="0.6 0.8 0"/>',
    )
    .replace('xyz="0 0 -0.15"', 'xyz="0.1 0.05 -0.1"')
    .replace('xyz="0 0 -0.2"', 'xyz="0.15 0 -0.1"')
)


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return small_arm.urdf(tmp_path_factory.mktemp("skew"), SKEW)


@pytest.fixture(name="run", scope="module")
def _run(path: Path) -> jid.RobotRecording:
    return small_arm.recording(path, duration=8.0)


def changed(
    run: jid.RobotRecording,
    torque: Callable[[Array], Array] = np.array,
    position: Callable[[Array], Array] = np.array,
) -> jid.RobotRecording:
    fields = run.fields()
    made = {"torque": torque(fields["torque"]), "position": position(fields["position"])}
    return jid.RobotRecording(**{**fields, **made})


def only(found: jid.RobotEstimate, code: str) -> dict[str, Any]:
    """The arguments of the advice of the only finding, which blocks."""
    assert [(each.code, each.severity) for each in found.findings] == [(code, "blocking")]
    assert found.verdict.level == "not usable"
    assert found.cross_check is not None
    assert found.cross_check.agrees is None
    return dict(found.findings[0].advice[0].arguments)


@pytest.mark.parametrize("inertia", ["urdf", "scaled", "free"])
@pytest.mark.parametrize(
    ("factors", "scales"),
    [
        ((1 / 14, 1 / 10), (14.0, 10.0)),
        ((25.0, 20.0), (0.04, 0.05)),
        ((-0.01, -0.012), (-100.0, -83.3)),
        ((0.3, 0.3), (3.33, 3.33)),
    ],
)
def test_one_factor_is_named_with_its_remedy(
    run: jid.RobotRecording,
    path: Path,
    inertia: Inertia,
    factors: tuple[float, float],
    scales: tuple[float, float],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def tried(*_: object) -> None:
        raise AssertionError("no delay or fact is tried")

    monkeypatch.setattr(examining, "with_better_velocities", tried)
    monkeypatch.setattr(examining, "diagnosed", tried)
    wrong = changed(run, lambda torque: torque * np.array(factors))
    robot = jid.Robot.from_urdf(path)
    told = only(jid.identify_robot(wrong, robot, inertia=inertia), "scaled_torques")
    assert told["torque_scales"] == pytest.approx(scales, rel=0.02)


@pytest.mark.parametrize(
    ("factors", "code"),
    [((3.0, 3.0), "scaled_torques"), ((1.5, 0.7), "different_factors")],
)
def test_factors_of_a_drive_are_its_gains(
    run: jid.RobotRecording, path: Path, factors: tuple[float, float], code: str
) -> None:
    robot = jid.Robot.from_urdf(path, drive=stiffer(factors))
    found = jid.identify_robot(driven(run), robot)
    told = only(found, code)
    assert "gain" in found.findings[0].details
    for key in ("kp", "kd"):
        np.testing.assert_allclose(np.array(told["drive"][key]), DRIVE[key], rtol=0.02)
    cured = jid.identify_robot(driven(run), jid.Robot.from_urdf(path, **told))
    assert cured.verdict.level == "usable"


def test_stated_scales_of_a_drive_are_part_of_its_gains(
    run: jid.RobotRecording, path: Path
) -> None:
    robot = jid.Robot.from_urdf(path, drive=DRIVE, torque_scales=[4.0, 3.0])
    told = only(jid.identify_robot(driven(run), robot), "scaled_torques")
    assert told["torque_scales"] == [1.0, 1.0]
    np.testing.assert_allclose(np.array(told["drive"]["kp"]), DRIVE["kp"], rtol=0.02)


def test_one_gain_that_is_off_is_advised(run: jid.RobotRecording, path: Path) -> None:
    robot = jid.Robot.from_urdf(path, drive=stiffer((1.0, 1.1)))
    found = jid.identify_robot(driven(run), robot, inertia="urdf")
    (said,) = [each for each in found.findings if each.code == "wrong_torque_scale"]
    assert "gain" in said.details
    told: Any = said.advice[0].arguments["drive"]
    np.testing.assert_allclose(np.array(told["kp"]), DRIVE["kp"], rtol=0.02)


def stiffer(factors: tuple[float, float]) -> dict[str, Any]:
    return {**DRIVE, "kp": DRIVE["kp"] * factors, "kd": DRIVE["kd"] * factors}


def driven(run: jid.RobotRecording) -> jid.RobotRecording:
    """The wanted positions that make a drive push as much."""
    speed = np.gradient(run.position, run.time, axis=0)
    assert run.torque is not None
    wanted = run.position + (run.torque + DRIVE["kd"] * speed) / DRIVE["kp"]
    return jid.RobotRecording(**{**run.fields(), "torque": None, "reference": wanted})


def test_the_remedy_cures(run: jid.RobotRecording, path: Path) -> None:
    amperes = changed(run, lambda torque: torque / np.array([14.0, 10.0]))
    told = only(jid.identify_robot(amperes, jid.Robot.from_urdf(path)), "scaled_torques")
    cured = jid.identify_robot(amperes, jid.Robot.from_urdf(path, **told))
    for joint, coulomb in zip(cured.joints.values(), small_arm.COULOMB, strict=True):
        assert joint.parameters["coulomb"].value == pytest.approx(coulomb, rel=0.05)


@pytest.mark.parametrize("inertia", ["urdf", "free"])
@pytest.mark.parametrize(
    ("torque", "position", "code"),
    [
        (-1.0, 1.0, "reversed_torques"),
        (1.0, -1.0, "reversed_positions"),
        (-1.0, -1.0, "reversed_positions"),
    ],
)
def test_a_sign_of_all_is_named_with_its_remedy(
    run: jid.RobotRecording, path: Path, inertia: Inertia, torque: float, position: float, code: str
) -> None:
    wrong = changed(run, lambda values: torque * values, lambda values: position * values)
    told = only(jid.identify_robot(wrong, jid.Robot.from_urdf(path), inertia=inertia), code)
    cured = jid.identify_robot(wrong, jid.Robot.from_urdf(path, **told), inertia=inertia)
    assert cured.verdict.level == "usable"


@pytest.mark.parametrize("factor", [1.0, 0.08])
@pytest.mark.parametrize("step", [1e-6, 0.05])
def test_a_magnitude_is_named(
    run: jid.RobotRecording, path: Path, factor: float, step: float
) -> None:
    grid = step * factor
    wrong = changed(run, lambda torque: np.round(np.abs(factor * torque) / grid) * grid)
    found = jid.identify_robot(wrong, jid.Robot.from_urdf(path))
    only(found, "unsigned_torque")
    assert found.findings[0].title.startswith("the torques of shoulder and elbow are never")
    assert "shoulder, elbow" in found.findings[0].cause


@pytest.mark.parametrize("size", [1.0, 0.05])
def test_degrees_are_named_however_little_the_arm_moves(path: Path, size: float) -> None:
    """A small motion in degrees stays within twice the range: the links' weight says it."""
    slow = small_arm.recording(path, duration=8.0)
    if size < 1.0:  # a real motion of a few degrees, with torques of its own
        slow = small_motion(path, size)
    found = jid.identify_robot(changed(slow, position=np.degrees), jid.Robot.from_urdf(path))
    assert only(found, "implausible_unit")["units"] == {"position": "deg"}


def small_motion(path: Path, size: float) -> jid.RobotRecording:
    import pinocchio

    model = pinocchio.buildModelFromUrdf(str(path))
    state, time = model.createData(), np.arange(0.0, 8.0, 2e-3)
    phase = np.outer(time, [2.1, 3.3])
    q = 0.6 + size * np.sin(phase)
    v, a = size * np.cos(phase) * [2.1, 3.3], -size * np.sin(phase) * np.square([2.1, 3.3])
    torque = np.array([pinocchio.rnea(model, state, *each) for each in zip(q, v, a, strict=True)])
    torque += small_arm.ROTOR * a + FRICTION[0] * np.sign(v) + FRICTION[1] * v
    return jid.RobotRecording(time=time, position=q, torque=torque, names=("shoulder", "elbow"))


@pytest.mark.parametrize(
    ("was", "is_now"),
    [
        ('mass value="3"', 'mass value="4"'),
        ('mass value="3"', 'mass value="1"'),
        ('mass value="5"', 'mass value="3.6"'),
        ('mass value="3"', 'mass value="6"'),
    ],
)
def test_a_link_that_weighs_otherwise_is_no_factor(
    run: jid.RobotRecording, tmp_path: Path, was: str, is_now: str
) -> None:
    robot = jid.Robot.from_urdf(small_arm.urdf(tmp_path, SKEW.replace(was, is_now)))
    assert all(each.severity != "blocking" for each in jid.identify_robot(run, robot).findings)


@pytest.mark.parametrize("share", [0.7, 1.3])
def test_a_urdf_that_is_off_by_a_third_is_none(
    run: jid.RobotRecording, tmp_path: Path, share: float
) -> None:
    light = SKEW.replace('mass value="3"', f'mass value="{3 * share}"')
    light = light.replace('mass value="5"', f'mass value="{5 * share}"')
    found = jid.identify_robot(run, jid.Robot.from_urdf(small_arm.urdf(tmp_path, light)))
    assert all(each.severity != "blocking" for each in found.findings)


def test_friction_may_be_larger_than_the_weight(run: jid.RobotRecording, path: Path) -> None:
    speed = np.gradient(run.position, run.time, axis=0)
    more = np.array([60.0, 30.0]) * np.sign(speed) + np.array([20.0, 9.0]) * speed
    found = jid.identify_robot(
        changed(run, lambda torque: torque + more), jid.Robot.from_urdf(path)
    )
    assert found.verdict.level == "usable"


def test_a_torque_that_weight_holds_above_zero_is_no_magnitude(path: Path) -> None:
    """A joint that holds a load to one side, with little friction, never needs a negative torque."""
    run = small_motion(path, 0.2)
    speed = np.gradient(run.position, run.time, axis=0)
    assert run.torque is not None
    torque = run.torque - 0.95 * (FRICTION[0] * np.sign(speed) + FRICTION[1] * speed)
    one_sided = jid.RobotRecording(**{**run.fields(), "torque": torque})
    assert torque[:, 0].max() < 0.0 or torque[:, 0].min() > 0.0
    found = jid.identify_robot(one_sided, jid.Robot.from_urdf(path))
    assert all(each.code != "unsigned_torque" for each in found.findings)


def test_the_filter_delays_nothing() -> None:
    time = np.linspace(0.0, 1.0, 2001)
    ramp = low_passed(5.0 * time - 2.0, 101)
    np.testing.assert_allclose(ramp[200:-200], (5.0 * time - 2.0)[200:-200], atol=1e-12)
    impulse = low_passed(np.eye(1, 301, 150)[0], 20)
    assert impulse.sum() == pytest.approx(1.0)
    np.testing.assert_allclose(impulse, impulse[::-1], atol=1e-15)
