"""The peer of `identify_servo`: pycma's CMA-ES on rollouts of the same model, as servo fits are done elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import cma
import numpy as np
from numpy.typing import NDArray

import jointid as jid
from jointid import _core
from jointid.servo.rolling_out import servo_loop
from jointid.servo.signals import signals_of

Array = NDArray[np.float64]

# Lowest and highest: torque constant, resistance, viscous, Coulomb, friction of the load, inertia. On the logarithm.
LOW = np.array([0.1, 1.0, 1e-4, 1e-5, 1e-3, 2e-4])
HIGH = np.array([1.0, 10.0, 0.1, 0.1, 0.5, 0.01])


def described(joint: jid.Joint, values: Array) -> jid.Joint:
    """The joint with these values."""
    assert joint.voltage is not None
    k_t, resistance, viscous, coulomb, load, inertia = (float(value) for value in values)
    return joint.replace(
        torque_constant=k_t,
        inertia=inertia,
        voltage=replace(joint.voltage, resistance=resistance),
    ).with_parameters({"viscous": viscous, "coulomb": coulomb, "load_friction": load})


def evolved(
    recordings: Sequence[jid.Recording],
    joint: jid.Joint,
    *,
    load_friction: bool,
    generations: int = 60,
    population: int = 12,
    seed: int = 0,
) -> tuple[jid.Joint, int]:
    """Return the joint whose rollouts are nearest to the logs, and how many sets of rollouts that took.

    Parameters
    ----------
    recordings : sequence of Recording
    joint : Joint
    load_friction : bool
    generations, population, seed : int
    """
    runs = signals_of(recordings, joint)
    free = np.array([0, 1, 2, 3, 4, 5] if load_friction else [0, 1, 2, 3, 5])
    low, high = np.log(LOW[free]), np.log(HIGH[free])

    def values_of(x: Array) -> Array:
        values = np.zeros(6)
        values[free] = np.exp(low + (high - low) * x)
        return values

    logs = [
        (run.time, run.duty if run.reference is None else run.reference, run.supply, run.driven)
        for run in runs
    ]

    def costs(points: Array) -> Array:
        loops = [servo_loop(described(joint, values_of(x)), run) for x in points for run in runs]
        motions = _core.roll_out_servos(loops, logs * len(points), step=1e-3)
        errors = [
            np.mean(np.abs(position - runs[k % len(runs)].position))
            for k, (position, _) in enumerate(motions)
        ]
        means: Array = np.reshape(errors, (len(points), -1)).mean(axis=1)
        return means

    strategy = cma.CMAEvolutionStrategy(
        np.full(len(free), 0.5),
        0.25,
        {
            "bounds": [0.0, 1.0],
            "seed": seed + 1,
            "verbose": -9,
            "popsize": population,
            "maxiter": generations,
        },
    )
    evaluations = 0
    while not strategy.stop():
        points = strategy.ask()
        strategy.tell(points, list(costs(np.array(points))))
        evaluations += len(points)
    return described(joint, values_of(np.asarray(strategy.result.xbest))), evaluations
