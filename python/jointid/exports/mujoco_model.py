"""MuJoCo: a model of the joint alone, or damping, friction and armature of a joint in an existing model."""

from __future__ import annotations

import math

from jointid.exports.identifiers import identifier
from jointid.exports.inertial import body_of, drive_inertia
from jointid.exports.nearest import Nearest, nearest_friction
from jointid.exports.provenance import statements
from jointid.exports.subject import Subject
from jointid.exports.target import Existing, Order, Target
from jointid.exports.voltage_actuator import VOLTAGE_NOTES, voltage_motor
from jointid.exports.xml_patch import (
    Element,
    attribute,
    comment,
    elements,
    only,
    with_attributes,
    with_comment,
)
from jointid.joint.checks import suggestion
from jointid.simulation.plant import torque_limit

_STEP = 0.0005
# MuJoCo's dry friction is a soft constraint. It fades below a speed that is proportional to this time
# constant. The default is 0.02 s.
_CONSTANT, _SOFTNESS = 0.002, 0.01
# The same speed with MuJoCo's default solreffriction and solimpfriction, relative to ours.
_USUAL = (0.1 / 0.9) * (0.95 * 0.02) / (_SOFTNESS * _CONSTANT)
_LEAST_SHARE = 0.02
_LONGEST = 60  # characters of a name in our own file


def _write(subject: Subject, order: Order) -> bytes:
    nearest = nearest_friction(subject, approximate=order.approximate, target="mujoco")
    if order.into is not None:
        return _edited(subject, nearest, order.into)
    return _model(subject, nearest, identifier(order.name, longest=_LONGEST)).encode()


def loss_notes(subject: Subject, nearest: Nearest) -> list[str]:
    """Return sentences about the effects that the nearest Coulomb and viscous friction loses."""
    if not nearest.lost:
        return []
    unit = subject.torque_unit
    notes = [f"lost: {each}" for each in nearest.lost]
    load = " without load" if subject.law.loaded_by else ""
    if nearest.speed is None:  # the friction is exact
        return notes
    return [
        *notes,
        f"friction here is {nearest.constant!r} {unit} + {nearest.slope!r} {unit}*s/{subject.position_unit} * speed, "
        f"the least-squares fit over speeds up to {nearest.speed!r} {subject.position_unit}/s, equally weighted",
        f"largest difference of the torque over this range: {nearest.worst:.4g} {unit}"
        f"{load}; root mean square difference of the friction: {nearest.rms:.4g} {unit}",
    ]


def _edited(subject: Subject, nearest: Nearest, into: Existing) -> bytes:
    found = elements(into.content, into.place)
    joint = only(found, into.joint, _is_joint, into.place, suggestion)
    changes = {"damping": repr(nearest.slope), "frictionloss": repr(nearest.constant)}
    notes = loss_notes(subject, nearest)
    armature = drive_inertia(subject)
    if armature is None:
        notes.append(
            "armature is unchanged: the identified inertia includes the link's inertia, but this model already has a "
            "link"
        )
    else:
        changes["armature"] = repr(armature)
    slides = joint.attributes.get("type") == "slide"
    changes |= _soft_friction(_body_share(subject, armature) if slides else 1.0)
    notes.append(
        f"dry friction is a soft constraint: below about {_creep(subject, nearest):.2g} {subject.position_unit}/s, "
        "friction fades and the joint creeps; with MuJoCo's default solreffriction and solimpfriction, this speed is "
        f"{_creep(subject, nearest) * _USUAL:.2g}; time steps above {_CONSTANT / 2.0!r} s make the constraint softer "
        "in proportion"
    )
    if slides and changes.get("armature"):
        notes.append(
            "for a prismatic joint, MuJoCo softens friction by the body's mass without the armature: add the mass to "
            "the body, or set the joint's solimpfriction nearer to 1"
        )
    notes += _elsewhere(subject)
    if subject.law.offset:
        notes.append(f"constant torque of {subject.law.offset!r} {subject.torque_unit}")
    lines = statements(subject, notes=notes)
    edited = with_attributes(into.content, joint, changes)
    return with_comment(edited, joint, lines)


def _soft_friction(share: float) -> dict[str, str]:
    """Return the constraint's stiffness. For a sliding joint, MuJoCo takes the body's share as the whole mass."""
    hard = repr(1.0 / (1.0 + _SOFTNESS * share))
    return {
        "solreffriction": f"{_CONSTANT!r} 1",
        "solimpfriction": f"{hard} {hard} 0.001 0.5 2",
    }


