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

    Dry friction is set-valued at rest: below breakaway the joint does not move at all. The command
    is held over each control period. Same arguments, same bits.

    Parameters
    ----------
    joint : Joint
        With a value for each parameter of its model: see `Joint.with_parameters`. Its link, if it
        has a sensor and ``gravity="none"``, hangs behind the sensor; a link without inertia is a
        point mass.
    controller : OpenLoop, Pd, Pid, CompensatedPid, AdaptiveRobust or LugreObserver
    trajectory : Trajectory
        For `OpenLoop` it is the torque.
    duration : float, optional
        [s]. Default: the trajectory's.
    control_period : float
        Between commands [s]. Default 0.001.
    sample_period : float, optional
        Between recorded samples [s], a whole number of control periods. Default: one. The recorded
        torque is then the mean of the commands until the next sample.
    integration_step : float, optional
        [s]; a whole number of them is a control period. Default: half of it.
    sensors : Sensors, optional
        Default: exact signals.
    payload : Link or float
        A payload on the joint in addition to its own link, behind the sensor; a number is a constant
        torque [N·m] against positive motion. Default 0.
    bristle : Bristle, optional
        Makes friction dynamic (Dahl, LuGre). Default: static.
    position, velocity : float, optional
        At the start [rad], [rad/s]. Default: the trajectory's position, at rest.
    seed : int
        Of the sensors' noise. Default 0.
    name : str
        Of the recording. Default ``""``.

    Returns
    -------
    SimulatedRecording
        Signals as the sensors measured them, the held torque, the reference; `truth` has the true
        parameters, `truth.signals` the true signals. Unless the sensors show an exact velocity,
        it is derived from the position, and what the controller had is in
        ``truth.signals["control_velocity"]``. ``metadata["saturations"]`` counts the control
        periods in which the torque limit cut the command.

    Raises
    ------
    InputError
        An argument that cannot be used, a term of the model that a simulation does not have, or a loop
        that is not stable.
    KeyboardInterrupt
        Ctrl-C, within 0.1 s.

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
