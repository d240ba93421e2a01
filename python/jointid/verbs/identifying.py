"""`identify`: estimate a joint, a servo, several joints or a robot from recordings."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Unpack, overload

from jointid.estimate.estimate import Estimate
from jointid.identification import identification
from jointid.identification.options import IdentifyOptions
from jointid.joint.joint import Joint
from jointid.recording.recording import Recording
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.options import RobotOptions
from jointid.servo.options import ServoOptions
from jointid.verbs.signatures import shows
from jointid.verbs.subjects import WORDS, ask, listed, second, subject_of

if TYPE_CHECKING:
    from jointid.joints.result import JointEstimates
    from jointid.robot.links.inertia_modes import Inertia
    from jointid.robot.links.robot import Robot
    from jointid.robot.result.result import RobotEstimate
    from jointid.servo.estimate import ServoEstimate


# A type checker cannot distinguish a servo from another joint: without servo options it assumes a joint.
@overload
def identify(
    recordings: Recording | Sequence[Recording],
    subject: Joint | None = None,
    **options: Unpack[IdentifyOptions],
) -> Estimate: ...


@overload
def identify(
    recordings: Recording | Sequence[Recording], subject: Joint, **options: Unpack[ServoOptions]
) -> ServoEstimate: ...


@overload
def identify(
    recordings: RobotRecording | Sequence[RobotRecording],
    subject: Robot,
    *,
    inertia: Inertia = "urdf",
    **options: Unpack[RobotOptions],
) -> RobotEstimate: ...


@overload
def identify(
    recordings: RobotRecording,
    subject: Joint | Mapping[str, Joint] | None = None,
    *,
    joints: Iterable[str | int] | str | None = None,
    couplings: bool = True,
    callback: Callable[[str, int, int], None] | None = None,
    **options: Unpack[IdentifyOptions],
) -> JointEstimates: ...


@shows(
    identification.identify,
    others={"joints": None, "couplings": True, "callback": None, "inertia": "urdf"},
    options=IdentifyOptions,
    servo=ServoOptions,
    robot=RobotOptions,
)
def identify(recordings: Any, subject: Any = None, **of_other_subjects: Any) -> Any:
    """Identify friction, inertia and torque sensor of a joint, a servo, several joints or a robot from ordinary motion.

    The torque balance is integrated over windows, so no acceleration is needed (thesis 4-21 to 4-24). The subject
    determines the method:

    - A joint is identified from one recording or several recordings.
    - A servo is a joint with `voltage`. It is identified from runs without a torque signal. If each recording has a
      torque, a motor torque, or a current with the joint's `torque_constant`, the servo is identified like any other
      joint. ``jid.load(..., columns={"torque": None})`` omits a torque signal.
    - Several joints are identified from one recording, one after the other. Then the residual of each joint is
      compared with the motion of the other joints.
    - A robot is identified from one or several recordings of all joints. Friction of all joints and inertia of the
      links are identified together.

    Parameters
    ----------
    recordings : Recording, RobotRecording, or sequence of these
        Several recordings share all parameters except those of `per_recording`.
    subject : Joint, mapping of str to Joint, or Robot, optional
        Known values, bounds and the model. For several joints: one `Joint` for all, or a mapping from names to
        joints. Default: inertia, friction and an offset are identified with bounds from the data. A recorded torque
        sensor is also identified.
    **options

    Other Parameters
    ----------------
    joints : iterable of str or int, optional
        Several joints: names or numbers of the joints to identify. Default, or "all": all joints.
    couplings : bool
        Several joints: whether the residual of each joint is compared with the motion of the other joints. Default
        True.
    callback : callable, optional
        Several joints: function that is called before each joint is identified, with its name, its number (from 0),
        and the number of joints.
    **servo
    inertia : {"urdf", "scaled", "free"}
        Robot: source of the inertias of the links. "urdf" uses the URDF's inertias, "scaled" scales them link by
        link. "free" identifies base parameters, the combinations of inertias that affect the torque. Default
        ``"urdf"``.
    **robot

    Returns
    -------
    Estimate, ServoEstimate, JointEstimates or RobotEstimate

    Raises
    ------
    InputError
        The input cannot be used, or an option does not apply to the subject. The error states the reason.
    KeyboardInterrupt
        After Ctrl-C, within 0.1 s.

    Examples
    --------
    A joint:

    >>> estimate = jid.identify(jid.load("run.csv"), joint, model="stribeck")
    >>> round(estimate["coulomb"].value)
    25
    >>> windows = jid.WindowOptions(duration=0.02)
    >>> estimate = jid.identify(recording, joint, windows=windows, parameters={"viscous": {"min": 0.0, "max": 40.0}})

    A servo:

    >>> found = jid.identify(servo_runs, servo, draws=100)
    >>> found["torque_per_voltage"] > 0.0
    True

    Several joints:

    >>> arm = jid.load("arm.csv", joints="all")
    >>> [*jid.identify(arm, joints=["elbow"]).results]
    ['elbow']

    A robot:

    >>> robot = jid.Robot.from_urdf("arm.urdf")
    >>> found = jid.identify(arm, robot, inertia="scaled")
    >>> found.joints["elbow"].parameters["coulomb"].unit
    'N·m'
    """
    options = of_other_subjects
    subject, recordings = second(subject, options, "joint", "robot"), listed(recordings)
    kind = subject_of("identify", recordings, subject)
    words = "identify", WORDS[kind]
    if kind == "joint":
        return ask(*words, identification.identify, recordings, subject, **options)
    if kind == "servo":
        from jointid.servo.identifying import identify_servo

        return ask(*words, identify_servo, recordings, subject, **options)
    if kind == "robot":
        from jointid.robot.identifying import identify_robot

        return ask(*words, identify_robot, recordings, subject, **options)
    from jointid.joints.identifying import identify_joints

    joints = options.pop("joints", None)
    return ask(*words, identify_joints, recordings, joints, joint=subject, **options)
