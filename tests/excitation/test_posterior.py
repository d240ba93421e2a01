"""What an estimate tells: information also of sums, and joints drawn along what it leaves open."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.excitation.information import Known
from jointid.excitation.posterior import Posterior, joint_of, posterior_of, sensors_of

THESIS = jid.thesis_joint()
TRUE = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
SENSOR = {"sensor_gain": 2.4, "sensor_offset": 15.0}
LAW = jid.AdaptiveRobust(**jid.control_estimates(THESIS.with_parameters(TRUE | SENSOR)))


@pytest.fixture(scope="module")
def poor(shared_data: Path) -> jid.Estimate:
    return jid.identify(jid.load(shared_data / "simulated" / "poorly_excited.csv.gz"), THESIS)


def run(trajectory: jid.Trajectory, **values: float) -> jid.Recording:
    joint = THESIS.with_parameters(TRUE | SENSOR | values)
    return jid.simulate(joint, LAW, trajectory, sensors=jid.Sensors(torque_noise=0.5))


def test_information_of_a_singular_matrix_is_of_what_it_determines() -> None:
    known = Known(names=("a", "b", "c"), information=np.array([[4.0, 4, 0], [4, 4, 0], [0, 0, 25]]))
    assert known.stderr() == {"a": np.inf, "b": np.inf, "c": pytest.approx(0.2)}
    assert Known(names=("a",), information=np.zeros((1, 1))).stderr() == {"a": np.inf}


def test_information_of_another_size_is_refused() -> None:
    with pytest.raises(jid.InputError, match="matrix of 2 x 2"):
        Known(names=("a", "b"), information=np.eye(3))
    with pytest.raises(jid.InputError, match="finite"):
        Known(names=("a",), information=np.array([[np.inf]]))


def test_an_estimate_tells_its_intervals(poor: jid.Estimate) -> None:
    errors = posterior_of(poor).known.stderr()
    for name, error in errors.items():
        interval = poor.parameters[name].interval
        assert interval is not None
        half = 0.5 * (interval[1] - interval[0])
        if name == "sensor_offset":  # no motion tells the share of symmetry
            assert 1.96 * error < half
        else:
            assert 1.96 * error == pytest.approx(half, rel=1e-3)


def test_a_file_tells_the_same(poor: jid.Estimate) -> None:
    first, again = posterior_of(poor), posterior_of(jid.Estimate.from_json(poor.to_json()))
    assert np.array_equal(first.known.information, again.known.information)
    assert first.joints(5, seed=3) == again.joints(5, seed=3)
    assert sensors_of(poor) == sensors_of(jid.Estimate.from_json(poor.to_json()))


def test_an_estimate_saved_without_information_tells_its_covariance(poor: jid.Estimate) -> None:
    old = dataclasses.replace(poor, information=None)
    mine, its = posterior_of(poor).known.information, posterior_of(old).known.information
    np.testing.assert_allclose(its, mine, rtol=1e-6, atol=1e-9 * np.abs(mine).max())


def test_joints_are_drawn_along_the_correlation(poor: jid.Estimate) -> None:
    """Gain and offset are uncertain together: what the reading means at its mean is well known."""
    posterior = posterior_of(poor)
    joints = posterior.joints(400, seed=1)
    assert joints[0] == dict(zip(posterior.names, posterior.values, strict=True))
    gain, offset = (np.array([j[name] for j in joints]) for name in SENSOR)
    assert gain.std() == pytest.approx(posterior.known.stderr()["sensor_gain"], rel=0.15)
    assert np.corrcoef(gain, offset)[0, 1] > 0.99
    reading = -3.28  # its mean in the recording
    assert np.std(offset + gain * reading) < 0.1 * np.std(offset)


def test_what_one_direction_does_not_divide_is_drawn_with_its_sum() -> None:
    """Of motion in one direction only the sum of Coulomb friction and offset is known."""
    one_way = jid.Trajectory.trapezoid(1.0, velocity=1.5, acceleration=30.0, duration=2.0)
    estimate = jid.identify(run(one_way), THESIS, model="stribeck")
    assert np.isinf(np.diag(estimate.covariance)).any()
    joints = posterior_of(estimate).joints(100, seed=2)
    coulomb, offset = (np.array([j[name] for j in joints]) for name in ("coulomb", "sensor_offset"))
    assert coulomb.std() > 2.0
    assert np.std(coulomb + offset) < 0.3 * coulomb.std()


def test_joints_stay_inside_the_stated_bounds_and_near_the_estimate() -> None:
    posterior = Posterior(
        known=Known(names=("coulomb", "viscous", "sensor_offset"), information=np.zeros((3, 3))),
        values=np.array([10.0, 5.0, 0.0]),
        bounds={"coulomb": (9.0, None), "viscous": (None, 5.5)},
        scale={"sensor_offset": 20.0},
    )
    joints = posterior.joints(300)
    for name, low, high in (
        ("coulomb", 9.0, 30.0),
        ("viscous", 5.0 / 3.0, 5.5),
        ("sensor_offset", -60.0, 60.0),
    ):
        drawn = np.array([joint[name] for joint in joints])
        assert low <= drawn.min() < drawn.max() <= high
    assert posterior.joints(1) == ({"coulomb": 10.0, "viscous": 5.0, "sensor_offset": 0.0},)
    assert posterior.joints(9, seed=4) != posterior.joints(9, seed=5)


def test_a_bound_cuts_along_what_goes_together() -> None:
    """Only the sum of the two is known: it stays where it is though a bound stops one of them."""
    posterior = Posterior(
        known=Known(names=("coulomb", "viscous"), information=1e6 * np.ones((2, 2))),
        values=np.array([10.0, 10.0]),
        bounds={"coulomb": (9.0, 11.0)},
    )
    joints = posterior.joints(50)
    sums = [joint["coulomb"] + joint["viscous"] for joint in joints]
    assert max(joint["coulomb"] for joint in joints) == pytest.approx(11.0)
    np.testing.assert_allclose(sums, 20.0, atol=0.01)


def test_what_was_fixed_stays_fixed(shared_data: Path) -> None:
    poor = jid.load(shared_data / "simulated" / "poorly_excited.csv.gz")
    estimate = jid.identify(poor, THESIS, parameters={"viscous": 20.0})
    joint = joint_of(estimate, posterior_of(estimate), None)
    assert not joint.parameters["viscous"].vary
    assert joint.parameters["coulomb"].vary


def test_static_friction_that_is_not_there_is_not_looked_for() -> None:
    slow = run(jid.Trajectory.thesis(), static=0.0)
    posterior = posterior_of(jid.identify(slow, THESIS, model="stribeck"))
    assert set(posterior.names) == {"coulomb", "viscous", "sensor_gain", "sensor_offset"}


def test_static_friction_that_was_not_seen_is_looked_for() -> None:
    """Eight windows of fast motion in one direction tell nothing of it."""
    fast = jid.Trajectory.trapezoid(1.0, velocity=1.5, acceleration=30.0, duration=2.0)
    estimate = jid.identify(run(fast), THESIS, model="stribeck", windows=20)
    p = estimate.parameters["static"]
    assert p.stderr is not None
    assert p.stderr > 0.5 * p.value
    posterior = posterior_of(estimate)
    values = dict(zip(posterior.names, posterior.values, strict=True))
    assert values["static"] == pytest.approx(0.2 * estimate.parameters["coulomb"].value)
    errors = posterior.known.stderr()
    assert np.isinf([errors["static"], errors["stribeck"]]).all()
    assert np.isfinite(errors["viscous"])


def test_an_offset_that_nothing_divides_is_held(shared_data: Path) -> None:
    poor = jid.load(shared_data / "simulated" / "poorly_excited.csv.gz")
    posterior = posterior_of(
        jid.identify(poor, THESIS, model=jid.Model.parse("stribeck:asymmetric"))
    )
    assert "sensor_offset" not in posterior.names
    errors = posterior.known.stderr()
    assert errors["coulomb_positive"] < 0.5


def test_a_recordings_own_parameter_is_not_the_next_ones() -> None:
    first, second = run(jid.Trajectory.thesis()), run(jid.Trajectory.thesis(0.8))
    joint = THESIS.replace(
        model=jid.Model("stribeck", gravity="none", per_recording=("sensor_offset",))
    )
    estimate = jid.identify([first, second], joint)
    assert "sensor_offset[0]" in estimate.free
    posterior = posterior_of(estimate)
    assert not any("[" in name for name in posterior.names)
    for (
        name,
        error,
    ) in posterior.known.stderr().items():  # whatever the offsets of the recordings are
        stderr = estimate.parameters[name].stderr
        assert stderr is not None
        assert error > 0.95 * stderr


@pytest.mark.parametrize("residual", ["torque", "sensor"])
def test_the_sensors_noise_is_that_of_the_residuals(residual: Any) -> None:
    estimate = jid.identify(run(jid.Trajectory.thesis(1.0)), THESIS, residual=residual)
    sensors = sensors_of(estimate)
    assert sensors is not None
    assert sensors.torque_noise == pytest.approx(0.5, rel=0.1)


def test_one_rough_window_is_not_the_sensors_noise() -> None:
    estimate = jid.identify(run(jid.Trajectory.thesis(1.0)), THESIS)
    rough = estimate.windows.measured.copy()
    rough[::40] += 0.3
    again = dataclasses.replace(
        estimate, windows=dataclasses.replace(estimate.windows, measured=rough)
    )
    noise = [sensors_of(each) for each in (estimate, again)]
    assert noise[0] is not None
    assert noise[1] is not None
    assert noise[1].torque_noise == pytest.approx(noise[0].torque_noise, rel=0.05)


def test_the_joint_of_a_design_has_the_estimates_values(poor: jid.Estimate) -> None:
    joint = joint_of(poor, posterior_of(poor), None)
    for name, parameter in joint.parameters.items():
        assert parameter.value == poor.parameters[name].value
        assert parameter.vary


def test_facts_may_come_from_another_joint(shared_data: Path) -> None:
    bare = jid.identify(jid.load(shared_data / "simulated" / "poorly_excited.csv.gz"))
    assert bare.joint.link is None
    joint = joint_of(bare, posterior_of(bare), THESIS)
    assert joint.link == THESIS.link
    assert joint.parameters["coulomb"].value == bare.parameters["coulomb"].value
    with pytest.raises(jid.InputError, match="must be the same as in the joint of the estimate"):
        joint_of(bare, posterior_of(bare), jid.Joint(inertia=1.0))
