"""Friction that rises smoothly with the speed: named with its speed, and identified by the call that is advised."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import small_arm
from numpy.typing import NDArray

import jointid as jid

pytest.importorskip("pinocchio")

Array = NDArray[np.float64]
SMOOTH = "smooth_coulomb_viscous"
RISES: dict[str, Callable[[Array], Array]] = {
    "tanh": np.tanh,
    # Other shapes than the model's: the root has long tails, the error function hardly any.
    "root": lambda x: np.asarray(x / np.sqrt(1.0 + x**2)),
    "sigmoid of two": lambda x: np.asarray(
        np.clip(x, -1.0, 1.0) * (1.5 - 0.5 * np.clip(x, -1, 1) ** 2)
    ),
}


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return small_arm.urdf(tmp_path_factory.mktemp("smooth"))


def rising(path: Path, shape: str, width: tuple[float, float], seed: int = 0) -> jid.RobotRecording:
    """The arm with Coulomb friction that rises over some speeds of both joints."""

    def friction(speed: Array) -> Array:
        return small_arm.COULOMB * RISES[shape](speed / width) + small_arm.VISCOUS * speed

    return small_arm.recording(path, friction=friction, seed=seed)


def coulomb(found: jid.RobotEstimate) -> Array:
    return np.array([joint.parameters["coulomb"].value for joint in found.joints.values()])


@pytest.mark.parametrize("shape", [each for each in RISES if each != "root"])
@pytest.mark.parametrize("width", [(0.15, 0.1), (0.06, 0.2)])
@pytest.mark.parametrize("seed", [0, 3])
def test_the_call_that_the_finding_advises_is_right(
    path: Path, shape: str, width: tuple[float, float], seed: int
) -> None:
    run, robot = rising(path, shape, width, seed), jid.Robot.from_urdf(path)
    found = jid.identify_robot(run, robot)
    told = [each for each in found.warnings if each.code == "smooth_friction"]
    assert told, found.report(verbose=True)
    assert all("speed" in each.evidence for each in told)
    assert found.verdict.level == "usable with care"
    again = jid.identify_robot(run, robot, **told[0].advice[0].arguments)
    assert np.abs(coulomb(again) / small_arm.COULOMB - 1.0).max() < 0.03
    assert "cross_check" not in {each.code for each in again.warnings}


def test_another_law_is_at_least_nearer(path: Path) -> None:
    """With long tails part of the Coulomb friction looks like viscous friction: the model is another one."""
    run, robot = rising(path, "root", (0.15, 0.1)), jid.Robot.from_urdf(path)
    plain, smooth = (
        np.abs(coulomb(jid.identify_robot(run, robot, model=model)) / small_arm.COULOMB - 1.0)
        for model in ("coulomb_viscous", SMOOTH)
    )
    assert np.all(smooth < 0.5 * plain)
    assert smooth.max() < 0.09


def test_the_rise_is_identified(path: Path) -> None:
    width = (0.15, 0.08)
    run = rising(path, "tanh", width)
    found = jid.identify_robot(run, jid.Robot.from_urdf(path), model=SMOOTH)
    assert found.verdict.level == "usable"
    assert coulomb(found) == pytest.approx(small_arm.COULOMB, rel=0.01)
    values = [joint.parameters["rise_velocity"] for joint in found.joints.values()]
    assert [p.value for p in values] == pytest.approx(width, rel=0.03)
    assert [p.unit for p in values] == ["rad/s", "rad/s"]
    assert found.cross_check is not None
    assert found.cross_check.agrees


@pytest.mark.parametrize("seed", range(3))
def test_an_arm_without_it_keeps_its_values(path: Path, seed: int) -> None:
    run, robot = small_arm.recording(path, seed=seed), jid.Robot.from_urdf(path)
    assert "smooth_friction" not in {f.code for f in jid.identify_robot(run, robot).findings}
    found = jid.identify_robot(run, robot, model=SMOOTH)
    assert coulomb(found) == pytest.approx(small_arm.COULOMB, rel=0.03)


def test_both_kinds_of_friction_are_advised_together(path: Path) -> None:
    """One joint with each: one call for both."""

    def friction(speed: Array) -> Array:
        shoulder = small_arm.COULOMB[0] * np.tanh(speed[:, 0] / 0.15)
        elbow = small_arm.COULOMB[1] * np.sign(speed[:, 1])
        return np.column_stack([shoulder, elbow]) + small_arm.VISCOUS * speed

    run = small_arm.recording(path, friction=friction, under_load=(0.0, 0.2))
    robot = jid.Robot.from_urdf(path)
    found = jid.identify_robot(run, robot)
    advised = {found.code: found.advice[0].arguments for found in found.warnings}
    models = {"shoulder": SMOOTH, "elbow": "auto:load_friction"}
    assert advised == {code: {"model": models} for code in ("smooth_friction", "load_friction")}
    again = jid.identify_robot(run, robot, model=models)
    assert coulomb(again) == pytest.approx(small_arm.COULOMB, rel=0.03)
