"""Match the columns of a recording with the joints of a robot."""

from __future__ import annotations

from collections.abc import Sequence

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.wide.joint_names import joint_named
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.recording.wide.robot_signals import LISTED


def joint_columns(joints: Sequence[str], recording: RobotRecording) -> list[int]:
    """Return the recording's column of each joint of a robot, as described in `Robot.columns_of`."""
    names = recording.names
    if all(joint in names for joint in joints):
        return [names.index(joint) for joint in joints]
    in_order = len(names) == len(joints) and not set(joints) & set(names)
    if in_order and recording.metadata.get(LISTED):
        return list(range(len(joints)))
    numbered = [_numbered(joint, names) for joint in joints]
    found = [names.index(each) for each in numbered if each is not None]
    if len(set(found)) == len(joints):
        return found
    if in_order:
        return list(range(len(joints)))
    raise _lacking(joints, recording)


def _numbered(joint: str, names: Sequence[str]) -> str | None:
    """Return the recording's joint that has the number at the end of a joint's name; None if there is none."""
    digits = joint[len(joint.rstrip("0123456789")) :]
    try:
        return joint_named(int(digits), names, "") if digits else None
    except InputError:
        return None


def _lacking(joints: Sequence[str], recording: RobotRecording) -> InputError:
    """Return the error for a recording that lacks joints of the robot, with a line that corrects it."""
    names = recording.names
    both = f"the robot has the joints {', '.join(joints)}, the recording has {', '.join(names)}"
    renamed = "give the recording's joints the URDF's names"
    fits = [each for each in joints if each in names or _numbered(each, names) is not None]
    if not fits:
        return InputError(
            f"no joint of the recording has the name of a robot joint: {both}",
            place=recording.name,
            remedy=renamed,
        )
    lacking = [each for each in joints if each not in fits]
    stated = Action(
        "call",
        {"joints": fits},
        text=f"if {' and '.join(lacking)} stood at 0",
        function="Robot.from_urdf",
    )
    return InputError(
        f"the recording lacks {', '.join(lacking)}: {both}",
        place=recording.name,
        remedy=(renamed, stated) if len(names) > len(fits) else stated,
    )
