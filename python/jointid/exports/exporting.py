"""Write an identified joint for another program."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from jointid.base.advice import Action
from jointid.base.argument_checks import require_kind, require_path
from jointid.base.errors import InputError
from jointid.base.files import write_whole
from jointid.estimate.estimate import Estimate
from jointid.joint.checks import check_flag, positive_number
from jointid.joint.joint import Joint
from jointid.robot.result.result import RobotEstimate
from jointid.servo.estimate import ServoEstimate

if TYPE_CHECKING:
    from jointid.exports.target import Existing, Target

_LARGEST = 64 * 2**20  # largest number of bytes of a file to edit


def export(
    source: Estimate | Joint | RobotEstimate | ServoEstimate,
    path: str | os.PathLike[str],
    *,
    target: str | None = None,
    into: str | os.PathLike[str] | None = None,
    joint_name: str | None = None,
    approximate: bool = False,
    speed: float | None = None,
    inertia: bool = False,
) -> Path:
    """Write an identified joint for a simulator, a controller, a PLC or Simulink.

    Each file states its source, units, signs and gear ratio, and the standard error and 95 % interval of each
    parameter. The file lists the parameters that the recording does not determine, and the effects that the format
    cannot represent. Numbers have all digits. The file is written completely or not at all.

    Parameters
    ----------
    source : Estimate, Joint, ServoEstimate or RobotEstimate
        Identified values. A joint needs values for all parameters of its model; its file states no uncertainty. A
        servo is exported as its identified joint, also without uncertainty. Damping and friction of a whole robot
        are written into its URDF, the file `into`.
    path : path-like
        File name. Its ending determines the target: ``.xml`` (MuJoCo), ``.urdf``, ``.h`` (C99), ``.st`` (IEC
        61131-3 Structured Text), ``.mat`` (Simulink).
    target : {"mujoco", "urdf", "c", "st", "matlab"}, optional
        Target that overrides the file ending.
    into : path-like, optional
        An existing MuJoCo or URDF file. The new file is a copy with new damping and friction of one joint. In
        MuJoCo, the joint's armature and the stiffness of its dry friction also change. A comment is added before
        the joint. All other bytes are unchanged. `into` may be the same file as `path`. Default: a new file with a
        model of this joint alone.
    joint_name : str, optional
        Name of the joint in `into`. Default: the joint's own name.
    approximate : bool
        Whether to approximate friction. MuJoCo and URDF have only Coulomb and viscous friction, equal in both
        directions. False (default) refuses other friction. True writes the nearest Coulomb and viscous friction
        over the recorded speeds. The file states the lost effects.
    speed : float, optional
        Largest speed of the approximated friction and of tables [rad/s or m/s]. Default: the largest speed of the
        estimate's recordings, or the joint's limit.
    inertia : bool
        Whether to write the links' inertia too, for a whole robot identified with ``inertia="free"`` or "scaled".
        The inertia of a link then includes all bodies fixed to it. Default False.

    Returns
    -------
    Path
        Path of the file.

    Raises
    ------
    InputError
        The file ending is unknown, a parameter has no value, `into` has no such joint, the target cannot represent
        the model, or scipy is not installed (for ``.mat``).
    OSError
        The file cannot be written.

    Examples
    --------
    >>> jid.export(estimate, "joint_friction.h").name
    'joint_friction.h'
    >>> jid.export(estimate, "arm.xml", into="arm.xml", joint_name="shoulder", approximate=True)  # doctest: +SKIP
    PosixPath('arm.xml')
    """
    from jointid.exports.registry import (
        target_of,  # writers of formats: `import jointid` does not need them
    )
    from jointid.exports.subject import subject_of
    from jointid.exports.target import Order

    if isinstance(source, Mapping):
        names = [str(name) for name in source]
        raise InputError(
            f"these are the estimates of several joints ({', '.join(names)}); one estimate is expected",
            argument="source",
            remedy=f"choose one: `source[{names[0]!r}]`" if names else (),
        )
    if isinstance(source, RobotEstimate):
        return _export_robot(source, path, target, into, joint_name, approximate, inertia)
    if isinstance(source, ServoEstimate):
        source = source.identified
    require_kind("source", source, Estimate, Joint)
    check_flag("", "inertia", inertia)
    if inertia:
        raise InputError("this option is only for a whole robot", argument="inertia", value=inertia)
    place = require_path("path", path)
    if target is not None:
        require_kind("target", target, str)
    if joint_name is not None:
        require_kind("joint_name", joint_name, str)
    check_flag("", "approximate", approximate)
    peak = None if speed is None else positive_number("", "speed", speed)
    chosen = target_of(place, target)
    subject = subject_of(source, peak)
    order = Order(
        name=subject.joint.name or place.name.partition(".")[0],
        approximate=approximate,
        into=_existing(chosen, into, joint_name or subject.joint.name),
    )
    if joint_name is not None and order.into is None:
        raise InputError(
            "this option names a joint in a file to edit, but `into` is missing",
            argument="joint_name",
            value=joint_name,
        )
    write_whole(place, chosen.write(subject, order))
    return place


def _export_robot(
    source: RobotEstimate,
    path: str | os.PathLike[str],
    target: str | None,
    into: str | os.PathLike[str] | None,
    joint_name: str | None,
    approximate: bool,
    inertia: bool,
) -> Path:
    from jointid.exports.registry import target_of
    from jointid.exports.robot_urdf import robot_in_urdf

    place = require_path("path", path)
    chosen = target_of(place, target)
    if chosen.name != "urdf":
        raise InputError(
            "a whole robot is written into its URDF",
            argument="path" if target is None else "target",
            value=str(path) if target is None else target,
            remedy="name a file to write that ends in .urdf"
            if target is None
            else "use the target urdf",
        )
    if into is None:
        raise InputError(
            "a whole robot is written into its URDF: name this URDF",
            argument="into",
            remedy=Action("call", {"into": ...}, function="export"),
        )
    if joint_name is not None:
        raise InputError(
            "all joints of the robot are written", argument="joint_name", value=joint_name
        )
    check_flag("", "approximate", approximate)
    check_flag("", "inertia", inertia)
    existing = _existing(chosen, into, source.robot.names[0])
    assert existing is not None
    content = robot_in_urdf(
        source, existing.content, existing.place, approximate=approximate, inertia=inertia
    )
    write_whole(place, content)
    return place


def _existing(target: Target, into: str | os.PathLike[str] | None, joint: str) -> Existing | None:
    """Read the file to edit."""
    from jointid.exports.registry import TARGETS
    from jointid.exports.target import Existing

    if into is None:
        return None
    path = require_path("into", into)
    if not target.edits:
        able = " and ".join(each.name for each in TARGETS if each.edits)
        raise InputError(f"only {able} files can be edited", argument="into", value=str(path))
    if not joint:
        raise InputError("the name of the joint in the file is missing", argument="joint_name")
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError("the file is too large", argument="into", value=str(path))
        content = path.read_bytes()
    except OSError as error:
        raise InputError(
            f"the file cannot be read: {error.strerror}", argument="into", value=str(path)
        ) from error
    return Existing(content=content, place=str(path), joint=joint)
