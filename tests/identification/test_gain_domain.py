"""A sensor's gain that nobody bounds: sign and size come from the data, also where the motion is mostly friction."""

import math

import pytest
from closed_loop import TRUTH, thesis_joint

import jointid as jid
from jointid.problem.terms import Residual

JOINT = thesis_joint()
TRUE = JOINT.with_parameters(TRUTH)
UNBOUNDED = JOINT.replace(parameters={})


def moved(amplitude: float, law: str, noise: float, seed: int, polarity: float) -> jid.Recording:
    """The joint [°], its sensor mounted either way round."""
    controller = (
        jid.Pd(stiffness=3000.0, damping=200.0)
        if law == "pd"
        else jid.AdaptiveRobust(**jid.control_estimates(TRUE))
    )
    motion = jid.Trajectory.thesis(math.radians(amplitude), cycle=3.0, duration=12.0)
    run = jid.simulate(TRUE, controller, motion, sensors=jid.Sensors(torque_noise=noise), seed=seed)
    assert run.sensor is not None
    return jid.Recording(
        time=run.time,
        position=run.position,
        velocity=run.velocity,
        torque=run.torque,
        sensor=polarity * run.sensor,
        torque_hold="zoh",
    )


@pytest.mark.parametrize("polarity", [1.0, -1.0])
@pytest.mark.parametrize("law", ["pd", "robust"])
@pytest.mark.parametrize("amplitude", [5.0, 10.0, 20.0])
@pytest.mark.parametrize(("noise", "seed"), [(0.0, 0), (0.5, 0), (0.5, 1), (0.5, 3)])
def test_the_gain_has_the_right_sign_and_size(
    amplitude: float, law: str, noise: float, seed: int, polarity: float
) -> None:
    estimate = jid.identify(moved(amplitude, law, noise, seed, polarity), UNBOUNDED)
    gain = estimate.parameters["sensor_gain"]
    assert gain.at_bound is None
    assert polarity * gain.value == pytest.approx(TRUTH["sensor_gain"], rel=0.15)
    assert estimate.parameters["coulomb"].value == pytest.approx(TRUTH["coulomb"], rel=0.1)


@pytest.mark.parametrize("residual", ["sensor", "torque"])
def test_both_residuals_find_a_gain_of_either_sign(residual: Residual) -> None:
    for polarity in (1.0, -1.0):
        recording = moved(20.0, "pd", 0.5, 0, polarity)
        found = jid.identify(recording, UNBOUNDED, residual=residual).parameters["sensor_gain"]
        assert polarity * found.value == pytest.approx(TRUTH["sensor_gain"], rel=0.15)


def test_a_value_in_the_joint_file_sets_sign_and_size() -> None:
    recording = moved(20.0, "pd", 0.5, 0, 1.0)
    for value, low, high in ((2.0, 0.02, 200.0), (-2.0, -200.0, -0.02)):
        joint = UNBOUNDED.replace(parameters={"sensor_gain": {"value": value}})
        gain = jid.identify(recording, joint).parameters["sensor_gain"]
        assert (gain.min, gain.max) == pytest.approx((low, high))


def test_unbounded_agrees_with_bounded() -> None:
    recording = moved(60.0, "pd", 0.5, 0, 1.0)
    free, bounded = (jid.identify(recording, joint) for joint in (UNBOUNDED, JOINT))
    for name in TRUTH:
        assert free.parameters[name].value == pytest.approx(
            bounded.parameters[name].value, rel=1e-5
        )


def test_one_bound_tells_the_sign() -> None:
    recording = moved(20.0, "pd", 0.5, 0, -1.0)
    gain = jid.identify(recording, UNBOUNDED, parameters={"sensor_gain": {"max": -0.1}}).parameters[
        "sensor_gain"
    ]
    assert (gain.max, gain.at_bound) == (-0.1, None)
    assert gain.value == pytest.approx(-TRUTH["sensor_gain"], rel=0.15)
    assert gain.min < -TRUTH["sensor_gain"]


LEVEL = jid.thesis_joint()


@pytest.mark.parametrize("seed", range(3))
def test_a_sign_that_is_not_clear_is_reported(seed: int) -> None:
    # Two degrees about the horizontal: the link's torque hardly varies, the reading is noise.
    run = jid.simulate(
        LEVEL.with_parameters(TRUTH),
        jid.Pd(stiffness=3000.0, damping=200.0),
        jid.Trajectory.thesis(math.radians(2.0), cycle=10.0, duration=12.0),
        sensors=jid.Sensors(torque_noise=0.5),
        seed=seed,
    )
    for residual in ("sensor", "torque"):
        estimate = jid.identify(run, LEVEL.replace(parameters={}), residual=residual)
        (wording,) = (w for w in estimate.warnings if w.code == "undetermined")
        other = "negative" if estimate.parameters["sensor_gain"].value > 0.0 else "positive"
        assert f"a {other} sensor_gain fits almost as well" in wording.message
        assert "sensor_gain" in wording.parameters


def test_a_sign_that_is_known_or_clear_is_not() -> None:
    small, large = moved(5.0, "robust", 0.5, 0, 1.0), moved(60.0, "pd", 0.5, 0, 1.0)
    for estimate in (
        jid.identify(large, UNBOUNDED),
        jid.identify(small, UNBOUNDED, parameters={"sensor_gain": {"value": 2.0}}),
        jid.identify(small, UNBOUNDED, parameters={"sensor_gain": {"min": 0.1}}),
        jid.identify(small, JOINT),
    ):
        assert not [w for w in estimate.warnings if "fits almost as well" in w.message]
