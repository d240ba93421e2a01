"""Logs of a joint whose controller sets its torque once a row, or often between two rows."""

from __future__ import annotations

from functools import cache

import numpy as np

import jointid as jid

TRUTH = {"inertia": 1.0, "coulomb": 6.0, "viscous": 1.5}
PERIOD = 0.01


@cache
def log(seed: int, *, measured: bool = False, torque_hold: str | None = None) -> jid.Recording:
    """Rows of 10 ms of a joint whose controller sets its torque as often, or, measured, each millisecond."""
    rng = np.random.default_rng(seed)
    rates, phases = rng.uniform([0.3, 0.8, 1.6], [0.6, 1.4, 2.4]), rng.uniform(0, 6, 3)
    step = 0.1 * PERIOD if measured else PERIOD
    time = np.arange(0.0, 12.0001, step)
    angle = np.array([0.6, 0.3, 0.1]) @ np.sin(
        2.0 * np.pi * np.outer(rates, time) + phases[:, None]
    )
    joint = jid.Joint(inertia=1.0, model=jid.Model("coulomb_viscous")).with_parameters(TRUTH)
    run = jid.simulate(
        joint,
        jid.Pd(stiffness=300.0, damping=30.0),
        jid.Trajectory.from_samples(time, angle - angle[0]),
        sensors=jid.Sensors(torque_noise=0.1),
        control_period=step,
        seed=seed,
    )
    rows = slice(None, None, round(PERIOD / step))
    signals = {
        name: getattr(run, name)[rows] for name in ("time", "position", "velocity", "torque")
    }
    return jid.Recording(**signals, torque_hold=torque_hold)
