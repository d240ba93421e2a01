"""A plain filtered least squares beside every robot's identification, and what is not examined."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_arm

import jointid as jid
from jointid.robot.facts.named_causes import CAUSES
from jointid.robot.motion import motion
from jointid.robot.motion.noisy_samples import quiet_velocity

pytest.importorskip("pinocchio")

Array = np.ndarray[Any, np.dtype[np.float64]]


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return small_arm.urdf(tmp_path_factory.mktemp("arm"))


@pytest.fixture(name="run", scope="module")
def _run(path: Path) -> jid.RobotRecording:
    return small_arm.recording(path)


@pytest.fixture(name="robot", scope="module")
def _robot(path: Path) -> jid.Robot:
    return jid.Robot.from_urdf(path)


def speed_of(run: jid.RobotRecording) -> Array:
    return np.asarray(np.gradient(run.position, run.time, axis=0))


def pushed(run: jid.RobotRecording, more: Array) -> jid.RobotRecording:
    """With a further torque."""
    return jid.RobotRecording(**{**run.fields(), "torque": np.asarray(run.torque) + more})


def right(found: jid.RobotEstimate) -> bool:
    """Whether friction is within 5 % or its interval."""

    def holds(p: Any, truth: float) -> bool:
        inside = p.interval is not None and p.interval[0] < truth < p.interval[1]
        return bool(inside or abs(p.value / truth - 1.0) < 0.05)

    return all(
        holds(joint.parameters[name], truth)
        for name, truths in (("coulomb", small_arm.COULOMB), ("viscous", small_arm.VISCOUS))
        for joint, truth in zip(found.joints.values(), truths, strict=True)
    )


@pytest.mark.parametrize("inertia", ["urdf", "scaled", "free"])
@pytest.mark.parametrize("static", [0.0, 0.4])
def test_both_looks_agree_on_a_good_recording(path: Path, inertia: Any, static: float) -> None:
    run = small_arm.recording(path, static=static, duration=8.0)
    found = jid.identify_robot(run, jid.Robot.from_urdf(path), inertia=inertia)
    check = found.cross_check
    assert check is not None
    assert (check.agrees, check.reason) == (True, "")
    both = check.parameters["elbow.viscous"]
    assert both.agrees is True
    assert both.second == pytest.approx(1.5, rel=0.02)
    assert "cross-check" in found.report(verbose=True)
    again = jid.RobotEstimate.from_json(found.to_json())
    assert again.cross_check == check
    assert found.verdict.level == "usable"


def late(run: jid.RobotRecording, lost: float, lateness: float, seed: int) -> jid.RobotRecording:
    """Rows that a busy host stamps late by chance, some of them lost; with a good velocity."""
    rng = np.random.default_rng(seed)
    kept = np.sort(rng.choice(run.samples, int((1.0 - lost) * run.samples), replace=False))
    stamps = run.time[kept] + rng.exponential(lateness, kept.size)
    stamps = np.maximum.accumulate(stamps) + 1e-9 * np.arange(kept.size)
    velocity = speed_of(run)[kept] + rng.normal(0.0, 1e-3, (kept.size, 2))
    fields = {**run.fields(), "time": stamps, "velocity": velocity}
    fields |= {name: fields[name][kept] for name in ("position", "torque")}
    return jid.RobotRecording(**fields)


@pytest.mark.parametrize(("lost", "lateness"), [(0.01, 1e-4), (0.02, 1e-4), (0.2, 3e-4)])
def test_late_stamps_with_lost_rows_are_right_or_not_usable(
    run: jid.RobotRecording, robot: jid.Robot, lost: float, lateness: float
) -> None:
    found = jid.identify_robot(late(run, lost, lateness, seed=3), robot)
    assert right(found) or found.verdict.level == "not usable"
    check = found.cross_check
    assert check is not None
    seconds = [check.parameters[f"{name}.viscous"].second for name in found.joints]
    for second, truth in zip(seconds, small_arm.VISCOUS, strict=True):
        assert second is None or second == pytest.approx(truth, rel=0.03)


def test_stamps_that_hide_all_motion_are_refused(run: jid.RobotRecording, robot: jid.Robot) -> None:
    with pytest.raises(jid.InputError, match=r"noise of its velocity.*time stamps"):
        jid.identify_robot(late(run, 0.06, 2e-3, seed=3), robot)


def test_a_handling_that_is_wrong_is_caught(
    run: jid.RobotRecording, robot: jid.Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The two looks share no velocity: halve the identification's, and its values are not supported."""
    monkeypatch.setattr(motion, "quiet_velocity", lambda *of: 0.8 * quiet_velocity(*of))
    found = jid.identify_robot(run, robot)
    (said,) = [each for each in found.findings if each.code == "cross_check"]
    assert said.severity == "blocking"
    assert found.verdict.level == "not usable"


