"""Simulate a joint in closed loop."""

from jointid import _core
from jointid.joint.joint import Joint
from jointid.joint.link import Link
from jointid.simulation.arguments import Controller
from jointid.simulation.batch import simulate_batch
from jointid.simulation.plant import Bristle
from jointid.simulation.simulated_recording import SimulatedRecording
from jointid.simulation.trajectory import Trajectory


def simulate(
    joint: Joint,
    controller: Controller,
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
    seed: int = 0,
    name: str = "",
) -> SimulatedRecording:
    """Simulate a joint that a controller moves along a trajectory.

    Below the breakaway torque the joint does not move. The command is held over each control period. The same
    arguments give bit-identical results.

    Parameters
    ----------
    joint : Joint
        A joint with a value for each parameter of its model; see `Joint.with_parameters`. With a sensor and
        ``gravity="none"`` its link is behind the sensor. A link without inertia is a point mass.
    controller : OpenLoop, Pd, Pid, CompensatedPid, AdaptiveRobust or LugreObserver
    trajectory : Trajectory
        The desired motion; for `OpenLoop` the desired torque.
    duration : float, optional
        Duration of the simulation [s]. Default: the trajectory's.
    control_period : float
        Time between commands [s]. Default 0.001.
    sample_period : float, optional
        Time between recorded samples [s], a whole number of control periods. Default: one period. The
        recorded torque is the mean of the commands until the next sample.
    integration_step : float, optional
        Integration step [s]. The control period is a whole number of steps. Default: half the control period.
    sensors : Sensors, optional
        Default: exact signals.
    payload : Link or float
        A payload in addition to the joint's link, behind the sensor. A number is a constant torque [N·m]
        against positive motion. Default 0.
    bristle : Bristle, optional
        Dynamic friction (Dahl, LuGre). Default: static friction.
    position, velocity : float, optional
        Start values [rad], [rad/s]. Default: the trajectory's position, at rest.
    seed : int
        Seed of the sensors' noise. Default 0.
    name : str
        Name of the recording. Default ``""``.

    Returns
    -------
    SimulatedRecording
        The measured signals, the held torque and the reference. `truth` has the true parameters, and
        `truth.signals` the true signals. Without a sensor of exact velocity, the velocity is derived from the
        position. ``truth.signals["control_velocity"]`` is the velocity that the controller used.
        ``metadata["saturations"]`` counts the control periods in which the torque limit cut the command.

    Raises
    ------
    InputError
        An argument is invalid, a simulation does not have a term of the model, or the loop is unstable.
    KeyboardInterrupt
        After Ctrl-C, within 0.1 s.

    Examples
    --------
    >>> run = jid.simulate(known, jid.Pd(stiffness=8000.0, damping=400.0), jid.Trajectory.thesis(duration=2.0))
    >>> len(run), run.truth["viscous"]
    (2000, 20.0)
    >>> sensors = jid.Sensors(encoder_counts=8000, velocity="difference", torque_noise=0.5)
    >>> law, motion = jid.Pd(stiffness=8000.0, damping=400.0), jid.Trajectory.thesis(duration=2.0)
    >>> run = jid.simulate(known, law, motion, sensors=sensors)
    """
    batch = simulate_batch(
        joint,
        controller,
        trajectory,
        duration=duration,
        control_period=control_period,
        sample_period=sample_period,
        integration_step=integration_step,
        sensors=sensors,
        payload=payload,
        bristle=bristle,
        position=position,
        velocity=velocity,
        seeds=seed,
        recordings=True,
        threads=1,
        name=name,
    )
    return batch.recordings[0]
