"""Velocity derived from position: the differences where they are fine, local cubics where the encoder is coarse."""

import numpy as np
import pytest
from numpy.typing import NDArray

import jointid as jid
from jointid import _core
from jointid.recording.derived import differences

Array = NDArray[np.float64]

TIME = np.arange(0.0, 8.0, 1e-3)
COARSE = 2.0 * np.pi / 50_000


def motion(time: Array) -> tuple[Array, Array]:
    """Position and velocity of a joint whose acceleration jumps at each reversal, as friction makes it."""
    phase = np.mod(time, 2.0)
    back = phase >= 1.0
    x = np.where(back, phase - 1.0, phase)
    speed = 1.2 * (1.0 - np.exp(-x / 0.05)) * (1.0 - x)
    velocity = np.where(back, -speed, speed)
    step = time[1] - time[0]
    position = np.concatenate([[0.0], np.cumsum(0.5 * step * (velocity[1:] + velocity[:-1]))])
    return position, velocity


def stepped(position: Array, step: float = COARSE) -> Array:
    return np.asarray(np.floor(position / step) * step)


def test_a_fine_position_keeps_its_differences_to_the_bit() -> None:
    position, _ = motion(TIME)
    made = jid.Recording(time=TIME, position=stepped(position, COARSE / 100.0))
    assert not made.derived.refined
    np.testing.assert_array_equal(made.velocity, np.gradient(made.position, TIME, edge_order=2))


def test_a_coarse_encoder_is_smoothed_but_not_its_reversals() -> None:
    position, velocity = motion(TIME)
    made = jid.Recording(time=TIME, position=stepped(position))
    assert made.derived.refined
    assert made.derived.position_noise.quantum == pytest.approx(COARSE)
    error = made.velocity - velocity
    rough = differences(made.time, made.position, ()) - velocity
    slow = np.abs(velocity) < 0.2
    assert np.std(error) < 0.15 * np.std(rough)
    assert np.std(error[slow]) < 0.35 * np.std(rough[slow])
    # Its own statement of its noise is about right where the motion is smooth.
    smooth = np.abs(velocity) > 0.3
    assert np.std(error[smooth] / made.derived.noise[smooth]) < 2.0


def test_no_fit_reaches_across_a_gap() -> None:
    position, _ = motion(TIME)
    position = stepped(position)
    kept = (TIME < 3.3) | (TIME > 3.4)
    made = jid.Recording(time=TIME[kept], position=position[kept] + (TIME[kept] > 3.35) * 5.0)
    assert made.gaps
    assert np.abs(made.velocity).max() < 2.0
    first = jid.Recording(time=TIME[TIME < 3.3], position=position[TIME < 3.3])
    np.testing.assert_allclose(
        made.velocity[: len(first) - 60], first.velocity[:-60], rtol=0.0, atol=1e-12
    )


def test_uneven_stamps_are_used_as_they_are() -> None:
    rng = np.random.default_rng(2)
    uneven = np.sort(TIME + rng.uniform(0.0, 0.9e-3, TIME.size))
    fine = np.arange(0.0, 8.1, 1e-4)
    position, velocity = motion(fine)
    made = jid.Recording(time=uneven, position=stepped(np.interp(uneven, fine, position)))
    truth = np.interp(uneven, fine, velocity)
    rough = differences(made.time, made.position, ()) - truth
    assert np.std(made.velocity - truth) < 0.1 * np.std(rough)


def test_the_number_of_threads_changes_no_bit() -> None:
    time = np.arange(250_000) * 1e-3
    position = stepped(np.sin(time))
    difference = np.gradient(position, time, edge_order=2)
    noise = _core.position_noise(time, position, [100_000], 1e-3)
    one, four = (
        _core.local_velocity(time, position, difference, [100_000], noise, threads=threads)
        for threads in (1, 4)
    )
    assert one.refined
    assert one.velocity.tobytes() == four.velocity.tobytes()
    assert one.noise.tobytes() == four.noise.tobytes()


@pytest.mark.parametrize("decimals", [6, 7])
def test_a_step_is_found_in_rounded_numbers(decimals: int) -> None:
    position, _ = motion(TIME)
    noise = jid.Recording(
        time=TIME, position=np.round(stepped(position), decimals)
    ).derived.position_noise
    assert noise.quantum == pytest.approx(COARSE, rel=0.02)
    assert noise.sigma == pytest.approx(COARSE / np.sqrt(12.0), rel=0.02)


def test_white_noise_of_a_position_without_steps() -> None:
    position, _ = motion(TIME)
    noise = np.random.default_rng(1).normal(0.0, 2e-5, TIME.size)
    found = jid.Recording(time=TIME, position=position + noise).derived.position_noise
    assert found.quantum == 0.0
    assert found.sigma == pytest.approx(2e-5, rel=0.1)
