"""Simulate many closed loops side by side."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.joint import Joint
from jointid.joint.link import Link
from jointid.recording.signals import FloatArray
from jointid.simulation.arguments import (
    Controller,
    finite,
    positive,
    side_by_side,
    whole_multiple,
)
from jointid.simulation.plant import Bristle, Values, simulated_joint
from jointid.simulation.simulated_recording import SimulatedRecording
from jointid.simulation.trajectory import Trajectory

_SUBSTEPS = 2  # integration steps in a control period, by default
_MOST_PERIODS = 1e9  # largest number of control periods of a simulation, as in the core


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulatedBatch:
    """Results of many simulations, with one entry for each simulation.

    Parameters
    ----------
    error : ndarray, shape (n,)
        Root mean square of the true tracking error after the settling time [rad].
    peak_error : ndarray, shape (n,)
        Largest magnitude of the true tracking error after the settling time [rad].
    saturations : ndarray, shape (n,)
        Number of control periods in which the torque limit cut the command.
    recordings : tuple of SimulatedRecording
        Empty without `recordings=True`.

    Examples
    --------
    >>> law, motion = jid.Pd(stiffness=8000.0, damping=400.0), jid.Trajectory.thesis(duration=2.0)
    >>> jid.simulate_batch([known, known], law, motion).saturations.tolist()
    [0, 0]
    """

    error: FloatArray
    peak_error: FloatArray
    saturations: np.ndarray[Any, np.dtype[np.int64]]
    recordings: tuple[SimulatedRecording, ...]


def simulate_batch(
    joints: Joint | Sequence[Joint],
    controllers: Controller | Sequence[Controller],
    trajectory: Trajectory,
    *,
    duration: float | None = None,
    control_period: float = 1e-3,
    sample_period: float | None = None,
    integration_step: float | None = None,
    sensors: _core.Sensors | None = None,
    payload: Link | float = 0.0,
    bristle: Bristle | None = None,
    position: float | None = None,
    velocity: float = 0.0,
    seeds: int | Sequence[int] = 0,
    settling: float | None = None,
    recordings: bool = False,
    threads: int = 0,
    name: str = "",
) -> SimulatedBatch:
    """Simulate many joints, controllers or seeds along one trajectory, in parallel.

    Each result is bit-identical to the result of `simulate`.

    Parameters
    ----------
    joints, controllers, seeds
        One value for all simulations, or a sequence with one value for each. All sequences have the same length.
    settling : float, optional
        Time at the start that the tracking error excludes [s]. Default: a sixth of the duration.
    recordings : bool
        Whether to keep the recordings with all signals. Default False.
    threads : int
        Number of threads. Default 0: all processors.
    trajectory, duration, control_period, sample_period, integration_step, sensors, payload, \
