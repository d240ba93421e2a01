"""`rollout`: simulate a servo's closed loop from the logged initial state, and compare it with the log."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.estimate.rollout import Rollout, RunRollout
from jointid.joint.checks import positive_number
from jointid.joint.joint import Joint
from jointid.recording.recording import Recording
from jointid.servo.estimate import ServoEstimate
from jointid.servo.layout import LOAD_FRICTION, SPEED_FRICTION
from jointid.servo.signals import ServoSignals, signals_of

Array = NDArray[np.float64]

STEP = 1e-3
"""Default of the longest integration step [s]."""

_NUDGE = 0.01  # of the motor's torque, in both directions
_START = 0.03  # [s] of the log, for the initial velocity


def rollout(
    estimate: ServoEstimate | Joint,
    recordings: Recording | Sequence[Recording],
    *,
    step: float = STEP,
    threads: int = 0,
) -> Rollout:
    """Simulate a servo's closed loop along logs, from their initial states, and compare the positions.

    Only the wanted position, the supply and the signal "driven" are taken from the log; without a known position loop,
    the logged duty replaces the wanted position. Dry friction is set-valued: a servo that sticks stands still.

    Parameters
    ----------
    estimate : ServoEstimate or Joint
        A joint needs values of torque constant, resistance, inertia and friction.
    recordings : Recording or sequence of Recording
        Runs, as for `identify`.
    step : float
        Longest integration step [s]. Default 1 ms.
    threads : int
        Number of threads; 0 (default): all. Results do not depend on it.

    Returns
    -------
    Rollout

    Raises
    ------
    InputError
        A value or a signal is missing, or the motion diverges.

    Examples
    --------
    >>> found: jid.ServoEstimate = jid.identify(servo_runs[1:], servo)
    >>> predicted: jid.Rollout = jid.simulate(found, recordings=servo_runs[:1])
    >>> len(predicted.runs)
    1
    """
    joint = estimate.identified if isinstance(estimate, ServoEstimate) else estimate
    runs = signals_of(recordings, joint)
    step = positive_number("", "step", step)
    loops, logs = [], []
    for run in runs:
        loop = servo_loop(joint, run)
        log = (
            run.time,
            run.reference if run.closed and run.reference is not None else run.duty,
            run.supply,
            run.driven,
        )
        for factor in (1.0, 1.0 - _NUDGE, 1.0 + _NUDGE):
            loops.append(loop.replace(torque_per_voltage=factor * loop.torque_per_voltage))
            logs.append(log)
    motions = _core.roll_out_servos(loops, logs, step=step, threads=threads)
    return Rollout(runs=tuple(_run(run, motions[3 * k : 3 * k + 3]) for k, run in enumerate(runs)))


def servo_loop(joint: Joint, run: ServoSignals) -> _core.ServoLoop:
    """Return the core's model of a servo at the beginning of a run, or name the value that the joint lacks."""
    voltage = joint.voltage
    assert voltage is not None  # `signals_of` refuses joints without it
    k_t = abs(_needed(joint, "torque_constant", joint.torque_constant) * joint.gear_ratio)
    resistance = _needed(joint, "resistance", voltage.resistance)
    inertia = _needed(joint, "inertia", joint.reflected_inertia)
    values = {name: p.value for name, p in joint.parameters.items() if p.value is not None}
    plant = servo_plant(joint, inertia, values)
    loop = voltage.position_loop
    position, velocity = initial_state(run)
    return _core.ServoLoop(
        joint=plant,
        torque_per_voltage=k_t / resistance,
        back_emf=k_t * k_t / resistance,
        load_friction=values.get(LOAD_FRICTION.name, 0.0),
        closed=run.closed,
        gain=run.gain if run.closed else 1.0,
        saturation=1.0 if loop is None else loop.saturation,
        delay=0.0 if loop is None else loop.delay,
        position=position,
        velocity=velocity,
    )


def servo_plant(joint: Joint, inertia: float, values: Mapping[str, float]) -> _core.SimulatedJoint:
    """Return drive and link with speed-dependent friction; `inertia` is that of the drive, at the output [kg·m²].

    Friction that has no coefficient in `values` is left out.
    """
    weights = []
    if joint.link is not None:
        link = joint.link
        weights = [(link.mass * link.gravity * link.centre_of_mass, link.angle)]
    found = [(term.basis, values.get(term.name)) for term in SPEED_FRICTION]
    return _core.SimulatedJoint(
        inertia=inertia + joint.link_inertia,
        friction=[(basis, value, value, ()) for basis, value in found if value is not None],
        weights=weights,
    )


def initial_state(run: ServoSignals) -> tuple[float, float]:
    """Return position and velocity at the beginning of a log, by a line through its first samples.

    If the first samples stay within the position's resolution, the velocity is 0.
    """
    count = max(5, int(np.searchsorted(run.time, run.time[0] + _START)))
    time, position = run.time[:count] - run.time[0], run.position[:count]
    moved = np.abs(np.diff(run.position))
    resolution = float(moved[moved > 0.0].min()) if (moved > 0.0).any() else 0.0
    if np.ptp(position) <= 1.5 * resolution:
        return float(position[0]), 0.0
    slope, start = np.polyfit(time, position, 1)
    return float(start), float(slope)


def _needed(joint: Joint, name: str, value: float | None) -> float:
    if value is None:
        raise InputError(
            "a rollout needs this value",
            argument=name,
            place=joint.owner,
            remedy="identify the servo first, or state this value in the joint file",
        )
    return value


def _run(run: ServoSignals, motions: Sequence[tuple[Array, Array]]) -> RunRollout:
    position, velocity = motions[0]
    return RunRollout(
        name=run.name,
        time=run.time,
        position=position,
        velocity=velocity,
        measured=run.position,
        error=float(np.mean(np.abs(position - run.position))),
        spread=max(float(np.abs(other - position).max()) for other, _ in motions[1:]),
        closed=run.closed,
    )
