"""Static friction that rests on a few windows is not determined, however well these fit."""

from __future__ import annotations

import numpy as np
import pytest
from plain_joint import torque

import jointid as jid

STATIC = 1.5


def reversing_twice(period: float, seed: int, duration: float = 6.0) -> jid.Recording:
    """Static friction that is gone at 0.3 rad/s, and two to four reversals to see it in."""
    time = np.arange(0.0, duration, period)
    slow, fast = 2.0 * np.pi / 8.0 * time + 0.3, 3.1 * time + seed
    rates = 2.0 * np.pi / 8.0, 3.1
    velocity = 1.5 * rates[0] * np.cos(slow) + 0.15 * rates[1] * np.cos(fast)
    acceleration = -1.5 * rates[0] ** 2 * np.sin(slow) - 0.15 * rates[1] ** 2 * np.sin(fast)
    noise = 0.05 * np.random.default_rng(seed).normal(size=len(time))
    excess = STATIC * np.sign(velocity) * np.exp(-((velocity / 0.15) ** 2))
    return jid.Recording(
        time=time,
        position=1.5 * np.sin(slow) + 0.15 * np.sin(fast),
        velocity=velocity,
        torque=torque(velocity, acceleration) + excess + noise,
    )


@pytest.mark.parametrize(("period", "seed"), [(0.05, 0), (0.06, 1), (0.06, 2)])
def test_static_friction_of_few_windows_is_not_determined(period: float, seed: int) -> None:
    run = reversing_twice(period, seed)
    estimate = jid.identify(run, model="stribeck")
    (found,) = (each for each in estimate.findings if each.code == "model_too_rich")
    assert "no window shows more than" in found.title
    assert found.evidence["static.shown"].value < 0.1
    assert "static" in found.parameters
    assert "static" not in jid.identify(run).parameters


@pytest.mark.parametrize("seed", range(3))
def test_static_friction_of_as_many_reversals_in_more_samples_is(seed: int) -> None:
    estimate = jid.identify(reversing_twice(0.005, seed))
    assert estimate.parameters["static"].value == pytest.approx(STATIC, rel=0.1)
    assert "model_too_rich" not in {each.code for each in estimate.findings}


@pytest.mark.parametrize("seed", [0, 4, 5])
def test_one_disturbed_passage_is_no_static_friction(seed: int) -> None:
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, 5.0, 0.005)
    slow = 2.0 * np.pi / rng.uniform(5.0, 9.0)
    turned = slow * time + rng.uniform(0.0, 6.0)
    fast = rng.uniform(2.0, 4.0)
    swung = fast * time + rng.uniform(0.0, 6.0)
    velocity = 1.5 * slow * np.cos(turned) + 0.15 * fast * np.cos(swung)
    acceleration = -1.5 * slow**2 * np.sin(turned) - 0.15 * fast**2 * np.sin(swung)
    pushed = torque(velocity, acceleration) + 0.05 * rng.normal(size=len(time))
    slowest = np.argsort(np.abs(velocity))[:12]
    pushed[slowest] += 3.0 * np.sign(velocity[slowest])
    run = jid.Recording(
        time=time,
        position=1.5 * np.sin(turned) + 0.15 * np.sin(swung),
        velocity=velocity,
        torque=pushed,
    )
    estimate = jid.identify(run, model="stribeck")
    (found,) = (each for each in estimate.findings if each.code == "model_too_rich")
    assert "only 3 of" in found.title
    assert "determine static" in found.title
