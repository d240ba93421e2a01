"""A whole robot's friction into its URDF: damping and friction of every identified joint."""

from __future__ import annotations

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.exports.robot_inertia import with_link_inertias
from jointid.exports.urdf_model import is_joint, with_children
from jointid.exports.xml_patch import elements, only, with_attributes, with_comment
from jointid.joint.checks import suggestion
from jointid.robot.result import RobotEstimate, RobotJoint


def robot_in_urdf(
    estimate: RobotEstimate, content: bytes, place: str, *, approximate: bool, inertia: bool
) -> bytes:
    """Return a URDF with the damping and friction of all joints of an estimate; the rest keeps its bytes.

    Parameters
    ----------
    estimate : RobotEstimate
    content : bytes
        The URDF.
    place : str
        Its name, for errors.
    approximate : bool
        Whether what URDF has not may be lost: static friction above Coulomb friction, friction that differs between
        the directions, and friction of coupled motors.
    inertia : bool
        Whether the links get their identified inertia, too.

    Raises
    ------
    InputError
        Something would be lost and must not, or the URDF has no such joint.
    """
    for joint in estimate.joints.values():
        lost = _lost(joint)
        if lost and not approximate:
            raise InputError(
                f"URDF has Coulomb and viscous friction of single joints; {joint.name} has {' and '.join(lost)}",
                argument="approximate",
                value=False,
                remedy=Action("call", {"approximate": True}, "to lose that", "export"),
            )
        content = _with_dynamics(content, place, joint)
    return with_link_inertias(estimate, content, place) if inertia else content


def _with_dynamics(content: bytes, place: str, joint: RobotJoint) -> bytes:
    found = elements(content, place)
    element = only(found, joint.name, is_joint, place, suggestion)
    children = [each for each in found if each.parent == found.index(element)]
    p = joint.parameters
    changes = {"damping": repr(p["viscous"].value), "friction": repr(p["coulomb"].value)}
    dynamics = [each for each in children if each.tag == "dynamics"]
    if dynamics:
        content = with_attributes(content, dynamics[0], changes)
    else:
        content = with_children(content, element, children, [("dynamics", changes)])
    # The start tag of the joint stands before what was changed.
    return with_comment(content, element, _lines(joint))


def _lost(joint: RobotJoint) -> list[str]:
    names = {
        "static": "static friction",
        "viscous_difference": "friction that differs between the directions",
        "motor_coulomb": "friction of a coupled motor",
    }
    return [
        text
        for name, text in names.items()
        if name in joint.parameters and joint.parameters[name].value != 0.0
    ]


def _lines(joint: RobotJoint) -> list[str]:
    lines = [f"{joint.name}, identified with all joints of the robot; values ± standard error"]
    for p in joint.parameters.values():
        error = "" if p.stderr is None else f" ± {p.stderr:.3g}"
        written = {"viscous": ", written as damping", "coulomb": ", written as friction"}
        lines.append(f"{p.name}: {p.value!r}{error} {p.unit}{written.get(p.name, '')}".rstrip())
    lost = _lost(joint)
    if lost:
        lines.append(f"not in this file: {' and '.join(lost)}")
    return lines
