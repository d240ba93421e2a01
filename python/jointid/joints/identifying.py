"""`identify_joints`: identify every joint of a robot's recording, each alone."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, Unpack

from jointid.base.advice import Action
from jointid.base.argument_checks import require_kind
from jointid.base.error_text import joint_phrase
from jointid.base.errors import InputError
from jointid.base.options import takes
from jointid.identification.identification import identify
from jointid.identification.options import IdentifyOptions
from jointid.identification.search.search import Search
from jointid.joint.joint import Joint
from jointid.joint.model import Model
from jointid.joints.citing import cited
from jointid.joints.coupling import shares_of_others
from jointid.joints.record import FAILED, IDENTIFIED, JointResult
from jointid.joints.result import JointEstimates
from jointid.recording.recording import Recording
from jointid.recording.wide.joint_names import joint_named
from jointid.recording.wide.robot_recording import RobotRecording


@takes(IdentifyOptions)
def identify_joints(
    robot: RobotRecording,
    joints: Iterable[str | int] | str | None = None,
    *,
    joint: Joint | Mapping[str, Joint] | None = None,
    couplings: bool = True,
    callback: Callable[[str, int, int], None] | None = None,
    **options: Unpack[IdentifyOptions],
) -> JointEstimates:
    """Identify several joints from one recording, each alone, and find couplings between them.

    The estimate of a joint does not depend on the others, or on the number of threads. Its residual is then compared
    with the motion of all other joints on held-out data. The options of `identify` apply to each joint.

    Parameters
    ----------
    robot : RobotRecording
    joints : iterable of str or int, optional
        Names or numbers of the joints to identify. Default, and "all": all.
    joint : Joint or mapping of str to Joint, optional
        Known values of the joints: one for all, or by name. If the recording has no gear ratio, a
        ratio other than 1 is taken from here. Default: nothing is known.
    couplings : bool
        Whether residuals are compared with the other joints' motion. Default True.
    callback : callable, optional
        Called before each joint with its name, its number from 0, and the number of joints.
    **options

    Returns
    -------
    JointEstimates
        One result per joint. If a joint's recording cannot be used, the joint has the status "failed" and the reason.
        The other joints are still identified.

    Raises
    ------
    InputError
        A joint does not exist, an option is invalid, or gear ratios contradict each other.
    KeyboardInterrupt
        After Ctrl-C, within 0.1 s.

    Examples
    --------
    >>> robot = jid.load("arm.csv", joints="all", gear_ratio=[32, 32, 45, -48, 45, 32])
    >>> found = jid.identify(robot, joints=[1, 2, 3])
    >>> print(found.report())
    """
    started = time.perf_counter()
    require_kind("robot", robot, RobotRecording)
    names = _wanted(robot, joints)
    known = {name: _known(joint, name) for name in robot.names}
    robot = _with_ratios(robot, known)
    options["search"], options["model"] = Search.of(options["search"]), Model.of(options["model"])
    recordings = dict(robot)
    results: dict[str, JointResult] = {}
    for number, name in enumerate(names):
        if callback is not None:
            callback(name, number, len(names))
        recording = recordings[name]
        side = str(recording.metadata.get("side", "joint"))
        try:
            described = _described(known[name], name, robot, recording)
            estimate = identify(recording, described, **options)
        except InputError as error:
            failed = _with_drive(_of_each(error, len(names)), recording)
            results[name] = JointResult(name=name, status=FAILED, error=failed, side=side)
            continue
        results[name] = JointResult(name=name, status=IDENTIFIED, estimate=estimate, side=side)
    if couplings and len(recordings) > 1:
        results = _with_couplings(results, recordings)
    return JointEstimates(results=results, name=robot.name, seconds=time.perf_counter() - started)


_OF_EACH = {"gear_ratio", "torque_constant"}


def _of_each(error: InputError, joints: int) -> InputError:
    """Return an error with advice to state one gear ratio and torque constant for each joint."""
    remedies = tuple(
        Action(
            "call",
            each.arguments,
            "; ".join(filter(None, (each.text, "one value for each joint, separated by commas"))),
            each.function,
        )
        if isinstance(each, Action) and joints > 1 and set() < each.arguments.keys() <= _OF_EACH
        else each
        for each in error.remedy
    )
    return InputError(
        error.reason,
        argument=error.argument,
        value=error.value,
        place=error.place,
        remedy=remedies,
    )


def _with_drive(error: InputError, recording: Recording) -> InputError:
    """Return the error of a missing torque, with the advice to use the recorded wanted positions instead."""
    if error.argument != "torque" or recording.reference is None:
        return error
    whole = Action(
        "call",
        {"robot": ...},
        "with a position drive in the robot's facts, because wanted positions are recorded",
        "identify_robot",
    )
    return InputError(
        error.reason,
        argument=error.argument,
        value=error.value,
        place=error.place,
        remedy=(*error.remedy, whole),
    )


def _with_couplings(
    results: dict[str, JointResult], recordings: Mapping[str, Recording]
) -> dict[str, JointResult]:
    """Return the results with the other joints' shares; then again for joints that explain a part of others."""
    found = {
        name: shares_of_others(each.estimate, name, recordings) if each.estimate else ()
        for name, each in results.items()
    }
    owed: dict[str, set[str]] = {name: set() for name in results}
    for name, shares in found.items():
        for share in shares:
            if share.joint in owed:
                owed[share.joint].add(name)
    coupled = {}
    for name, each in results.items():
        expected = owed[name] - {share.joint for share in found[name]}
        if expected and each.estimate is not None:
            found[name] = shares_of_others(each.estimate, name, recordings, expected)
        estimate = None if each.estimate is None else cited(each.estimate, found[name])
        coupled[name] = replace(each, estimate=estimate, others=found[name])
    return coupled