bristle, position, velocity, name
        As in `simulate`.

    Returns
    -------
    SimulatedBatch

    Raises
    ------
    InputError
        The errors of `simulate`, or sequences have different lengths.

    Examples
    --------
    >>> motion, law = jid.Trajectory.thesis(duration=2.0), jid.Pd(stiffness=8000.0, damping=400.0)
    >>> batch = jid.simulate_batch([known, known.with_parameters({"viscous": 30.0})], law, motion)
    >>> batch.error.shape
    (2,)
    """
    if not isinstance(trajectory, Trajectory):
        raise InputError("a Trajectory is expected", argument="trajectory", value=trajectory)
    joint_list, controller_list, seed_list = side_by_side(joints, controllers, seeds)
    if not isinstance(payload, Link):
        payload = finite("payload", payload)
    if bristle is not None and not isinstance(bristle, Bristle):
        raise InputError("a Bristle is expected", argument="bristle", value=bristle)
    if sensors is not None and not isinstance(sensors, _core.Sensors):
        raise InputError("a Sensors value is expected", argument="sensors", value=sensors)
    period = positive("control_period", control_period)
    every = 1 if sample_period is None else whole_multiple("sample_period", sample_period, period)
    length = trajectory.duration if duration is None else positive("duration", duration)
    if length > _MOST_PERIODS * period:
        # The message names the argument that is further from its usual value.
        name, value = ("control_period", period) if length <= 1e6 else ("duration", length)
        raise InputError(
            f"{length:g} s would be {length / period:.3g} control periods of {period:g} s; "
            f"at most {_MOST_PERIODS:g} are possible",
            argument=name,
            value=value,
        )
    scenario = _core.Scenario(
        duration=length,
        control_period=period,
        integration_step=(
            period / _SUBSTEPS
            if integration_step is None
            else positive("integration_step", integration_step)
        ),
        sample_every=every,
        settling=length / 6.0 if settling is None else finite("settling", settling),
        sensors=_core.Sensors() if sensors is None else sensors,
    )
    setups, truths = [], []
    for joint, controller, seed in zip(joint_list, controller_list, seed_list, strict=True):
        setup, truth = setup_of(joint, controller, seed, payload, bristle, scenario)
        start = trajectory.core.at(0.0)[0] if not isinstance(controller, _core.OpenLoop) else 0.0
        setups.append(
            setup.replace(
                position=start if position is None else finite("position", position),
                velocity=finite("velocity", velocity),
            )
        )
        truths.append(truth)
    outcomes = _core.simulate_runs(
        scenario, trajectory.core, setups, signals=recordings, threads=threads
    )
    made = (
        _recording(outcome, joint, controller, truth, scenario, seed, name)
        for outcome, joint, controller, truth, seed in zip(
            outcomes, joint_list, controller_list, truths, seed_list, strict=True
        )
    )
    return SimulatedBatch(
        error=np.array([outcome.rms_error for outcome in outcomes]),
        peak_error=np.array([outcome.peak_error for outcome in outcomes]),
        saturations=np.array([outcome.saturations for outcome in outcomes], dtype=np.int64),
        recordings=tuple(made) if recordings else (),
    )


def setup_of(
    joint: Joint,
    controller: Controller,
    seed: int,
    payload: Link | float,
    bristle: Bristle | None,
    scenario: _core.Scenario,
) -> tuple[_core.Setup, dict[str, float]]:
    """Return one run in the core's form, and the true parameters."""
    values = Values(joint)
    plant = simulated_joint(joint, values, payload, bristle)
    setup = _core.Setup(
        joint=plant,
        controller=controller,
        gear_ratio=joint.gear_ratio,
        sensor_gain=values.need("sensor_gain") if joint.sensor else 1.0,
        sensor_offset=values.need("sensor_offset") if joint.sensor else 0.0,
        seed=seed,
    )
    truth = dict(values.used)
    if scenario.sensors.ripple > 0.0:
        truth["sensor_ripple"] = scenario.sensors.ripple
    return setup, truth


def _recording(
    outcome: _core.Outcome,
    joint: Joint,
    controller: Controller,
    truth: dict[str, float],
    scenario: _core.Scenario,
    seed: int,
    name: str,
) -> SimulatedRecording:
    signals = outcome.signals
    count = len(signals["position"])
    torque = signals["torque"]
    time = np.arange(count) * (scenario.control_period * scenario.sample_every)
    time.flags.writeable = False
    return SimulatedRecording(
        time=time,
        position=signals["position"],
        # A controller's online estimate lags. The recording's signal is differentiated centrally instead.
        velocity=signals["velocity"] if scenario.sensors.velocity == "exact" else None,
        torque=torque,
        sensor=signals["reading"] if joint.sensor else None,
        reference=None if isinstance(controller, _core.OpenLoop) else signals["reference"],
        kind=joint.kind,
        torque_hold="zoh",
        name=name,
        metadata={
            "simulated": True,
            "controller": repr(controller),
            "sensors": scenario.sensors.asdict(),
            "control_period": scenario.control_period,
            "integration_step": scenario.integration_step,
            "seed": seed,
            "saturations": outcome.saturations,
        },
        truth=truth,
        true_signals={
            "position": signals["true_position"],
            "velocity": signals["true_velocity"],
            "acceleration": signals["true_acceleration"],
            "friction": signals["friction"],
            "link_torque": signals["link_torque"],
            "motor_torque": torque / joint.gear_ratio,
            "control_velocity": signals["velocity"],
        },
    )
