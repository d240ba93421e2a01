"""The simulated arm keeps the torque balance that it is meant to have, by another way of calculating it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from simulated_arm import Arm, Run, Sensors, random_arm, random_motion, recorded, run

pinocchio: Any = pytest.importorskip("pinocchio")


@pytest.fixture(scope="module", params=[False, True], ids=["plain", "coupled"])
def ran(request: pytest.FixtureRequest) -> Run:
    return run(random_arm(3, coupled=request.param), random_motion(3, duration=3.0))


def friction(arm: Arm, velocity: np.ndarray) -> np.ndarray:
    """Of sources that turn."""
    speed = velocity @ arm.speeds.T
    level = arm.values("coulomb") + arm.values("static") * np.exp(
        -arm.values("stribeck") * speed**2
    )
    torque = (
        level * np.sign(np.where(np.abs(speed) > 1e-9, speed, 0.0))
        + arm.values("viscous") * speed
        + arm.values("offset")
    )
    return np.asarray(torque @ arm.speeds)


def balance(ran: Run, length: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Integrals of torque and of what it has to be, without acceleration, and whether a source stands still."""
    arm, state = ran.arm, ran.arm.model.createData()
    rotors = (arm.speeds.T * arm.values("rotor_inertia")) @ arm.speeds
    momentum, rest = np.empty_like(ran.velocity), np.empty_like(ran.velocity)
    for i, (q, v) in enumerate(zip(ran.position, ran.velocity, strict=True)):
        upper = np.triu(pinocchio.crba(arm.model, state, q))
        momentum[i] = (upper + np.triu(upper, 1).T + rotors) @ v
        coriolis = pinocchio.computeCoriolisMatrix(arm.model, state, q, v)
        rest[i] = pinocchio.computeGeneralizedGravity(arm.model, state, q) - coriolis.T @ v
    force = rest + friction(arm, ran.velocity)
    steps = np.diff(ran.time)[:, None]
    done = np.vstack(
        [np.zeros((1, arm.joints)), np.cumsum(0.5 * (force[1:] + force[:-1]) * steps, axis=0)]
    )
    given = np.vstack([np.zeros((1, arm.joints)), np.cumsum(ran.torque[:-1] * steps, axis=0)])
    total = momentum + done
    still = np.abs(ran.velocity @ arm.speeds.T) < 1e-6
    edges = range(0, len(ran.time) - length, length)
    held = [still[i : i + length].any() for i in edges]
    return (
        np.array([given[i + length] - given[i] for i in edges]),
        np.array([total[i + length] - total[i] for i in edges]),
        np.array(held),
    )


def test_torque_is_momentum_and_friction(ran: Run) -> None:
    given, found, held = balance(ran, 50)
    assert 10 < np.sum(~held) < len(held)
    error = (given - found)[~held]
    size = np.sqrt(np.mean(given[~held] ** 2, axis=0))
    # A sign that changes between two samples is known to half a period only.
    assert np.all(np.median(np.abs(error), axis=0) < 3e-4 * size)
    assert np.all(np.sqrt(np.mean(error**2, axis=0)) < 5e-3 * size)


def test_smaller_steps_change_little() -> None:
    arm, motion = random_arm(5), random_motion(5, duration=1.5)
    coarse, fine = run(arm, motion), run(arm, motion, steps=8)
    assert np.abs(coarse.position - fine.position).max() < 2e-6
    change = np.sqrt(np.mean((coarse.torque - fine.torque) ** 2, axis=0))
    assert np.all(change < 1e-3 * np.abs(fine.torque).max(axis=0))


def test_standstill_is_held_within_static_friction() -> None:
    ran = run(random_arm(3), random_motion(3, duration=3.0))
    given, found, held = balance(ran, 50)
    level = (ran.arm.values("coulomb") + ran.arm.values("static")) * 50e-3
    holding = np.abs(given - found)[held]
    assert np.all(holding <= 1.02 * level)
    assert np.all(holding.max(axis=0) > 0.3 * level)


def test_every_joint_reverses_and_moves_fast(ran: Run) -> None:
    turned = np.diff(np.sign(np.where(np.abs(ran.velocity) > 0.02, ran.velocity, 0.0)), axis=0)
    assert np.all((turned != 0.0).sum(axis=0) >= 2)
    assert np.all(np.abs(ran.velocity).max(axis=0) > 0.4)


def test_the_recording_is_what_sensors_make_of_it(ran: Run) -> None:
    exact = Sensors(
        stamp_lateness=0.0, counts=0.0, velocity_delay=0.0, velocity_noise=0.0, torque_noise=0.0
    )
    clean = recorded(ran, exact, 1)
    np.testing.assert_array_equal(clean.position, ran.position)
    assert clean.velocity is not None
    np.testing.assert_allclose(clean.velocity, ran.velocity, atol=1e-12)
    real = recorded(ran, Sensors(), 1)
    steps = np.diff(real.time)
    assert 2e-5 < np.std(steps) < 2e-4
    assert real.velocity is not None
    late = np.array(
        [
            np.corrcoef(real.velocity[20:-20, 0], np.roll(ran.velocity[:, 0], s)[20:-20])[0, 1]
            for s in range(11)
        ]
    )
    assert late.argmax() == 5
    again = recorded(ran, Sensors(), 1)
    assert again == real
    assert recorded(ran, Sensors(), 2) != real


def test_motors_turn_with_the_joints_of_the_coupling() -> None:
    ran = run(random_arm(4, coupled=True), random_motion(4, duration=0.5))
    exact = Sensors(stamp_lateness=0.0, counts=0.0, velocity_delay=None, torque_noise=0.0)
    motors, joints = recorded(ran, exact, 1, motors=True), recorded(ran, exact, 1)
    assert (motors.side, joints.side) == ("motor", "joint")
    seventh = 60.0 * (joints.position[:, 5] + joints.position[:, 6])
    np.testing.assert_allclose(motors.position[:, 6], seventh)
    # Power is the same on both sides.
    assert motors.torque is not None
    assert joints.torque is not None
    power = (motors.torque * (ran.velocity @ ran.arm.couplings.T)).sum(axis=1)
    np.testing.assert_allclose(power, (joints.torque * ran.velocity).sum(axis=1), atol=1e-9)
