"""A sensor's delay where no controller feeds the reading back: the jumps of the motion tell it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from plants import Bench, Law, Log, Plant, simulate, sines

import jointid as jid

NOISE = 0.2
RUNS = 4


def bench(**fields: Any) -> Bench:
    """Friction that is compensated at the reference velocity: the torque jumps at its reversals."""
    amplitude, rate = np.array([[0.6, 0.3, 0.1]] * RUNS), np.array([[1.3, 2.9, 5.1]] * RUNS)
    phase = np.random.default_rng(8).uniform(0.0, 6.28, (RUNS, 3))
    return Bench(
        motion=sines(amplitude, rate, phase),
        plant=Plant(link_inertia=0.4, **fields.pop("plant", {})),
        law=Law(stiffness=60.0, on_reference=fields.pop("on_reference", 1.0)),
        log=Log(**{"sensor_noise": NOISE} | fields),
    )


def recordings(*benches: Bench, duration: float = 12.0) -> list[list[jid.Recording]]:
    """Runs of each bench."""
    found = simulate(Bench.stack(benches), duration=duration, seed=21, finer=3)
    return [found[k : k + RUNS] for k in range(0, len(found), RUNS)]


@pytest.fixture(scope="module")
def runs() -> dict[str, list[jid.Recording]]:
    benches = {
        "plain": bench(),
        "late": bench(sensor_delay=1e-3),
        "loud": bench(sensor_noise=1.0, sensor_delay=4e-3),
        "answered": bench(velocity_noise=0.02, on_reference=0.0),
    }
    return dict(zip(benches, recordings(*benches.values()), strict=True))


def with_sensor(recording: jid.Recording, sensor: np.ndarray) -> jid.Recording:
    signals = {name: getattr(recording, name) for name in recording.signals} | {"sensor": sensor}
    return jid.Recording(**signals, torque_hold="zoh", truth=recording.truth)


def interpolated(recording: jid.Recording, delay: float) -> jid.Recording:
    time = recording.time
    assert recording.sensor is not None
    return with_sensor(recording, np.interp(time - delay, time, recording.sensor))


def delay_of(recording: jid.Recording) -> Any:
    joint = jid.thesis_joint()
    return jid.identify(recording, joint, search="separable").delays["sensor"]


@pytest.mark.parametrize("delay", [1.5e-3, 2.45e-3])
def test_jumps_tell_the_delay_to_a_part_of_a_sample(
    runs: dict[str, list[jid.Recording]], delay: float
) -> None:
    for run in runs["plain"]:
        found = delay_of(interpolated(run, delay))
        assert found.certain
        assert found.value == pytest.approx(delay, abs=1.5e-4)
        assert found.stderr < 9e-5


def test_without_a_delay_none_is_found(runs: dict[str, list[jid.Recording]]) -> None:
    assert not any(delay_of(run).certain for run in runs["plain"])


def test_a_reading_of_an_instant_may_be_later_than_its_jumps_say(
    runs: dict[str, list[jid.Recording]],
) -> None:
    """A held torque's jump shows at a whole sample, whatever part of a sample the reading is late by."""
    delay, gravity = 1.7e-3, 3.0 * 9.817 * 0.25 / 2.4
    for run in runs["late"]:
        assert run.sensor is not None
        earlier, at_jumps = (np.interp(run.time - d, run.time, run.position) for d in (delay, 1e-3))
        found = delay_of(
            with_sensor(run, run.sensor + gravity * (np.sin(earlier) - np.sin(at_jumps)))
        )
        assert abs(found.value - delay) < 2.5 * found.stderr
        assert found.stderr > 1e-4


def test_a_delay_that_is_not_sharp_is_stated_as_an_interval(
    runs: dict[str, list[jid.Recording]],
) -> None:
    """A late reading with more noise, of which the jumps say little."""
    run = runs["loud"][0]
    estimate = jid.identify(run, jid.thesis_joint(), search="separable")
    delay = estimate.delays["sensor"]
    assert 1.96 * delay.stderr > 3e-4
    (found,) = (each for each in estimate.findings if each.code == "delay_removed")
    low, high = (1e3 * (delay.value + side * 1.96 * delay.stderr) for side in (-1.0, 1.0))
    assert f"95 % interval: {low:.2f} to {high:.2f} ms" in found.details


def test_an_elastic_gear_is_no_delay() -> None:
    """It answers a jump late and in swings, which a pure delay does not."""
    stiffness = 0.4 * (2.0 * np.pi * 50.0) ** 2
    gear = {"gear_stiffness": stiffness, "gear_damping": 0.02 * stiffness**0.5}
    (elastic,) = recordings(bench(plant=gear), duration=8.0)
    for run in elastic:
        found = delay_of(run)
        assert not found.certain


def test_noise_that_the_joint_answers_is_no_feedback(runs: dict[str, list[jid.Recording]]) -> None:
    """Noise of the velocity is in the torque, and a sample later in the reading."""
    for run in runs["answered"]:
        assert not delay_of(run).certain
