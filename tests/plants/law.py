"""The controllers of the simulated joints."""

from __future__ import annotations

from dataclasses import dataclass

from plants.columns import Columns, PerRun


@dataclass(frozen=True, kw_only=True)
class Law(Columns):
    """Computed torque with estimates, PD or PID, and friction compensation.

    torque = inertia (q_d'' - 2 λ e' - λ² e) - integral ∫e dt + friction(estimates) + feedback · reading
    + gravity cos(q_d + gravity_angle), held between commands and limited.
    """

    every: PerRun = 1  # ticks between commands
    inertia: PerRun = 2.5
    stiffness: PerRun = 40.0  # λ [1/s]
    integral: PerRun = 0.0  # [N·m/(rad·s)]
    on_reference: PerRun = (
        0.0  # 1: friction is compensated at the reference velocity; 0: at the measured one
    )
    coulomb: PerRun = 15.0
    static: PerRun = 10.0
    stribeck: PerRun = 150.0
    viscous: PerRun = 10.0
    feedback: PerRun = 0.0  # of the sensor's reading, its presumed gain
    feedback_offset: PerRun = 0.0
    gravity: PerRun = 0.0
    gravity_angle: PerRun = -1.5707963267948966
    limit: PerRun = 160.0
