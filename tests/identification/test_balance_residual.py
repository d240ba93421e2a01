"""Whether the balance of a slow motion fits better without a delay of the sensor."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

import jointid as jid
from jointid.identification.causes.fitted import Fitted
from jointid.identification.prepared import prepare
from jointid.identification.refinements.balance_residual import fits_better
from jointid.problem.problem import Problem
from jointid.recording.shifting import shifted

Array = NDArray[np.float64]

LATE = 0.0024  # [s]


def slow_motion(number: int) -> tuple[Problem, jid.Recording]:
    """The balance of a motion whose load changes slowly, the reading being late."""
    random = np.random.default_rng([8, number])
    rate = random.uniform(1.5, 3.0) * np.array([0.5, 1.0, 1.7])
    size = random.uniform(0.9, 1.6) * random.dirichlet([2.0, 2.0, 2.0])
    phase, steepness = random.uniform(0.0, 6.0, 3), random.uniform(50.0, 200.0)

    def signals(time: Array) -> tuple[Array, ...]:
        angle = rate * time[:, None] + phase
        position = np.sin(angle) @ size
        velocity = np.cos(angle) @ (size * rate)
        acceleration = -np.sin(angle) @ (size * rate**2)
        link = 0.3 * acceleration + 7.0 * np.sin(position)
        decay = np.exp(-steepness * velocity**2)
        friction = (25.0 + 18.0 * decay) * np.sign(velocity) + 20.0 * velocity
        return position, velocity, 2.5 * acceleration + friction + link, link

    time = np.arange(0.0, 12.0, 1e-3)
    position, velocity, torque, _ = signals(time)
    run = jid.Recording(
        time=time,
        position=position,
        velocity=velocity,
        torque=torque,
        sensor=(signals(time - LATE)[3] - 5.0) / 2.0,
    )
    joint = jid.Joint(inertia=2.5, sensor=True, model=jid.Model("stribeck"))
    return prepare((run,), joint, on_time=True).problem, run


@pytest.mark.parametrize("number", range(6))
def test_reversals_and_the_decay_of_friction_do_not_hide_a_late_reading(number: int) -> None:
    problem, run = slow_motion(number)

    def without(delay: float) -> Problem:
        return replace(problem, recordings=(shifted(run, {"sensor": delay}),))

    assert fits_better(problem, without(LATE), 0.2, reversals=False)
    assert not fits_better(without(LATE), without(2.0 * LATE), 0.0, reversals=False)


def test_a_torque_that_was_removed_adds_its_blocks_to_the_errors() -> None:
    problem, run = slow_motion(0)
    joint = jid.Joint(inertia=2.5, sensor=True, model=jid.Model("stribeck"))
    penalty = problem.penalty(None)
    parameters = jid.identify(run, joint, search="separable", shift={}).parameters
    best = np.array([parameters[name].value for name in penalty.names])
    free = tuple(i for i, name in enumerate(penalty.names) if parameters[name].vary)
    fit = Fitted.of(problem, penalty, best, free)
    # What a parameter takes up adds nothing.
    taken = fit.errors_beside(fit.jacobian[:, 0])
    assert max(taken.values()) < 1e-6
    size = np.sqrt(np.mean(fit.residual**2))
    noise = np.random.default_rng(1).normal(0.0, size, len(fit.residual))
    chance = size * np.sqrt(np.diag(np.linalg.inv(fit.jacobian.T @ fit.jacobian)))
    drift = fit.jacobian[:, 0] * np.linspace(-1.0, 1.0, len(noise))
    slow = drift * size / np.sqrt(np.mean(drift**2))
    by_chance, by_misfit = fit.errors_beside(noise), fit.errors_beside(slow)
    for error, index in zip(chance, free, strict=True):
        name = penalty.names[index]
        assert 0.5 * error < by_chance[name] < 2.0 * error, name
    assert max(by_misfit[name] / by_chance[name] for name in by_misfit) > 2.0
