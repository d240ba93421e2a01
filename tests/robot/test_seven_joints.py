"""What is promised of an arm of seven joints: friction, links, couplings, on a simulation with no code of ours."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from simulated_arm import (
    JOINTS,
    URDF,
    Arm,
    Run,
    Sensors,
    random_arm,
    random_motion,
    recorded,
    run,
)

import jointid as jid
from jointid.robot.links.inertia_modes import Inertia

pytest.importorskip("pinocchio")

SEED = 2
NAMES = [f"joint_{number}" for number in range(1, JOINTS + 1)]


def robot(**options: Any) -> jid.Robot:
    return jid.Robot.from_urdf(URDF, **options)


def ran(arm: Arm, duration: float = 8.0) -> Run:
    return run(arm, random_motion(SEED, duration=duration))


@pytest.fixture(scope="module")
def plain() -> Run:
    """Coulomb and viscous friction alone."""
    return ran(random_arm(SEED, stribeck=False), 12.0)


@pytest.fixture(scope="module")
def with_stribeck() -> Run:
    return ran(random_arm(SEED))


def errors(found: jid.RobotEstimate, arm: Arm) -> dict[str, np.ndarray]:
    """Relative, of each joint."""
    return {
        name: np.array([found.joints[joint].parameters[name].value for joint in NAMES])
        / arm.values(name)[:JOINTS]
        - 1.0
        for name in ("coulomb", "viscous")
    }


def assert_near(found: jid.RobotEstimate, arm: Arm, share: float) -> None:
    for name, each in errors(found, arm).items():
        assert np.abs(each).max() < share, (name, each.round(4))


@pytest.mark.parametrize("inertia", ["urdf", "scaled", "free"])
def test_friction_comes_back(plain: Run, inertia: Inertia) -> None:
    """With a host's stamps, an encoder's steps, and velocities that are 5 ms late."""
    found = jid.identify_robot(
        recorded(plain, Sensors(), SEED), robot(), inertia=inertia, model="coulomb_viscous"
    )
    assert_near(found, plain.arm, 0.03)
    inside = [
        low <= truth <= high
        for name in ("coulomb", "viscous")
        for joint, truth in zip(NAMES, plain.arm.values(name), strict=True)
        for low, high in [found.joints[joint].parameters[name].interval or (0.0, 0.0)]
    ]
    assert sum(inside) >= 11
    assert found.warnings == ()


@pytest.mark.parametrize("inertia", ["urdf", "free"])
def test_friction_with_a_stribeck_rise_comes_back(with_stribeck: Run, inertia: Inertia) -> None:
    recording = recorded(with_stribeck, Sensors(), SEED)
    found = jid.identify_robot(recording, robot(), inertia=inertia)
    assert_near(found, with_stribeck.arm, 0.03)


@pytest.mark.parametrize("inertia", ["urdf", "free"])
def test_no_acceleration_is_needed(plain: Run, inertia: Inertia) -> None:
    """The second difference of these positions is noise."""
    noise = Sensors(position_noise=3e-5, velocity_delay=None)
    recording = recorded(plain, noise, SEED)
    true = np.diff(plain.position, 2, axis=0)
    wrong = np.diff(recording.position, 2, axis=0) - true
    assert np.all(true.std(axis=0) < 0.1 * wrong.std(axis=0))
    found = jid.identify_robot(recording, robot(), inertia=inertia, model="coulomb_viscous")
    assert_near(found, plain.arm, 0.03)


@pytest.mark.parametrize("inertia", ["urdf", "free"])
def test_short_standstills_in_noise_do_no_harm(with_stribeck: Run, inertia: Inertia) -> None:
    """Joints stick at their reversals, and noise hides it: static friction was lost, and a delay was invented."""
    recording = recorded(with_stribeck, Sensors(position_noise=1e-5, velocity_delay=None), SEED)
    found = jid.identify_robot(recording, robot(), inertia=inertia)
    assert_near(found, with_stribeck.arm, 0.005)
    assert found.warnings == ()


@pytest.fixture(scope="module")
def heavy() -> Run:
    """Link 4 is heavier than the URDF says."""
    return ran(random_arm(SEED, stribeck=False).with_link_scaled(4, 1.2))


def test_a_heavier_link_is_found(heavy: Run) -> None:
    recording = recorded(heavy, Sensors(), SEED)
    found = jid.identify_robot(recording, robot(), inertia="scaled", model="coulomb_viscous")
    scale = found.joints["joint_4"].parameters["inertia_scale"]
    assert scale.value == pytest.approx(1.2, abs=0.05)
    assert scale.interval is not None
    assert scale.interval[0] > 1.0
    for name in ("joint_3", "joint_5", "joint_6", "joint_7"):
        assert found.joints[name].parameters["inertia_scale"].value == pytest.approx(1.0, abs=0.1)
    assert_near(found, heavy.arm, 0.03)


def test_a_heavier_link_is_named_where_the_urdf_is_believed(heavy: Run) -> None:
    recording = recorded(heavy, Sensors(), SEED)
    found = jid.identify_robot(recording, robot(), model="coulomb_viscous")
    assert any("joint_4" in str(each) for each in found.warnings)


@pytest.fixture(scope="module")
def wrist() -> tuple[Run, jid.RobotRecording]:
    """Motor 7 turns with joints 6 and 7, and all is recorded at the motors."""
    coupled = ran(random_arm(SEED, coupled=True, stribeck=False))
    return coupled, recorded(coupled, Sensors(), SEED, motors=True)


def test_a_coupled_wrist(wrist: tuple[Run, jid.RobotRecording]) -> None:
    coupled, recording = wrist
    turns = coupled.arm.couplings
    ratios = np.diag(turns)
    told = robot(gear_ratios=ratios, couplings=turns / ratios[:, None])
    found = jid.identify_robot(recording, told, model="coulomb_viscous")
    motor = coupled.arm.sources[7]
    for name, source in zip(NAMES, coupled.arm.sources, strict=False):
        parameters = found.joints[name].parameters
        assert parameters["coulomb"].value == pytest.approx(source.coulomb, rel=0.03)
        # At the joint's own speed, a motor that turns with it is part of its viscous friction.
        of_motor = motor.viscous if name in ("joint_6", "joint_7") else 0.0
        assert parameters["viscous"].value == pytest.approx(source.viscous + of_motor, rel=0.03)
    last = found.joints["joint_7"].parameters
    assert last["motor_coulomb"].value == pytest.approx(motor.coulomb, rel=0.05)
    assert last["motor_viscous"].value == pytest.approx(motor.viscous, rel=0.05)
    assert found.warnings == ()


@pytest.mark.slow
@pytest.mark.parametrize("sign", [0.0, -1.0], ids=["not told", "wrong sign"])
def test_a_wrong_coupling_is_named(wrist: tuple[Run, jid.RobotRecording], sign: float) -> None:
    coupled, recording = wrist
    couplings = np.eye(JOINTS)
    couplings[6, 5] = sign
    told = robot(gear_ratios=np.diag(coupled.arm.couplings), couplings=couplings)
    found = jid.identify_robot(recording, told, model="coulomb_viscous")
    said = " ".join(str(each) for each in found.warnings)
    assert "coupl" in said
    assert "joint_6" in said
    assert "joint_7" in said


@pytest.mark.slow
@pytest.mark.parametrize("signals", [("torque",), ("position", "velocity", "torque")])
def test_joints_that_are_exchanged_are_named(plain: Run, signals: tuple[str, ...]) -> None:
    recording = recorded(plain, Sensors(), SEED)
    order = [0, 1, 3, 2, *range(4, JOINTS)]
    fields = recording.fields()
    exchanged = {name: fields[name][:, order] for name in signals}
    found = jid.identify_robot(
        jid.RobotRecording(**{**fields, **exchanged}), robot(), model="coulomb_viscous"
    )
    said = [str(each) for each in found.warnings]
    assert any("joint_3" in each and "joint_4" in each for each in said), said
