"""`simulate`: a joint in closed loop, or a servo along its logs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, overload

from jointid import _core
from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.estimate.rollout import Rollout
from jointid.joint.joint import Joint
from jointid.joint.link import Link
from jointid.recording.recording import Recording
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.servo.rolling_out import STEP, rollout
from jointid.simulation import simulation
from jointid.simulation.arguments import Controller
from jointid.simulation.plant import Bristle
from jointid.simulation.simulated_recording import SimulatedRecording
from jointid.simulation.trajectory import Trajectory
from jointid.verbs.signatures import shows
from jointid.verbs.subjects import OtherKind, ask, check_options, other_kind, second

if TYPE_CHECKING:
    from jointid.robot.result.result import RobotEstimate
    from jointid.servo.estimate import ServoEstimate


@overload
def simulate(
    subject: Joint | Estimate | ServoEstimate,
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
) -> SimulatedRecording: ...


@overload
def simulate(
    subject: RobotEstimate,
    *,
    recordings: RobotRecording | Sequence[RobotRecording],
    horizon: float | None = None,
    step: float = STEP,
) -> Rollout: ...


@overload
def simulate(
    subject: Joint | ServoEstimate,
    *,
    recordings: Recording | Sequence[Recording],
    step: float = STEP,
    threads: int = 0,
) -> Rollout: ...


@shows(simulation.simulate, others={"step": STEP, "threads": 0, "horizon": None})
def simulate(
    subject: Any = None,
    controller: Any = None,
    trajectory: Any = None,
    *,
    recordings: Any = None,
    **of_servos: Any,
) -> Any:
    """Simulate a joint that a controller moves along a trajectory, or a servo or a robot along its logs.

    Dry friction is set-valued at rest: below the breakaway torque, the joint does not move at all. The command is
    held over each control period. The same arguments give bit-identical results.

    With `recordings`, the closed loop of a servo is simulated from the recorded initial states and compared with the
    recorded positions. Only the reference, the supply and the signal "driven" are taken from the log. Without a known
    position loop, the logged duty replaces the reference. A robot follows its logged torques, in stretches that begin
    at the logged state. With a `drive`, the robot's position loop follows the logged reference positions. Both
    simulations are also compared with the URDF without friction.

    Parameters
    ----------
    subject : Joint, Estimate, ServoEstimate or RobotEstimate
        The subject needs a value for each parameter of its model: see `Joint.with_parameters`. With a sensor and
        ``gravity="none"``, the link is behind the sensor. A link without inertia is a point mass. A servo needs
        values of torque constant, resistance, inertia and friction.
    controller : OpenLoop, Pd, Pid, CompensatedPid, AdaptiveRobust or LugreObserver
        Controller of the joint. For a servo along its logs, only `recordings`, `step` and `threads` are used.
    trajectory : Trajectory
        Trajectory of the position; for `OpenLoop`, trajectory of the torque.
    duration : float, optional
        Duration [s]. Default: the duration of the trajectory.
    control_period : float
        Time between commands [s]. Default 0.001.
    sample_period : float, optional
        Time between recorded samples [s], a whole number of control periods. Default: one control period. The
        recorded torque is the mean of the commands until the next sample.
    integration_step : float, optional
        Integration step [s]; the control period is a whole number of steps. Default: half of the control period.
    sensors : Sensors, optional
        Sensors of the joint. Default: exact signals.
    payload : Link or float
        Payload behind the sensor, in addition to the joint's own link. A number is a constant torque [N·m] against
        positive motion. Default 0.
    bristle : Bristle, optional
        Bristle that makes friction dynamic (Dahl, LuGre). Default: static friction.
    position, velocity : float, optional
        Initial position [rad] and velocity [rad/s]. Default: at rest at the first position of the trajectory.
    seed : int
        Seed of the sensors' noise. Default 0.
    name : str
        Name of the recording. Default ``""``.

    Other Parameters
    ----------------
    recordings : Recording, RobotRecording, or sequence of these
        Servo or robot: its recordings, as for `identify`.
    step : float
        Servo or robot: longest integration step [s]. Default 1 ms.
    horizon : float, optional
        Robot: duration of a stretch [s]. Default with logged torques: 0.5, because errors of an open loop grow
        without bound. Default with a closed loop: the whole recording. At most the first 20 s of each recording are
        simulated.
    threads : int
        Servo: number of threads. Default 0: all processors. Results do not depend on the number.

    Returns
    -------
    SimulatedRecording or Rollout
        Recording with the measured signals, the held torque and the reference. `truth` has the true parameters, and
        `truth.signals` the true signals. Without a sensor of exact velocity, the velocity is derived from the
        position. ``truth.signals["control_velocity"]`` is the velocity that the controller used.
        ``metadata["saturations"]`` counts the control periods in which the torque limit cut the command. A `Rollout`
        is the result for a servo or a robot along its logs.

    Raises
    ------
    InputError
        An argument cannot be used, the simulation does not support a term of the model, the loop is unstable, a signal
        is missing, or the subject is not supported.
    KeyboardInterrupt
        After Ctrl-C, within 0.1 s.

    Examples
    --------
    A joint:

    >>> run = jid.simulate(known, jid.Pd(stiffness=8000.0, damping=400.0), jid.Trajectory.thesis(duration=2.0))
    >>> len(run), run.truth["viscous"]
    (2000, 20.0)
    >>> sensors = jid.Sensors(encoder_counts=8000, velocity="difference", torque_noise=0.5)
    >>> law, motion = jid.Pd(stiffness=8000.0, damping=400.0), jid.Trajectory.thesis(duration=2.0)
    >>> run = jid.simulate(known, law, motion, sensors=sensors)

    A servo along its logs:

    >>> found = jid.identify(servo_runs[1:], servo, draws=0)
    >>> predicted = jid.simulate(found, recordings=servo_runs[:1])
    >>> len(predicted.runs)
    1
    """
    subject = second(subject, of_servos, "joint", "estimate")
    kind = None if isinstance(subject, Estimate) else other_kind(subject)
    if recordings is None and _are_recordings(controller) and trajectory is None:
        controller, recordings = None, controller
    if kind == "robot estimate" and recordings is not None:
        from jointid.robot.rollout.rolling_out import rollout_robot

        check_options("simulate", "a robot along recordings", of_servos, ("horizon", "step"))
        return rollout_robot(subject, recordings, **of_servos)
    if kind is not None and kind != "servo estimate":
        raise InputError(
            "simulate takes one joint or servo",
            argument="subject",
            value=subject,
            remedy=_REMEDIES[kind],
        )
    if recordings is not None:
        return _along(subject, controller, trajectory, recordings, of_servos)
    joint = subject.identified if kind == "servo estimate" else subject
    joint = joint.joint if isinstance(joint, Estimate) else joint
    for name, value in (("controller", controller), ("trajectory", trajectory)):
        if value is None:
            raise InputError(
                "simulate of a joint needs a controller and a trajectory",
                argument=name,
                remedy="give recordings to simulate a servo along its logs",
            )
    return ask(
        "simulate", "a joint", simulation.simulate, joint, controller, trajectory, **of_servos
    )


def _along(
    subject: Any, controller: object, trajectory: object, recordings: Any, options: dict[str, Any]
) -> Rollout:
    """Return a servo's closed loop along its logs."""
    if isinstance(subject, Estimate) or (isinstance(subject, Joint) and subject.voltage is None):
        raise InputError(
            "simulate along recordings needs a servo: a joint with a voltage as its input",
            argument="recordings",
            remedy="give a controller and a trajectory instead",
        )
    both = {"controller": controller, "trajectory": trajectory}
    options = {name: value for name, value in both.items() if value is not None} | options
    word = "a servo along recordings"
    found: Rollout = ask("simulate", word, rollout, subject, recordings, **options)
    return found


def _are_recordings(value: object) -> bool:
    several = value if isinstance(value, list | tuple) else (value,)
    return bool(several) and all(isinstance(each, Recording | RobotRecording) for each in several)


_REMEDIES: dict[OtherKind, str] = {
    "robot": "give a jid.Joint with the values of one joint of the robot",
    "robot estimate": "give recordings, so that the logged torques move the arm",
    "joint estimates": "choose one: `found[NAME]`",
}
