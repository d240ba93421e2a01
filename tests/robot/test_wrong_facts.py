"""A given fact that is wrong is named by its cause, with the call that has it right; what follows from it is not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_arm
from simulated_arm import JOINTS, URDF, Arm, Run, Sensors, random_arm, random_motion, recorded, run

import jointid as jid
from jointid.estimate.findings import Finding
from jointid.robot.links.inertia_modes import Inertia

pinocchio = pytest.importorskip("pinocchio")

SEED = 2


def ran(change: Callable[[Arm], Arm] = lambda arm: arm) -> jid.RobotRecording:
    arm = change(random_arm(SEED, stribeck=False))
    return recorded(of(arm), Sensors(velocity_delay=None), SEED)


def of(arm: Arm) -> Run:
    return run(arm, random_motion(SEED, duration=6.0))


@pytest.fixture(name="clean", scope="module")
def _clean() -> jid.RobotRecording:
    return ran()


@dataclass(frozen=True)
class Situation:
    """What a fact is made wrong of: a recording, and joints, the first of which is 1."""

    recording: jid.RobotRecording
    urdf: Path
    joint: int
    pair: tuple[int, int]


@pytest.fixture(params=["two joints", pytest.param("seven joints", marks=pytest.mark.slow)])
def situation(request: pytest.FixtureRequest, tmp_path: Path) -> Situation:
    if request.param == "seven joints":
        return Situation(request.getfixturevalue("clean"), URDF, joint=5, pair=(3, 4))
    urdf = small_arm.urdf(tmp_path)
    return Situation(small_arm.recording(urdf), urdf, joint=2, pair=(1, 2))


def changed(
    recording: jid.RobotRecording, signal: str, joint: int, factor: float = 1.0, shift: float = 0.0
) -> jid.RobotRecording:
    fields = recording.fields()
    values = np.array(fields[signal])
    values[:, joint - 1] = factor * values[:, joint - 1] + shift
    return jid.RobotRecording(**{**fields, signal: values})


def identified(
    recording: jid.RobotRecording, inertia: Inertia = "urdf", urdf: Path = URDF, **facts: Any
) -> jid.RobotEstimate:
    return jid.identify_robot(
        recording, jid.Robot.from_urdf(urdf, **facts), inertia=inertia, model="coulomb_viscous"
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


@pytest.mark.parametrize("inertia", ["urdf", pytest.param("free", marks=pytest.mark.slow)])
def test_a_tilted_base_is_named_and_cured(tilted: jid.RobotRecording, inertia: Inertia) -> None:
    said = only(identified(tilted, inertia), "tilted_base")
    assert said.evidence["tilt"].value == pytest.approx(np.rad2deg(0.15), abs=0.3)
    assert said.evidence["share"].value > 0.3
    (advice,) = said.advice
    assert advice.function == "Robot.from_urdf"
    cured = identified(tilted, inertia, **advice.arguments)
    assert cured.warnings == ()
    assert cured.relative_residual < 0.01


@pytest.mark.parametrize("inertia", ["urdf", pytest.param("free", marks=pytest.mark.slow)])
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


TOOL = """<link name="tool"><inertial><mass value="1"/><origin xyz="0.05 0 -0.1"/>
  <inertia ixx="0.002" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0.002"/></inertial></link>