def test_a_torque_delay_is_not_taken_for_a_disagreement(
    run: jid.RobotRecording, robot: jid.Robot
) -> None:
    assert run.torque is not None
    moved = [np.interp(run.time - 0.006, run.time, each) for each in run.torque.T]
    found = jid.identify_robot(
        jid.RobotRecording(**{**run.fields(), "torque": np.column_stack(moved)}), robot
    )
    assert found.cross_check is not None
    assert found.cross_check.agrees is True


def test_a_short_motion_has_no_second_look(path: Path, robot: jid.Robot) -> None:
    found = jid.identify_robot(small_arm.recording(path, duration=0.4), robot)
    assert found.cross_check is not None
    assert found.cross_check.agrees is None
    assert found.cross_check.reason
    assert all(each.code != "cross_check" for each in found.findings)


def rising(width: float) -> Callable[[jid.RobotRecording], Array]:
    def more(run: jid.RobotRecording) -> Array:
        speed = speed_of(run)
        return np.asarray(small_arm.COULOMB * (np.tanh(speed / width) - np.sign(speed)))

    return more


def loaded(share: float) -> Callable[[jid.RobotRecording], Array]:
    def more(run: jid.RobotRecording) -> Array:
        speed = speed_of(run)
        friction = small_arm.COULOMB * np.sign(speed) + small_arm.VISCOUS * speed
        assert run.torque is not None
        links = run.torque - friction
        return np.asarray(share * np.abs(links) * np.sign(speed))

    return more


def sprung(size: float, joint: int) -> Callable[[jid.RobotRecording], Array]:
    def more(run: jid.RobotRecording) -> Array:
        found = np.zeros_like(run.position)
        found[:, joint] = size * np.sin(2.0 * run.position[:, joint] + 0.3)
        return found

    return more


def warming(run: jid.RobotRecording) -> Array:
    share = np.exp(-run.time / 6.0)[:, None] - 0.5
    return np.asarray(0.8 * share * small_arm.VISCOUS * speed_of(run))


@pytest.mark.parametrize(
    ("fault", "cause"),
    [
        *((rising(width), "smooth_friction") for width in (0.05, 0.1, 0.2)),
        *((loaded(share), "load_friction") for share in (0.05, 0.15, 0.3)),
        *((sprung(*each), "") for each in ((6.0, 0), (3.0, 1), (15.0, 0))),
        (warming, "drift"),
    ],
)
@pytest.mark.parametrize("inertia", ["urdf", pytest.param("free", marks=pytest.mark.slow)])
def test_a_cause_is_named_or_what_is_not_examined_is_listed_and_needs_care(
    run: jid.RobotRecording, robot: jid.Robot, inertia: Any, fault: Callable[..., Array], cause: str
) -> None:
    found = jid.identify_robot(pushed(run, fault(run)), robot, inertia=inertia)
    names = (cause,) if cause else ("unexamined_causes", "harmonic")
    told = [each for each in found.findings if each.code in names]
    assert told
    if found.verdict.level == "usable":  # the free links take most of a spring
        assert (cause, inertia) == ("", "free")
        coulomb = [joint.parameters["coulomb"].value for joint in found.joints.values()]
        assert coulomb == pytest.approx(small_arm.COULOMB, abs=0.05)
    assert all(each in finding.cause for finding in told for each in CAUSES)
    if cause:
        assert {each.parameters[0].split(".")[0] for each in told} == set(found.joints)
        assert "unexamined_causes" not in {each.code for each in found.findings}


def test_what_no_motion_shows_is_not_printed(run: jid.RobotRecording, robot: jid.Robot) -> None:
    """A spring looks like another centre of mass, which has any place along the joint's axis."""
    found = jid.identify_robot(pushed(run, sprung(15.0, 0)(run)), robot)
    sizes = [
        e.value
        for each in found.findings
        if each.code == "wrong_centre"
        for e in each.evidence.values()
    ]
    assert all(abs(each) < 100.0 for each in sizes)
