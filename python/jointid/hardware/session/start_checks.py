"""Reasons not to start a session, before the motor is on."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from jointid import _core
from jointid.hardware.session.drive import Drive, DriveSample
from jointid.hardware.session.limits import SessionLimits
from jointid.simulation.arguments import Controller
from jointid.simulation.trajectory import Trajectory

_FEWEST = 8  # samples of a recording
FULLEST_BUS = 0.8  # of its time; more leaves no room for an emergency or a repeated frame


def problems_on_paper(
    drive: Drive,
    controller: Controller,
    trajectory: Trajectory,
    limits: SessionLimits,
    period: float,
) -> Iterator[str]:
    """Problems that are known before the bus is used: its load, the trajectory."""
    load = drive.bus_load(period)
    if not load <= FULLEST_BUS:
        yield (
            f"a cycle takes {100.0 * load:.0f} % of the bus, more than {100.0 * FULLEST_BUS:.0f} %; take a "
            "longer period"
        )
    if trajectory.duration < _FEWEST * period:
        yield (
            f"the trajectory lasts {trajectory.duration:g} s; at least {_FEWEST} periods of {period:g} s are expected"
        )
        return
    wanted, speed, _ = trajectory.sample(np.arange(0.0, trajectory.duration, period))
    if isinstance(controller, _core.OpenLoop):
        largest = float(np.abs(wanted).max())
        if largest > limits.torque:
            yield f"the trajectory asks for {largest:.4g} N·m, more than {limits.torque:.4g} N·m"
        return
    low, high = limits.position
    if not (wanted.min() >= low and wanted.max() <= high):
        yield (
            f"the trajectory goes from {wanted.min():.4f} to {wanted.max():.4f} rad, outside {low:.4f} "
            f"to {high:.4f} rad"
        )
    fastest = float(np.abs(speed).max())
    if fastest > limits.velocity:
        yield f"the trajectory is up to {fastest:.3f} rad/s fast, more than {limits.velocity:g} rad/s"


def problems_at_rest(sample: DriveSample, limits: SessionLimits) -> Iterator[str]:
    """Problems with the state of a drive that is up, its motor off."""
    low, high = limits.position
    if not low <= sample.position <= high:
        yield (
            f"the joint stands at {sample.position:.4f} rad, outside {low:.4f} to {high:.4f} rad: is it homed?"
        )
    if sample.clipped:
        yield "the torque sensor is at the end of its range"
    elif not math.isfinite(sample.reading):
        yield f"the torque sensor reads {sample.reading}, which is not finite"