<joint name="fixed" type="fixed"><parent link="lower"/><child link="tool"/><origin xyz="0 0 -0.2"/>
</joint></robot>"""


@pytest.mark.parametrize(
    ("given", "true", "code", "evidence"),
    [
        ("</robot>", TOOL, "payload", {"mass": 1.0}),
        ('mass value="3"', 'mass value="4"', "wrong_inertia", {"scale": 4.0 / 3.0}),
        ('xyz="0 0 -0.2"', 'xyz="0.03 0 -0.2"', "wrong_centre", {"x": 0.03, "z": 0.0}),
    ],
)
def test_a_body_that_is_otherwise_is_named(
    tmp_path: Path, given: str, true: str, code: str, evidence: dict[str, float]
) -> None:
    recording = small_arm.recording(
        small_arm.urdf(tmp_path, small_arm.URDF.replace(given, true, 1))
    )
    said = only(identified(recording, urdf=small_arm.urdf(tmp_path)), code)
    for name, value in evidence.items():
        assert said.evidence[name].value == pytest.approx(value, rel=0.05, abs=0.003)
    assert ("inertia='free'" in str(said)) == (code != "wrong_inertia")


@pytest.mark.slow
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


@pytest.mark.slow
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
    situation: Situation, signals: tuple[str, ...], code: str, facts: set[str]
) -> None:
    recording = situation.recording
    for signal in signals:
        recording = changed(recording, signal, situation.joint, -1.0)
    found = identified(recording, urdf=situation.urdf)
    said = only(found, code)
    assert recording.names[situation.joint - 1] in said.cause
    told = next(each for each in found.findings if each.code == "consequences")
    assert told.severity == "info"
    assert "at_bound" in told.cause
    (advice,) = said.advice
    assert set(advice.arguments) == facts
    assert identified(recording, urdf=situation.urdf, **advice.arguments).warnings == ()


@pytest.mark.slow
def test_a_sign_is_no_coupling_beside_static_friction() -> None:
    """A joint whose torque has the wrong sign leaves free inertias far off; a coupling is not better for it."""
    arm = random_arm(0)
    whole = recorded(run(arm, random_motion(0, duration=10.0)), Sensors(), 0)
    found = identified(changed(whole, "torque", 5, -1.0))
    assert found.warnings[0].code == "wrong_torque_sign"


@pytest.mark.parametrize(
    ("signals", "code"),
    [(("position", "torque"), "swapped_joints"), (("torque",), "swapped_torques")],
)
def test_two_wrong_facts_are_both_named(
    situation: Situation, signals: tuple[str, ...], code: str
) -> None:
    fields = situation.recording.fields()
    pair = [joint - 1 for joint in situation.pair]
    for signal in signals:
        fields[signal] = np.array(fields[signal])
        fields[signal][:, pair] = fields[signal][:, pair[::-1]]
    recording = changed(jid.RobotRecording(**fields), "torque", situation.joint, -1.0)
    found = identified(recording, urdf=situation.urdf)
    named = {each.code for each in found.warnings}
    if code == "swapped_torques" and named == {code}:  # an order ends the diagnosis
        ordered = changed(situation.recording, "torque", situation.joint, -1.0)
        found = identified(ordered, urdf=situation.urdf)
        assert {each.code for each in found.warnings} == {"wrong_torque_sign"}
        return
    assert named == {code, "wrong_torque_sign"}
    several = next(each for each in found.findings if each.code == "several_wrong_facts")
    assert several.evidence["after"].value < 0.01


@pytest.mark.parametrize("options", [{"torque_scales": [0.0] * 7}, {"directions": [2.0] * 7}])
def test_factors_that_cannot_be_are_refused(options: dict[str, list[float]]) -> None:
    with pytest.raises(jid.InputError) as refused:
        jid.Robot.from_urdf(URDF, **options)  # type: ignore[arg-type]
    assert refused.value.argument == next(iter(options))


@pytest.mark.parametrize(
    ("stated", "right"),
    [
        ([0.0, 0.0], [0.0, np.pi]),
        ([0.2, -0.5 * np.pi], [0.2, 0.0]),
        ([0.0, 0.5], [-np.pi / 2, 0.5]),
    ],
)
def test_stated_zeros_that_are_quarter_turns_off_are_named(
    tmp_path: Path, stated: list[float], right: list[float]
) -> None:
    urdf = small_arm.urdf(tmp_path)
    run = small_arm.recording(urdf)
    fields = run.fields()
    fields["position"] = np.asarray(run.position) - right
    recording = jid.RobotRecording(**fields)
    said = identified(recording, urdf=urdf, zero_offsets=stated).warnings[0]
    assert said.code == "wrong_zero"
    assert "stated zeros are off" in said.title
    (advice,) = said.advice
    found = np.array(advice.arguments["zero_offsets"])
    np.testing.assert_allclose(np.cos(found - right), 1.0, atol=1e-6)
    assert identified(recording, urdf=urdf, **advice.arguments).warnings == ()


@pytest.mark.parametrize(("stiffness", "phase"), [(25.0, 0.3), (12.0, 1.0), (40.0, -0.6)])
def test_no_component_without_information_is_printed(
    tmp_path: Path, stiffness: float, phase: float
) -> None:
    """A counterweight on the shoulder: the axis that it turns about is no direction that motion shows."""
    urdf = small_arm.urdf(tmp_path)
    run = small_arm.recording(urdf)
    fields = run.fields()
    torque = np.array(run.torque)
    torque[:, 0] += stiffness * np.sin(run.position[:, 0] + phase)
    fields["torque"] = torque
    found = identified(jid.RobotRecording(**fields), urdf=urdf)
    centres = [each for each in found.findings if each.code in ("wrong_centre", "payload")]
    assert centres
    for each in centres:
        assert "y" not in each.evidence
        assert "the motion does not show y" in each.details or " y " not in each.details
