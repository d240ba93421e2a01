"""Systematic errors from what the windows hold: friction between samples, and the instant of a sensor's sample."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import jointid as jid
from jointid.identification.inference.systematic import held

Array = NDArray[np.float64]


@pytest.mark.parametrize(
    ("call", "recording", "joint", "is_held"),
    [
        (None, None, None, False),
        (None, "zoh", None, True),
        (None, None, "zoh", True),
        ("linear", "zoh", "zoh", False),
        ("zoh", "linear", None, True),
        (None, "linear", "zoh", False),
    ],
)
def test_who_says_that_a_torque_is_held(
    call: Any, recording: Any, joint: Any, is_held: bool
) -> None:
    problem: Any = SimpleNamespace(
        settings=SimpleNamespace(torque_hold=call),
        joint=None if joint is None else SimpleNamespace(torque_hold=joint),
    )
    run: Any = SimpleNamespace(torque_hold=recording)
    assert held(problem, run) == is_held


def test_the_curvature_between_samples_is_what_finer_samples_move() -> None:
    """Fading friction sampled coarsely: the stated error is most of what the trapezoidal rule makes of it."""
    truth = {"coulomb": 10.0, "static": 10.0, "stribeck": 60.0, "viscous": 5.0}

    rate = 2.0 * np.pi * 4.0

    def velocity(time: Array) -> Array:
        return 0.21 + 0.2 * np.cos(rate * time)  # one way: no reversal within an interval

    period = 8e-3
    time = np.arange(0.0, 20.0, period)
    # What the drive gives in the mean until the next sample.
    within = time[:, None] + period * (np.arange(64) + 0.5) / 64.0
    level = truth["coulomb"] + truth["static"] * np.exp(-truth["stribeck"] * velocity(within) ** 2)
    torque = -0.2 * rate * np.sin(rate * within) + truth["viscous"] * velocity(within) + level
    run = jid.Recording(
        time=time,
        position=0.21 * time + 0.2 / rate * np.sin(rate * time),
        velocity=velocity(time),
        torque=torque.mean(axis=1),
        torque_hold="zoh",
    )
    joint = jid.Joint(inertia=1.0)
    estimate = jid.identify(run, joint, model="stribeck", search="separable")
    found = estimate.parameters["static"]
    # The first term of the error; samples are so far apart here that the next one counts, too.
    assert 0.65 < found.systematic["curvature"] / abs(found.value - truth["static"]) < 0.95