def _body_share(subject: Subject, armature: float | None) -> float:
    """Return the body's share of the moved mass or inertia, if it can be separated from the drive's."""
    total = subject.law.total_inertia
    if total is None or armature is None:
        return 1.0
    return max(_LEAST_SHARE, min(1.0, (total - armature) / total))


def _is_joint(element: Element) -> bool:
    return element.tag == "joint" and "body" in element.path


def _elsewhere(subject: Subject) -> list[str]:
    """Return notes on effects that the surrounding model must represent."""
    notes = []
    if subject.law.over("gravity"):
        notes.append("gravity: MuJoCo computes it from the masses of this file")
    if subject.law.sensor is not None:
        notes.append("calibration of the torque sensor")
    return notes


def _model(subject: Subject, nearest: Nearest, name: str) -> str:
    joint, law = subject.joint, subject.law
    body = body_of(subject)
    notes = loss_notes(subject, nearest)
    if law.sensor is not None:
        notes.append("calibration of the torque sensor")
    if body.note:
        notes.append(body.note)
    notes.append(
        f"dry friction is a soft constraint: below about {_creep(subject, nearest):.2g} "
        f"{subject.position_unit}/s, friction fades and the joint creeps"
    )
    if joint.voltage is not None:
        notes += VOLTAGE_NOTES
    slides = joint.kind == "prismatic"
    kind, axis = ("slide", "1 0 0") if slides else ("hinge", "0 -1 0")
    limits = ""
    if joint.limits.position is not None:
        low, high = joint.limits.position
        limits = f' limited="true" range="{low!r} {high!r}"'
    soft = _soft_friction(body.mass / (body.mass + body.drive) if slides else 1.0)
    softness = " ".join(f'{key}="{value}"' for key, value in soft.items())
    x, z = body.distance * math.cos(body.angle), body.distance * math.sin(body.angle)
    lines = [
        f"<mujoco model={attribute(name)}>",
        f"  {comment([*statements(subject, notes=notes)], '  ')}",
        '  <compiler angle="radian"/>',
        f'  <option timestep="{_STEP!r}" integrator="implicitfast" gravity="0 0 {0.0 - body.gravity!r}"/>',
        "  <worldbody>",
        f"    <body name={attribute(f'{name}_link')}>",
        f'      <inertial pos="{x!r} 0 {z!r}" mass="{body.mass!r}" diaginertia="{body.inertia!r} {body.inertia!r}'
        f' {body.inertia!r}"/>',
        f'      <joint name={attribute(name)} type="{kind}" axis="{axis}" damping="{nearest.slope!r}"'
        f' frictionloss="{nearest.constant!r}" armature="{body.drive!r}"{limits}',
        f"             {softness}/>",
        "    </body>",
        "  </worldbody>",
        "  <actuator>",
        f"    {_actuator(subject, name)}",
        "  </actuator>",
        "</mujoco>",
        "",
    ]
    return "\n".join(lines)


def _actuator(subject: Subject, name: str) -> str:
    """Return the motor. Its control and its force are the motor torque, which the gear converts to joint torque."""
    joint = subject.joint
    if joint.voltage is not None:
        return voltage_motor(joint, joint.voltage, name)
    gear = joint.gear_ratio
    limit = torque_limit(joint)
    offset = subject.law.offset
    text = f'joint={attribute(name)} gear="{gear!r}"'
    if limit is not None:
        text += f' ctrllimited="true" ctrlrange="{-limit / abs(gear)!r} {limit / abs(gear)!r}"'
    if not offset:
        return f"<motor name={attribute(f'{name}_motor')} {text}/>"
    # A constant torque against the drive, not affected by its limit.
    bias = f'gaintype="fixed" gainprm="1" biastype="affine" biasprm="{-offset / gear!r} 0 0"'
    return f"<general name={attribute(f'{name}_motor')} {text} {bias}/>"


def _creep(subject: Subject, nearest: Nearest) -> float:
    """Return the speed below which MuJoCo's dry friction fades, with the settings above."""
    total = subject.law.total_inertia or 1.0
    return nearest.constant / total * _SOFTNESS * _CONSTANT / 2.0


TARGET = Target(name="mujoco", endings=(".xml",), meaning="MuJoCo model", write=_write, edits=True)
