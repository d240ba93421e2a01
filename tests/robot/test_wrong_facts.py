"""A given fact that is wrong is named by its cause, with the call that has it right; what follows from it is not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from simulated_arm import JOINTS, URDF, Arm, Run, Sensors, random_arm, random_motion, recorded, run

import jointid as jid
from jointid.estimate.findings import Finding
from jointid.robot.inertia import Inertia

pinocchio = pytest.importorskip("pinocchio")

SEED = 2


def ran(change: Callable[[Arm], Arm] = lambda arm: arm) -> jid.RobotRecording:
    arm = change(random_arm(SEED, stribeck=False))
    return recorded(of(arm), Sensors(velocity_delay=None), SEED)


def of(arm: Arm) -> Run:
    return run(arm, random_motion(SEED, duration=10.0))


@pytest.fixture(name="clean", scope="module")
def _clean() -> jid.RobotRecording:
    return ran()


def changed(
    recording: jid.RobotRecording, signal: str, joint: int, factor: float = 1.0, shift: float = 0.0
) -> jid.RobotRecording:
    fields = recording.fields()
    values = np.array(fields[signal])
    values[:, joint - 1] = factor * values[:, joint - 1] + shift
    return jid.RobotRecording(**{**fields, signal: values})


def identified(
    recording: jid.RobotRecording, inertia: Inertia = "urdf", **facts: Any
) -> jid.RobotEstimate:
    return jid.identify_robot(
        recording, jid.Robot.from_urdf(URDF, **facts), inertia=inertia, model="coulomb_viscous"
    )


def only(found: jid.RobotEstimate, code: str) -> Finding:
    """The only warning."""
    assert [each.code for each in found.warnings] == [code], found.findings
    return found.warnings[0]


@pytest.mark.parametrize("inertia", ["urdf", "scaled", "free"])
def test_nothing_is_said_of_right_facts(clean: jid.RobotRecording, inertia: Inertia) -> None:
    assert identified(clean, inertia).warnings == ()


@pytest.fixture(scope="module")
def tilted() -> jid.RobotRecording:
    def change(arm: Arm) -> Arm:
        model = pinocchio.Model(arm.model)
        model.gravity.linear = 9.81 * np.array([np.sin(0.15), 0.0, -np.cos(0.15)])
        return replace(arm, model=model)

    return ran(change)


@pytest.mark.parametrize("inertia", ["urdf", "free"])
def test_a_tilted_base_is_named_and_cured(tilted: jid.RobotRecording, inertia: Inertia) -> None:
    said = only(identified(tilted, inertia), "tilted_base")
    assert said.evidence["tilt"].value == pytest.approx(np.rad2deg(0.15), abs=0.3)
    assert said.evidence["share"].value > 0.3
    (advice,) = said.advice
    assert advice.function == "Robot.from_urdf"
    cured = identified(tilted, inertia, **advice.arguments)
    assert cured.warnings == ()
    assert cured.relative_residual < 0.01


@pytest.mark.parametrize("inertia", ["urdf", "free"])
def test_a_wrong_torque_constant_is_named(clean: jid.RobotRecording, inertia: Inertia) -> None:
    recording = changed(clean, "torque", 4, 1.1)
    said = only(identified(recording, inertia), "wrong_torque_scale")
    assert "joint_4" in said.cause
    assert said.evidence["scale"].value == pytest.approx(1.1, abs=0.02)
    (advice,) = said.advice
    assert identified(recording, inertia, **advice.arguments).warnings == ()


def test_a_zero_that_is_off_is_named(clean: jid.RobotRecording) -> None:
    recording = changed(clean, "position", 2, shift=np.deg2rad(5.0))
    said = only(identified(recording), "wrong_zero")
    assert said.evidence["offset"].value == pytest.approx(-np.deg2rad(5.0), abs=0.005)
    (advice,) = said.advice
    assert identified(recording, **advice.arguments).warnings == ()


def loaded(arm: Arm) -> Arm:
    model = pinocchio.Model(arm.model)
    body = pinocchio.Inertia(1.0, np.array([0.02, 0.0, 0.15]), 0.002 * np.eye(3))
    model.inertias[JOINTS] = model.inertias[JOINTS] + body
    return replace(arm, model=model)


def test_a_payload_is_named_with_its_mass() -> None:
    said = only(identified(ran(loaded)), "payload")
    assert said.evidence["mass"].value == pytest.approx(1.0, abs=0.05)
    assert "inertia='free'" in str(said)


def moved_centre(arm: Arm) -> Arm:
    model = pinocchio.Model(arm.model)
    was = model.inertias[3]
    lever = was.lever + np.array([0.0, 0.02, 0.0])
    model.inertias[3] = pinocchio.Inertia(was.mass, lever, was.inertia)
    return replace(arm, model=model)


def test_a_centre_of_mass_that_is_elsewhere_is_named() -> None:
    """Along y of link 3, which is where link 4's axis z points: it may be either's."""
    said = only(identified(ran(moved_centre)), "wrong_centre")
    assert "joint_3" in said.cause
    assert "joint_4" in said.cause
    way = np.linalg.norm([said.evidence[axis].value for axis in "xyz"])
    assert way == pytest.approx(0.02, abs=0.003)


@pytest.mark.parametrize(
    ("signals", "code", "facts"),
    [
        (("torque",), "wrong_torque_sign", {"torque_scales"}),
        (("position",), "wrong_motion_sign", {"directions", "torque_scales"}),
    ],
)
def test_a_sign_is_named_and_its_consequences_are_not_warned_of(
    clean: jid.RobotRecording, signals: tuple[str, ...], code: str, facts: set[str]
) -> None:
    recording = clean
    for signal in signals:
        recording = changed(recording, signal, 5, -1.0)
    found = identified(recording)
    said = only(found, code)
    assert "joint_5" in said.cause
    told = next(each for each in found.findings if each.code == "consequences")
    assert told.severity == "info"
    assert "at_bound" in told.cause
    (advice,) = said.advice
    assert set(advice.arguments) == facts
    assert identified(recording, **advice.arguments).warnings == ()


def test_a_sign_is_no_coupling_beside_static_friction() -> None:
    """A joint whose torque has the wrong sign leaves free inertias far off; a coupling is not better for it."""
    arm = random_arm(0)
    whole = recorded(run(arm, random_motion(0, duration=10.0)), Sensors(), 0)
    found = identified(changed(whole, "torque", 5, -1.0))
    assert found.warnings[0].code == "wrong_torque_sign"


def test_two_wrong_facts_are_both_named(clean: jid.RobotRecording) -> None:
    order = [0, 1, 3, 2, *range(4, JOINTS)]
    fields = clean.fields()
    swapped = {name: fields[name][:, order] for name in ("position", "torque")}
    recording = changed(jid.RobotRecording(**{**fields, **swapped}), "torque", 5, -1.0)
    found = identified(recording)
    assert {each.code for each in found.warnings} == {"swapped_joints", "wrong_torque_sign"}
    several = next(each for each in found.findings if each.code == "several_wrong_facts")
    assert several.evidence["after"].value < 0.01


@pytest.mark.parametrize("options", [{"torque_scales": [0.0] * 7}, {"directions": [2.0] * 7}])
def test_factors_that_cannot_be_are_refused(options: dict[str, list[float]]) -> None:
    with pytest.raises(jid.InputError) as refused:
        jid.Robot.from_urdf(URDF, **options)  # type: ignore[arg-type]
    assert refused.value.argument == next(iter(options))
