"""Write a whole robot's friction into its URDF: damping and friction of every identified joint."""

from __future__ import annotations

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.exports.robot_inertia import with_link_inertias
from jointid.exports.urdf_model import is_joint, with_children
from jointid.exports.xml_patch import elements, only, with_attributes, with_comment
from jointid.joint.checks import suggestion
from jointid.robot.links.models import terms_of
from jointid.robot.links.parameters import DIFFERENCE, MOTOR_TERMS, VISCOUS
from jointid.robot.result.record import RobotJoint
from jointid.robot.result.result import RobotEstimate

_DAMPING, _FRICTION = "damping", "friction"  # attribute names in the URDF


def robot_in_urdf(
    estimate: RobotEstimate, content: bytes, place: str, *, approximate: bool, inertia: bool
) -> bytes:
    """Return a URDF with the damping and friction of all joints of an estimate. The rest keeps its bytes.

    `approximate` omits friction that URDF cannot represent. `inertia` also writes the links' identified inertia.
    """
    for joint in estimate.joints.values():
        lost = _lost(joint)
        if lost and not approximate:
            raise InputError(
                f"URDF has only Coulomb and viscous friction of single joints; {joint.name} also has "
                f"{' and '.join(lost)}",
                argument="approximate",
                value=False,
                remedy=Action(
                    "call", {"approximate": True}, "to leave this friction out", "export"
                ),
            )
        content = _with_dynamics(content, place, joint)
    return with_link_inertias(estimate, content, place) if inertia else content


def _with_dynamics(content: bytes, place: str, joint: RobotJoint) -> bytes:
    found = elements(content, place)
    element = only(found, joint.name, is_joint, place, suggestion)
    children = [each for each in found if each.parent == found.index(element)]
    changes = dict.fromkeys((_DAMPING, _FRICTION), repr(0.0))
    changes |= {word: repr(joint.parameters[name].value) for name, word in _written(joint).items()}
    dynamics = [each for each in children if each.tag == "dynamics"]
    if dynamics:
        content = with_attributes(content, dynamics[0], changes)
    else:
        content = with_children(content, element, children, [("dynamics", changes)])
    # The start tag of the joint precedes the changed part.
    return with_comment(content, element, _lines(joint))


def _written(joint: RobotJoint) -> dict[str, str]:
    """Return the URDF attribute for each parameter that URDF has."""
    terms = terms_of(joint.model)
    words = {term.name: _FRICTION for term in terms if term.settles}
    return words | {term.name: _DAMPING for term in terms if term.basis == VISCOUS.basis}


def _lost(joint: RobotJoint) -> list[str]:
    written = _written(joint)
    names = {
        **{
            t.name: "friction under load" if t.needs_load else f"{t.name} friction"
            for t in terms_of(joint.model)
            if t.name not in written
        },
        **{
            shape: "friction that rises smoothly"
            for t in terms_of(joint.model)
            if t.settles
            for shape in t.shapes
        },
        DIFFERENCE: "friction that differs between the directions",
        **dict.fromkeys(MOTOR_TERMS, "friction of a coupled motor"),
    }
    lost = (
        text
        for name, text in names.items()
        if name in joint.parameters and joint.parameters[name].value != 0.0
    )
    return list(dict.fromkeys(lost))


def _lines(joint: RobotJoint) -> list[str]:
    lines = [f"{joint.name}, identified with all joints of the robot; values ± standard error"]
    written = _written(joint)
    for p in joint.parameters.values():
        error = "" if p.stderr is None else f" ± {p.stderr:.3g}"
        word = f", written as {written[p.name]}" if p.name in written else ""
        lines.append(f"{p.name}: {p.value!r}{error} {p.unit}{word}".rstrip())
    lost = _lost(joint)
    if lost:
        lines.append(f"not in this file: {' and '.join(lost)}")
    return lines
