"""The systematic error of the unknown instant at which a sensor is sampled: before a command's step or amid it."""

import numpy as np
import pytest
from closed_loop import INERTIA, LINK_INERTIA, TRUTH, thesis_joint, well_excited, wrong_controller

import jointid as jid


@pytest.fixture(scope="module")
def run() -> jid.Recording:
    joint = thesis_joint().with_parameters(TRUTH)
    return jid.simulate(joint, wrong_controller(), well_excited(8.0))


def with_sensor(run: jid.Recording, sensor: np.ndarray) -> jid.Estimate:
    changed = jid.Recording(
        time=run.time,
        position=run.position,
        velocity=run.velocity,
        torque=run.torque,
        sensor=sensor,
        torque_hold="zoh",
    )
    # An instant that is given for the sensor: it is not looked for.
    return jid.identify(changed, thesis_joint(), search="separable", shift={"sensor": 1e-9})


def test_the_error_is_what_half_a_step_moves(run: jid.Recording) -> None:
    """The reading is taken before the step; halfway through it the link has half of its share."""
    assert run.sensor is not None
    assert run.torque is not None
    share = LINK_INERTIA / (INERTIA + LINK_INERTIA) / TRUTH["sensor_gain"]
    half = 0.5 * share * np.diff(run.torque, prepend=run.torque[0])
    before, amid = with_sensor(run, run.sensor), with_sensor(run, run.sensor + half)
    for name in ("viscous", "sensor_gain", "sensor_offset"):
        found, other = before.parameters[name], amid.parameters[name]
        moved = abs(found.value - other.value)
        assert found.systematic["sampling"] == pytest.approx(moved, rel=0.15), name


def test_a_sensor_that_no_link_accelerates_lacks_no_step(run: jid.Recording) -> None:
    assert run.sensor is not None
    acceleration = np.gradient(run.velocity, run.time)
    found = with_sensor(run, run.sensor - 4.0 * LINK_INERTIA / TRUTH["sensor_gain"] * acceleration)
    assert "sampling" not in found.parameters["coulomb"].systematic
