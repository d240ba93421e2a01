"""Subject of a verb's call, and refusal of arguments that do not fit it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Literal

from jointid.base.errors import InputError
from jointid.base.result import Result
from jointid.joint.joint import Joint
from jointid.recording.recording import Recording
from jointid.recording.wide.robot_recording import RobotRecording

Subject = Literal["joint", "servo", "joints", "robot"]

WORDS: dict[Subject, str] = {
    "joint": "a joint",
    "servo": "a servo",
    "joints": "several joints",
    "robot": "a robot",
}
_SEVERAL = 'jid.load(path, joints="all") reads a RobotRecording'


def subject_of(verb: str, recordings: object, subject: object) -> Subject:
    """Return the kind of subject of recordings; refuse combinations that do not fit."""
    if is_robot(subject):
        if not _wide(recordings):
            raise InputError(
                f"{verb} of a robot needs a RobotRecording, or several",
                argument="recordings",
                value=recordings,
                remedy=_SEVERAL,
            )
        return "robot"
    refuse_result(verb, subject)
    if _wide(recordings):
        if not isinstance(recordings, RobotRecording):
            raise InputError(
                f"{verb} of several recordings of a robot needs a jid.Robot",
                argument="subject",
                value=subject,
                remedy=("give jid.Robot.from_urdf(path)", "give one of the recordings"),
            )
        return "joints"
    if isinstance(subject, Mapping):
        raise InputError(
            f"{verb} with joints by name needs a RobotRecording",
            argument="recordings",
            value=recordings,
            remedy=_SEVERAL,
        )
    if not isinstance(subject, Joint) or subject.voltage is None:
        return "joint"
    return "joint" if _torque_is_known(recordings, subject) else "servo"


def is_robot(subject: object) -> bool:
    """Return whether the subject is a robot; the robot modules are imported only if it may be one."""
    if subject is None or isinstance(subject, Joint):
        return False
    from jointid.robot.links.robot import Robot

    return isinstance(subject, Robot)


OtherKind = Literal["robot", "robot estimate", "servo estimate", "joint estimates"]


def other_kind(subject: object) -> OtherKind | None:
    """Return the kind of a subject that is not a single joint; other modules are imported only for these."""
    if isinstance(subject, Joint):
        return None
    from jointid.joints.result import JointEstimates
    from jointid.robot.links.robot import Robot
    from jointid.robot.result.result import RobotEstimate
    from jointid.servo.estimate import ServoEstimate

    kinds: dict[type, OtherKind] = {
        Robot: "robot",
        RobotEstimate: "robot estimate",
        ServoEstimate: "servo estimate",
        JointEstimates: "joint estimates",
    }
    return next((word for kind, word in kinds.items() if isinstance(subject, kind)), None)


def refuse_result(verb: str, subject: object) -> None:
    """Refuse a result as an argument in place of its joint or robot."""
    if not isinstance(subject, Result):
        return
    remedies = [f"give its .{part}" for part in ("joint", "robot") if hasattr(subject, part)]
    raise InputError(
        f"{verb} takes a Joint or a Robot, not a result",
        argument="subject",
        value=subject,
        remedy=tuple(remedies),
    )


def listed(recordings: Any) -> Any:
    """Return recordings that may be read more than once: an iterator as a list."""
    return list(recordings) if isinstance(recordings, Iterator) else recordings


def second(subject: Any, options: dict[str, Any], *names: str) -> Any:
    """Return the subject, also from a former keyword; that keyword is then removed from the options."""
    for name in names:
        if name in options:
            if subject is not None:
                raise InputError("the subject is already given", argument=name)
            subject = options.pop(name)
    return subject


def ask(verb: str, word: str, function: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
    """Call a function for a subject; refuse an option that it does not have, with the verb's name in the message."""
    check_options(verb, word, options, keywords(function)[len(arguments) :])
    return function(*arguments, **options)


def keywords(function: Callable[..., Any]) -> list[str]:
    """Return the names of a function's keywords, in order."""
    import inspect

    parameters = inspect.signature(function).parameters.values()
    return [each.name for each in parameters if each.kind != each.VAR_KEYWORD]


def check_options(verb: str, word: str, options: Mapping[str, Any], known: Sequence[str]) -> None:
    """Refuse an option that a subject does not have."""
    for name, value in options.items():
        if name not in known:
            raise _no_option(verb, word, name, value, known)


def _no_option(verb: str, word: str, name: str, value: object, known: Sequence[str]) -> InputError:
    from difflib import get_close_matches

    close = get_close_matches(name, known, n=1)
    remedy = f"did you mean {close[0]!r}?" if close else f"its options are {', '.join(known)}"
    return InputError(
        f"{verb} of {word} has no such option", argument=name, value=value, remedy=remedy
    )


def _wide(recordings: object) -> bool:
    """Return whether recordings contain several joints on one clock."""
    several = recordings if isinstance(recordings, list | tuple) else (recordings,)
    return any(isinstance(each, RobotRecording) for each in several)


def _torque_is_known(recordings: object, joint: Joint) -> bool:
    """Return whether all recordings have the drive's torque, or the current of a motor with a known constant."""
    runs = recordings if isinstance(recordings, list | tuple) else (recordings,)
    return all(
        isinstance(run, Recording)
        and (
            run.torque is not None
            or run.motor_torque is not None
            or (run.current is not None and joint.torque_constant is not None)
        )
        for run in runs
    )
