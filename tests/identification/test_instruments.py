"""The sensor's gain by instruments: free of the bias that either side of a regression has."""

import math
from typing import Any

import numpy as np
import pytest
from simulated_joint import INERTIA, TRUTH, simulate

import jointid as jid
from jointid.estimate.tables import quality


def gain_error(estimate: jid.Estimate) -> float:
    return estimate.parameters["sensor_gain"].value / TRUTH["sensor_gain"] - 1.0


def with_torque(recording: jid.Recording, extra: np.ndarray) -> jid.Recording:
    signals = {
        name: getattr(recording, name) for name in ("time", "position", "velocity", "sensor")
    }
    return jid.Recording(**signals, torque=recording.torque + extra, torque_hold="zoh")


def found(recording: jid.Recording, **options: Any) -> jid.Estimate:
    return jid.identify(recording, jid.thesis_joint(), search="separable", **options)


@pytest.fixture(scope="module")
def noisy() -> list[jid.Recording]:
    return simulate(4, duration=12.0, seed=3, noise=3.0)


@pytest.fixture(scope="module")
def clean() -> jid.Recording:
    return simulate(1, duration=12.0, seed=4)[0]


def test_noise_of_the_reading_does_not_shrink_the_gain(noisy: list[jid.Recording]) -> None:
    errors = [gain_error(found(run)) for run in noisy]
    assert abs(np.mean(errors)) < 0.01
    assert np.mean([gain_error(found(run, residual="torque")) for run in noisy]) < -0.05


def test_friction_that_drifts_does_not_inflate_the_gain(clean: jid.Recording) -> None:
    share = clean.time / clean.time[-1]
    # Viscous friction falls by 30 % during the run.
    drifting = with_torque(clean, -0.3 * TRUTH["viscous"] * share * clean.velocity)
    for side in ("sensor", "instruments"):
        estimate = found(drifting, residual=side)
        assert [each.code for each in estimate.warnings] == ["drift"]
        assert abs(gain_error(estimate)) < 0.01


def test_a_clean_recording_keeps_its_accuracy(clean: jid.Recording) -> None:
    ours, thesis = found(clean), found(clean, residual="sensor")
    for name, p in thesis.parameters.items():
        if p.vary:
            assert p.stderr is not None
            assert abs(ours.parameters[name].value - p.value) < 2.0 * p.stderr, name
            assert ours.parameters[name].stderr == pytest.approx(p.stderr, rel=0.25), name
    # The table of windows is in terms of the reading, as with the sensor's residual.
    assert ours.residuals.r_squared == pytest.approx(thesis.residuals.r_squared, abs=1e-4)


def test_the_settings_say_how_the_gain_was_found(clean: jid.Recording) -> None:
    estimate = found(clean)
    assert estimate.settings["residual"] == "instruments"
    assert estimate.settings["instruments"]["strength"] > 100.0
    assert not estimate.settings["instruments"]["acceleration"]  # gravity says enough
    assert "gain by instrumental variables" in dict(quality(estimate))["model"]


def test_weak_instruments_are_replaced_with_a_reason(clean: jid.Recording) -> None:
    """A reading that has nothing of the link's gravity or inertia."""
    reading = np.random.default_rng(0).normal(size=len(clean))
    signals = {name: getattr(clean, name) for name in ("time", "position", "velocity")}
    joint = jid.thesis_joint()
    run = jid.Recording(
        **signals, torque=np.asarray(clean.torque) + reading, sensor=reading, torque_hold="zoh"
    )
    estimate = found(run)
    assert estimate.settings["residual"] == "sensor"
    assert "explains too little" in estimate.settings["residual_reason"]
    assert estimate.settings["residual_reason"] in dict(quality(estimate))["model"]
    assert (
        jid.identify(run, joint, residual="instruments", search="separable").settings["residual"]
        == "instruments"
    )


def test_running_integrals_stay_the_thesiss(clean: jid.Recording) -> None:
    estimate = found(clean, windows="cumulative")
    assert estimate.settings["residual"] == "sensor"
    assert "thesis" in estimate.settings["residual_reason"]


def test_several_recordings_with_links_of_their_own() -> None:
    runs = simulate(2, duration=6.0, seed=5, noise=1.0)
    estimate = found(runs[0]), jid.identify(runs, jid.thesis_joint(), search="separable")
    assert abs(gain_error(estimate[1])) < 0.01
    errors = [each.parameters["sensor_gain"].stderr or 0.0 for each in estimate]
    assert 0.0 < errors[1] < errors[0]


def test_the_estimate_of_one_or_more_threads_is_the_same(clean: jid.Recording) -> None:
    one, more = (
        jid.identify(clean, jid.thesis_joint(), search=jid.Search(method="separable", threads=n))
        for n in (1, 2)
    )
    assert {n: p.value for n, p in one.parameters.items()} == {
        n: p.value for n, p in more.parameters.items()
    }


def test_the_bootstrap_draws_the_estimate_that_was_made(noisy: list[jid.Recording]) -> None:
    """It needs the reading's projection for the slope and the reading itself for the scatter."""
    estimate = found(noisy[0])
    drawn = estimate.bootstrap(n=300).parameters["sensor_gain"]
    chance = estimate.parameters["sensor_gain"].stderr
    assert chance is not None
    assert 0.5 * chance < drawn.stderr < 1.6 * chance
    assert drawn.interval[0] < estimate.parameters["sensor_gain"].value < drawn.interval[1]


def hardly_moving_link(seed: int, polarity: float = 1.0) -> jid.Recording:
    """Twenty degrees about the horizontal: the reading hardly varies beside the torque."""
    joint = jid.thesis_joint()
    presumed: dict[str, Any] = {"coulomb": 15.0, "static": 10.0, "stribeck": 150.0, "viscous": 10.0}
    run = jid.simulate(
        joint.with_parameters(TRUTH),
        jid.AdaptiveRobust(inertia=2.5, sensor_gain=1.5, sensor_offset=0.0, **presumed),
        jid.Trajectory.thesis(math.radians(20.0), cycle=3.0, duration=6.0),
        sensors=jid.Sensors(torque_noise=0.2),
        seed=seed,
    )
    assert run.sensor is not None
    signals = {name: getattr(run, name) for name in ("time", "position", "velocity", "torque")}
    return jid.Recording(**signals, sensor=polarity * run.sensor, torque_hold="zoh")


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("polarity", [1.0, -1.0])
def test_a_small_motion_without_a_joint_has_the_right_sign(seed: int, polarity: float) -> None:
    estimate = jid.identify(hardly_moving_link(seed, polarity))
    assert estimate.settings["residual"] == "instruments"
    gain, inertia = (estimate.parameters[name] for name in ("sensor_gain", "inertia"))
    assert polarity * gain.value == pytest.approx(TRUTH["sensor_gain"], rel=0.1)
    assert inertia.value == pytest.approx(INERTIA, rel=0.01)
    assert {each.code for each in estimate.findings} <= {"undetermined", "delay_removed"}


def test_a_gain_of_the_wrong_sign_is_refused() -> None:
    """Forced by its bounds: what is left of the torque is not the joint's, so it has no cause."""
    run = hardly_moving_link(0)
    estimate = jid.identify(run, parameters={"sensor_gain": {"max": -0.1}})
    assert estimate.residuals.r_squared < 0.0
    (found,) = (each for each in estimate.findings if each.code == "poor_fit")
    assert found.severity == "blocking"
    assert not [each for each in estimate.findings if "share" in each.evidence]
