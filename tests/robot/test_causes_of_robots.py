"""Causes of a misfit of a robot's joint: as those of a single joint, with the rest of the robot held."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import small_arm

import jointid as jid
from jointid.estimate.causes import Cause, Causes
from jointid.robot.facts import unexamined_causes
from jointid.robot.facts.named_causes import causes_of_joint
from jointid.robot.fit.attempt import Request, attempted

pytest.importorskip("pinocchio")


@pytest.fixture(name="robot", scope="module")
def _robot(tmp_path_factory: pytest.TempPathFactory) -> jid.Robot:
    return jid.Robot.from_urdf(small_arm.urdf(tmp_path_factory.mktemp("causes")))


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return small_arm.urdf(tmp_path_factory.mktemp("causes"))


def test_friction_under_load_has_its_size_and_its_joint(path: Path, robot: jid.Robot) -> None:
    run = small_arm.recording(path, under_load=(0.0, 0.15))
    found = jid.identify_robot(run, robot)
    (told,) = found.warnings
    assert told.code == "load_friction"
    assert told.title.startswith("elbow: friction that grows with the load (0.15 of the load)")
    assert told.evidence["coefficient"].value == pytest.approx(0.15, abs=0.01)
    # What it moves is what it moved.
    coulomb = found.joints["elbow"].parameters["coulomb"].value
    moved = 1.0 + told.evidence["coulomb.shift"].value
    assert coulomb * moved == pytest.approx(small_arm.COULOMB[1], rel=0.01)
    assert all(name.startswith("elbow.") for name in told.parameters)
    (call,) = told.advice
    assert call.arguments == {"model": {"elbow": "auto:load_friction"}}


def test_the_advice_against_slow_motion_runs(path: Path, robot: jid.Robot) -> None:
    run = small_arm.recording(path, static=0.5)
    found = jid.identify_robot(run, robot, model="coulomb_viscous")
    told = [each for each in found.warnings if each.code == "slow_motion"]
    advice = told[0].advice[0]
    assert advice.function == "compare_robot_models"
    compared = jid.compare_robot_models(run, robot, inertia="urdf", folds=3, **advice.arguments)
    assert set(compared.models.values()) <= set(advice.arguments["models"])


def test_a_joint_that_fits_badly_has_no_causes(path: Path, robot: jid.Robot) -> None:
    """Something that was given is wrong there: what explains it is chance."""
    run = small_arm.recording(path)
    fields = run.fields()
    push = np.zeros_like(run.position)
    push[:, 1] = 3.0 * np.sin(2.0 * run.position[:, 1] + 0.3)
    fields["torque"] = fields["torque"] + push
    found = jid.identify_robot(jid.RobotRecording(**fields), robot)
    codes = {each.code for each in found.warnings}
    assert {"poor_fit", "unexamined_causes"} <= codes
    assert "harmonic" not in codes


@pytest.mark.parametrize(("share", "listed"), [(0.51, False), (0.49, True)])
def test_what_is_half_explained_is_no_longer_listed(
    path: Path, robot: jid.Robot, monkeypatch: pytest.MonkeyPatch, share: float, listed: bool
) -> None:
    cause = Cause(name="drift", share=share, scale=0.1, relative={"viscous": 0.1})
    monkeypatch.setattr(unexamined_causes, "causes_of_joint", lambda *_: Causes(found=(cause,)))
    run = small_arm.recording(path, static=0.5)
    found = jid.identify_robot(run, robot, model="coulomb_viscous")
    codes = {each.code for each in found.warnings}
    assert codes == {"drift", *(["unexamined_causes"] if listed else [])}


@pytest.mark.parametrize(
    ("shares", "listed"), [((0.6,), False), ((0.3, 0.4), False), ((0.2, 0.3), True)]
)
def test_what_harmless_causes_explain_is_not_listed(
    path: Path,
    robot: jid.Robot,
    monkeypatch: pytest.MonkeyPatch,
    shares: tuple[float, ...],
    listed: bool,
) -> None:
    causes = tuple(
        Cause(name="disturbance", share=share, scale=0.1, harmful=False) for share in shares
    )
    found = Causes(found=(), harmless=causes)
    monkeypatch.setattr(unexamined_causes, "causes_of_joint", lambda *_: found)
    run = small_arm.recording(path, static=0.5)
    estimate = jid.identify_robot(run, robot, model="coulomb_viscous")
    codes = {each.code for each in estimate.warnings}
    assert codes == ({"unexamined_causes"} if listed else set())


def test_a_joint_that_stands_in_the_excerpts_has_no_causes(path: Path, robot: jid.Robot) -> None:
    request = Request(
        inertia="urdf",
        models=("auto", "auto"),
        windows=None,
        slowest=np.zeros(2),
        mask_standstill=True,
    )
    attempt = attempted([small_arm.recording(path)], robot, request, np.zeros(2))
    assert causes_of_joint(attempt, "elbow").tried
    assert not causes_of_joint(replace(attempt, excerpts={}), "elbow").tried


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("static", [0.0, 0.5])
def test_a_clean_arm_has_none(path: Path, robot: jid.Robot, seed: int, static: float) -> None:
    run = small_arm.recording(path, seed=seed, static=static)
    assert jid.identify_robot(run, robot).warnings == ()


def test_a_fault_outside_the_excerpts_is_not_blamed_on_friction(
    path: Path, robot: jid.Robot
) -> None:
    """The first recordings alone are looked at: what they do not show has no name."""
    runs = [small_arm.recording(path, duration=6.0, seed=seed) for seed in range(6)]
    fields = runs[-1].fields()
    fields["torque"] = fields["torque"].copy()
    fields["torque"][:, 1] += 1.0
    found = jid.identify_robot([*runs[:-1], jid.RobotRecording(**fields)], robot)
    assert {each.code for each in found.warnings} == {"unexamined_causes"}


def test_a_delay_that_is_left_is_not_named_as_friction(path: Path, robot: jid.Robot) -> None:
    run = small_arm.recording(path)
    fields = run.fields()
    fields["torque"] = np.roll(fields["torque"], 8, axis=0)
    found = jid.identify_robot(jid.RobotRecording(**fields), robot, shift={})
    codes = {each.code for each in found.warnings}
    assert "signal_lag" in codes
    assert not {"presliding", "slow_motion"} & codes
