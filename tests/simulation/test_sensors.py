"""Simulated sensors: each does what its options say and nothing else; all are off by default."""

import math
import pickle
from typing import Any

import numpy as np
import pytest
from closed_loop import TRUTH, thesis_joint, well_excited, wrong_controller
from numpy.typing import NDArray

import jointid as jid

Array = NDArray[np.float64]


def seen(seed: int = 0, duration: float = 1.5, **sensors: Any) -> jid.SimulatedRecording:
    joint = thesis_joint().with_parameters(TRUTH)
    trajectory = well_excited(duration)
    law = wrong_controller()
    return jid.simulate(joint, law, trajectory, sensors=jid.Sensors(**sensors), seed=seed)


def sensed(run: jid.SimulatedRecording) -> Array:
    """The reading as a torque, less the true one."""
    assert run.sensor is not None
    torque = TRUTH["sensor_gain"] * run.sensor + TRUTH["sensor_offset"]
    return np.asarray(torque - run.truth.signals["link_torque"])


def test_without_sensors_the_signals_are_exact() -> None:
    run = seen()
    true = run.truth.signals
    assert run.position.tobytes() == true["position"].tobytes()
    assert run.velocity.tobytes() == true["velocity"].tobytes()
    assert not run.velocity_derived
    assert np.abs(sensed(run)).max() < 1e-12


def test_an_encoder_shows_whole_counts() -> None:
    run = seen(encoder_counts=8000)
    resolution = 2.0 * math.pi / (8000 * 101)
    counts = run.position / resolution
    np.testing.assert_allclose(counts, np.round(counts), atol=1e-6)
    off = run.position - run.truth.signals["position"]
    assert np.abs(off).max() <= resolution / 2 * (1 + 1e-9)
    assert len(np.unique(np.round(off / resolution, 3))) > 100


def test_velocity_by_difference_is_that_of_the_positions() -> None:
    run = seen(encoder_counts=8000, velocity="difference")
    velocity = run.truth.signals["control_velocity"]
    np.testing.assert_allclose(velocity[1:], np.diff(run.position) / 1e-3, atol=1e-9)
    assert velocity[0] == 0.0
    # The recording's own is differentiated centrally: it does not lag.
    assert run.velocity_derived
    true = run.truth.signals["velocity"]
    assert np.std(run.velocity - true) < 0.5 * np.std(velocity - true)


@pytest.mark.parametrize(("least", "longest"), [(5, 0.010), (40, 0.003), (400, 0.02)])
def test_velocity_by_counts_waits_for_them(least: int, longest: float) -> None:
    run = seen(encoder_counts=8000, velocity="counts", velocity_counts=least, velocity_time=longest)
    counts = np.round(run.position * 8000 * 101 / (2.0 * math.pi))
    expected, last = [0.0], 0
    for k in range(1, len(run)):
        elapsed = (k - last) * 1e-3
        if abs(counts[k] - counts[last]) >= least or elapsed > longest - 1e-9:
            expected.append((run.position[k] - run.position[last]) / elapsed)
            last = k
        else:
            expected.append(expected[-1])
    velocity = run.truth.signals["control_velocity"]
    np.testing.assert_allclose(velocity, expected, rtol=1e-9, atol=1e-12)


def test_ripple_is_at_twice_the_motor_angle() -> None:
    run = seen(ripple=2.6, ripple_phase=0.4)
    angle = 2.0 * 101.0 * run.truth.signals["position"] + 0.4
    np.testing.assert_allclose(sensed(run), 2.6 * np.sin(angle), atol=1e-9)


def test_nonlinearity_peaks_at_its_share_of_the_full_scale() -> None:
    run = seen(nonlinearity=0.01, full_scale=10.0)
    x = run.truth.signals["link_torque"] / 10.0
    deviation = sensed(run)
    inside = np.abs(x) <= 1.0
    assert np.abs(deviation[inside]).max() == pytest.approx(0.1, rel=0.02)
    np.testing.assert_allclose(
        deviation, 0.1 * 1.5 * math.sqrt(3.0) * (x - x**3), rtol=1e-9, atol=1e-12
    )


def test_noise_is_gaussian_white_and_a_function_of_the_seed() -> None:
    noise = sensed(seen(torque_noise=0.5, duration=12.0))
    n = len(noise)
    assert noise.std() == pytest.approx(0.5, rel=4.0 / math.sqrt(2 * n))
    assert abs(noise.mean()) < 4.0 * 0.5 / math.sqrt(n)
    assert np.mean(np.abs(noise) < 0.5) == pytest.approx(0.6827, abs=4.0 * 0.47 / math.sqrt(n))
    assert abs(np.corrcoef(noise[1:], noise[:-1])[0, 1]) < 4.0 / math.sqrt(n)
    again, other = sensed(seen(torque_noise=0.5)), sensed(seen(1, torque_noise=0.5))
    assert again.tobytes() == sensed(seen(torque_noise=0.5)).tobytes()
    assert abs(np.corrcoef(again, other)[0, 1]) < 4.0 / math.sqrt(len(again))


@pytest.mark.parametrize("order", [1, 2])
def test_the_filter_is_equal_poles(order: int) -> None:
    run = seen(filter_order=order, filter_frequency=30.0)
    assert run.sensor is not None
    share = 1.0 - math.exp(-2.0 * math.pi * 30.0 * 1e-3)
    value = (run.truth.signals["link_torque"] - TRUTH["sensor_offset"]) / TRUTH["sensor_gain"]
    for _ in range(order):
        stage = [value[0]]
        for k in range(1, len(value)):
            stage.append(stage[-1] + share * (value[k] - stage[-1]))
        value = np.array(stage)
    np.testing.assert_allclose(run.sensor, value, rtol=1e-9)


def test_a_converter_rounds_clips_and_gains_by_over_sampling() -> None:
    run = seen(converter_bits=8, converter_range=6.0)
    assert run.sensor is not None
    steps = run.sensor / (6.0 / 128.0)
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)
    exact = (run.truth.signals["link_torque"] - TRUTH["sensor_offset"]) / TRUTH["sensor_gain"]
    inside = np.abs(exact) < 5.9
    assert 0.1 < inside.mean() < 1.0
    assert np.abs(run.sensor - exact)[inside].max() <= 6.0 / 256.0 * (1 + 1e-9)
    assert run.sensor.min() == -6.0
    coarse: dict[str, Any] = {"converter_bits": 8, "converter_range": 40.0, "converter_noise": 1.0}
    once, often = sensed(seen(**coarse)), sensed(seen(**coarse, converter_samples=64))
    assert often.std() < 0.2 * once.std()


def test_sensors_are_a_frozen_value() -> None:
    sensors = jid.Sensors(encoder_counts=8000, velocity="counts")
    assert pickle.loads(pickle.dumps(sensors)) == sensors
    assert sensors.replace(velocity="exact").velocity == "exact"
    with pytest.raises(ValueError, match="exact, difference, counts"):
        jid.Sensors(velocity="guess")
    with pytest.raises(
        ValueError, match=r"Sensors\.torque_noise is .*: must be finite and at least 0"
    ):
        jid.Sensors(torque_noise=-1.0)
    with pytest.raises(ValueError, match=r"Sensors\.filter_order is 3: must be 0, 1 or 2"):
        jid.Sensors(filter_order=3)
