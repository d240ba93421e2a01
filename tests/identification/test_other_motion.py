"""Findings that ask for other motion name the call that designs it, with its arguments."""

from __future__ import annotations

from pathlib import Path

import pytest
from defects import saturated_torque

import jointid as jid
from jointid.base.advice import Action
from jointid.identification.warnings.motion_advice import _short

THESIS = jid.thesis_joint()


def advice(estimate: jid.Estimate, code: str) -> Action:
    (found,) = [each for each in estimate.findings if each.code == code]
    (action,) = [each for each in found.advice if each.designs]
    return action


def moved(trajectory: jid.Trajectory, joint: jid.Joint, windows: int) -> jid.Estimate:
    """An estimate from one noisy run of the thesis's joint, which is identified with other facts."""
    true = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
    values = THESIS.with_parameters({**true, "sensor_gain": 2.4, "sensor_offset": 15.0})
    controller = jid.AdaptiveRobust(**jid.control_estimates(values))
    sensors = jid.Sensors(torque_noise=0.2)
    run = jid.simulate(values, controller, trajectory, sensors=sensors)
    return jid.identify(run, joint, windows=windows)


@pytest.fixture(scope="module")
def poor(shared_data: Path) -> jid.Recording:
    return jid.load(shared_data / "simulated" / "poorly_excited.csv.gz")


def test_a_range_that_is_missing_is_left_to_the_user(poor: jid.Recording) -> None:
    action = advice(jid.identify(poor, THESIS), "undetermined")
    # The joint states its torque and its link, not its speed.
    assert action.arguments == {"limits": {"position": ..., "velocity": ...}, "duration": 6.0}
    assert str(action).endswith(
        "designed by jid.design(estimate, limits={'position': ..., 'velocity': ...}, duration=6.0)"
    )


def test_without_a_joint_the_torque_is_the_recorded_one(poor: jid.Recording) -> None:
    action = advice(jid.identify(poor), "undetermined")
    assert action.arguments["limits"]["torque"] == pytest.approx(77.6, abs=2.0)
    assert action.arguments["joint"] is ...  # what loads the sensor


def test_what_the_joint_limits_is_not_repeated(poor: jid.Recording) -> None:
    limits = jid.Limits(position=(-1.2, 1.2), velocity=3.4, torque=160.0)
    action = advice(jid.identify(poor, THESIS.replace(limits=limits)), "undetermined")
    assert action.arguments == {"duration": 6.0}


def test_a_motion_stays_in_the_recorded_range_where_that_is_wide_enough() -> None:
    few = moved(jid.Trajectory.thesis(), THESIS, windows=30)
    action = advice(few, "few_windows")
    low, high = action.arguments["limits"]["position"]
    assert -0.36 < low < -0.34
    assert 0.34 < high < 0.36
    assert action.arguments["duration"] == 12.0


def test_a_torque_that_was_cut_off_is_limited_below(repo: Path) -> None:
    clipped = saturated_torque(jid.load(repo / "examples" / "data" / "well_excited.csv.gz"))
    assert clipped.torque is not None
    action = advice(jid.identify(clipped, THESIS), "torque_saturated")
    limit = 0.9 * float(abs(clipped.torque).max())
    assert action.arguments["limits"]["torque"] == pytest.approx(limit, rel=0.01)


def test_the_advice_survives_a_file(poor: jid.Recording) -> None:
    estimate = jid.identify(poor)
    assert jid.Estimate.from_json(estimate.to_json()).findings == estimate.findings


@pytest.mark.parametrize("value", [1.12469, -0.348472977, 0.0009999, 81.1092779, 3.0, -1.2])
def test_a_limit_is_never_widened_by_its_rounding(value: float) -> None:
    assert abs(_short(value)) <= abs(value)
    assert _short(value) == pytest.approx(value, rel=0.01)


def test_zero_is_short() -> None:
    assert _short(0.0) == 0.0
