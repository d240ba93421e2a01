"""The peer of `identify_servo`: pycma's CMA-ES on rollouts of the same model, as in usual fits of servos."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import cma
import numpy as np
from numpy.typing import NDArray

import jointid as jid
from jointid import _core
from jointid.servo.rolling_out import servo_loop, servo_plant
from jointid.servo.signals import ServoSignals, signals_of

Array = NDArray[np.float64]

# Lowest and highest: torque constant, resistance, viscous, Coulomb, friction of the load, inertia. On the logarithm.
LOW = np.array([0.1, 1.0, 1e-4, 1e-5, 1e-3, 2e-4])
HIGH = np.array([1.0, 10.0, 0.1, 0.1, 0.5, 0.01])

FLAT = 1e-6
"""A search ends when its best errors differ by less [rad], 6e-5 degrees."""


def described(joint: jid.Joint, values: Array) -> jid.Joint:
    """Return the joint with these values."""
    assert joint.voltage is not None
    k_t, resistance, viscous, coulomb, load, inertia = (float(value) for value in values)
    return joint.replace(
        torque_constant=k_t,
        inertia=inertia,
        voltage=replace(joint.voltage, resistance=resistance),
    ).with_parameters({"viscous": viscous, "coulomb": coulomb, "load_friction": load})


def cost_of(joint: jid.Joint, runs: Sequence[ServoSignals]) -> Callable[[Array], Array]:
    """Return the mean error of all runs' rollouts [rad], of many sets of values at once."""
    start = described(joint, np.sqrt(LOW * HIGH))
    loops = [servo_loop(start, run) for run in runs]
    logs = [
        (run.time, run.duty if run.reference is None else run.reference, run.supply, run.driven)
        for run in runs
    ]

    def costs(points: Array) -> Array:
        tried = []
        for k_t, resistance, viscous, coulomb, load, inertia in points:
            plant = servo_plant(joint, inertia, {"viscous": viscous, "coulomb": coulomb})
            motor = {"torque_per_voltage": k_t / resistance, "back_emf": k_t * k_t / resistance}
            tried += [loop.replace(joint=plant, load_friction=load, **motor) for loop in loops]
        motions = _core.roll_out_servos(tried, logs * len(points), step=1e-3)
        errors = [
            np.mean(np.abs(position - runs[k % len(runs)].position))
            for k, (position, _) in enumerate(motions)
        ]
        means: Array = np.reshape(errors, (len(points), -1)).mean(axis=1)
        return means

    return costs


def evolved(
    recordings: Sequence[jid.Recording],
    joint: jid.Joint,
    *,
    load_friction: bool,
    searches: int = 2,
    population: int = 12,
    generations: int = 250,
    seed: int = 0,
) -> tuple[list[float], int]:
    """Return the values with the rollouts nearest to the logs, and the number of sets of rollouts.

    Parameters
    ----------
    recordings : sequence of Recording
    joint : Joint
    load_friction : bool
    searches : int
        Number of searches with their own seeds. The best counts, because one search may miss the optimum.
    population, generations : int
        A search ends earlier when its errors have become flat.
    seed : int
    """
    costs = cost_of(joint, signals_of(recordings, joint))
    free = [k for k in range(6) if k != 4 or load_friction]
    low, high = np.log(LOW[free]), np.log(HIGH[free])

    def values_of(points: Array) -> Array:
        values = np.zeros((len(points), 6))
        values[:, free] = np.exp(low + (high - low) * points)
        return values

    options = {
        "bounds": [0.0, 1.0],
        "verbose": -9,
        "popsize": population,
        "maxiter": generations,
        "tolfun": FLAT,
        "tolfunhist": FLAT,
    }
    evaluations, best, found = 0, np.inf, np.full(len(free), 0.5)
    for number in range(searches):
        strategy = cma.CMAEvolutionStrategy(
            np.full(len(free), 0.5), 0.25, {**options, "seed": 1 + searches * seed + number}
        )
        while not strategy.stop():
            points = strategy.ask()
            strategy.tell(points, list(costs(values_of(np.array(points)))))
            evaluations += len(points)
        if strategy.result.fbest < best:
            best, found = strategy.result.fbest, np.asarray(strategy.result.xbest)
    return [float(value) for value in values_of(found[None])[0]], evaluations