def _wanted(robot: RobotRecording, joints: Iterable[str | int] | str | None) -> list[str]:
    if joints is None or joints == "all":
        return list(robot.names)
    given = [joints] if isinstance(joints, str | int) else list(joints)
    names = [
        joint_named(each, robot.names, robot.name, "joints", "identify_joints") for each in given
    ]
    if not names:
        raise InputError("at least one joint is expected", argument="joints", value=[])
    return list(dict.fromkeys(names))


def _known(joint: Joint | Mapping[str, Joint] | None, name: str) -> Joint | None:
    if joint is None or isinstance(joint, Joint):
        return joint
    if not isinstance(joint, Mapping):
        raise InputError(
            "a Joint, or a mapping from joint names to Joints, is expected",
            argument="joint",
            value=joint,
        )
    for key in (name, int(name) if name.isdigit() else name):
        if key in joint:
            found: Joint = joint[key]  # type: ignore[index]
            require_kind(f"joint[{key!r}]", found, Joint)
            return found
    return None


def _with_ratios(robot: RobotRecording, known: Mapping[str, Joint | None]) -> RobotRecording:
    """Return the recording with the joints' gear ratios, if it has none."""
    ratios = [1.0 if known[name] is None else known[name].gear_ratio for name in robot.names]  # type: ignore[union-attr]
    if robot.gear_ratio is None:
        stated = any(ratio != 1.0 for ratio in ratios)
        return robot.with_gear_ratio(ratios) if stated and robot.side == "motor" else robot
    for name, ratio, own in zip(robot.names, ratios, robot.gear_ratio, strict=True):
        if ratio not in (1.0, own):
            raise InputError(
                f"the recording has the gear ratio {own:g} for {joint_phrase(name)}",
                argument="gear_ratio",
                value=ratio,
                remedy="state the gear ratio only once",
            )
    return robot


def _described(
    joint: Joint | None, name: str, robot: RobotRecording, recording: Recording
) -> Joint | None:
    """Return the known values of a joint, with its name and the recording's gear ratio."""
    if joint is None:
        if recording.sensor is not None:
            return None  # the recording shows that there is a sensor, and no joint contradicts it
        if recording.torque is None:
            return None  # no joint states the relation of motor torque to joint torque
        joint = Joint(kind=recording.kind)
    changes: dict[str, Any] = {} if joint.name else {"name": joint_phrase(name)}
    if robot.gear_ratio is not None and joint.gear_ratio == 1.0:
        changes["gear_ratio"] = robot.gear_ratio[robot.names.index(name)]
    return joint.replace(**changes) if changes else joint
