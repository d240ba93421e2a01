"""URDF: a robot with only this joint, or the dynamics of a joint in an existing URDF."""

from __future__ import annotations

import math
import re

from jointid.base.errors import InputError
from jointid.exports.identifiers import identifier
from jointid.exports.inertial import body_of, drive_inertia
from jointid.exports.mujoco_model import loss_notes
from jointid.exports.nearest import Nearest, nearest_friction
from jointid.exports.provenance import statements
from jointid.exports.subject import Subject
from jointid.exports.target import Existing, Order, Target
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
from jointid.joint.link import STANDARD_GRAVITY
from jointid.simulation.plant import torque_limit

_LONGEST = 60  # characters of a name in our own file


def _write(subject: Subject, order: Order) -> bytes:
    nearest = nearest_friction(subject, approximate=order.approximate, target="urdf")
    if order.into is not None:
        return _edited(subject, nearest, order.into)
    return _robot(subject, nearest, identifier(order.name, longest=_LONGEST)).encode()


def _notes(subject: Subject, nearest: Nearest) -> list[str]:
    """Return notes on parts that URDF's dynamics cannot represent."""
    notes = loss_notes(subject, nearest)
    drive = drive_inertia(subject)
    if drive is not None:
        unit = "kg" if subject.joint.kind == "prismatic" else "kg·m²"
        notes.append(
            f"inertia of the drive at the output, which URDF cannot hold: {drive!r} {unit}"
        )
    if subject.law.offset:
        notes.append(f"constant torque of {subject.law.offset!r} {subject.torque_unit}")
    if subject.law.sensor is not None:
        notes.append("calibration of the torque sensor")
    return notes


def _edited(subject: Subject, nearest: Nearest, into: Existing) -> bytes:
    found = elements(into.content, into.place)
    joint = only(found, into.joint, is_joint, into.place, suggestion)
    number = found.index(joint)
    children = [each for each in found if each.parent == number]
    changes = {"damping": repr(nearest.slope), "friction": repr(nearest.constant)}
    notes = _notes(subject, nearest)
    if subject.law.over("gravity"):
        notes.append("gravity: the simulator computes it from the masses of this file")
    content = into.content
    # From the last to the first, so that earlier positions stay valid.
    edits: list[tuple[Element, dict[str, str]]] = []
    added = []
    dynamics = [each for each in children if each.tag == "dynamics"]
    if dynamics:
        edits.append((dynamics[0], changes))
    else:
        added.append(("dynamics", changes))
    known = _limits(subject)
    limits = [each for each in children if each.tag == "limit"]
    if limits:  # values from the robot's manufacturer are kept
        missing = {k: v for k, v in known.items() if k not in limits[0].attributes}
        if missing:
            edits.append((limits[0], missing))
    elif {"effort", "velocity"} <= known.keys():
        added.append(("limit", {name: known[name] for name in ("effort", "velocity")}))
    content = with_children(content, joint, children, added)
    for element, values in sorted(edits, key=lambda edit: -edit[0].start):
        content = with_attributes(content, element, values)
    return with_comment(content, joint, statements(subject, notes=notes))


def is_joint(element: Element) -> bool:
    """Return whether an element is a joint of the robot."""
    # Transmissions and controllers also name joints. Only the robot's own joints have a type.
    return element.tag == "joint" and "type" in element.attributes


def with_children(
    content: bytes, joint: Element, children: list[Element], added: list[tuple[str, dict[str, str]]]
) -> bytes:
    """Insert elements before the joint's end tag, indented like its other children."""
    if not added:
        return content
    if content[: joint.inner].endswith(b"/>"):
        raise InputError(
            "this joint has no parent and child",
            argument="joint_name",
            value=joint.attributes.get("name"),
        )
    newline = b"\r\n" if b"\r\n" in content else b"\n"
    inside = content[joint.inner : joint.stop]
    tail = re.search(rb"\s*\Z", inside)
    at = joint.inner + (tail.start() if tail else 0)
    layout = re.search(rb"\s*\Z", content[joint.inner : children[0].start]) if children else None
    space = layout[0] if layout else newline + b"    "
    text = b""
    for tag, values in added:
        pairs = " ".join(f"{name}={attribute(value)}" for name, value in values.items())
        text += space + f"<{tag} {pairs}/>".encode()
    return content[:at] + text + content[at:]


def _limits(subject: Subject) -> dict[str, str]:
    limits, effort = subject.joint.limits, torque_limit(subject.joint)
    known = {} if effort is None else {"effort": repr(effort)}
    return known if limits.velocity is None else known | {"velocity": repr(limits.velocity)}


def _robot(subject: Subject, nearest: Nearest, name: str) -> str:
    joint = subject.joint
    body = body_of(subject)
    notes = [*_notes(subject, nearest), "the link's inertia contains the inertia of the drive"]
    if body.note:
        notes.append(body.note)
    known = _limits(subject)
    slides = joint.kind == "prismatic"
    complete = {"effort", "velocity"} <= known.keys()
    position = joint.limits.position
    if slides and not (complete and position is not None):
        raise InputError(
            "the limit of a prismatic joint in URDF needs position, velocity and torque",
            argument="limits",
            place=joint.owner,
            remedy="give the joint's limits",
        )
    bounded = complete and position is not None
    if not bounded and (position is not None or known):
        kept = [f"{key} limit {value}" for key, value in known.items() if not complete]
        kept += [f"position limits {list(position)}"] if position is not None else []
        notes += [
            f"{each}: left out, because URDF needs the limits of position, velocity and torque together"
            for each in kept
        ]
    if bounded and position is not None:
        known = {"lower": repr(position[0]), "upper": repr(position[1]), **known}
    kind = "prismatic" if slides else "revolute" if bounded else "continuous"
    pairs = " ".join(f'{key}="{value}"' for key, value in known.items())
    limit = [f"    <limit {pairs}/>"] if complete else []
    x, z = body.distance * math.cos(body.angle), body.distance * math.sin(body.angle)
    axis = "1 0 0" if slides else "0 -1 0"
    base, link = attribute(f"{name}_base"), attribute(f"{name}_link")
    # URDF has no drive inertia. About the axis, one body has both.
    around = repr(body.inertia + (0.0 if slides else body.drive))
    mass = repr(body.mass + (body.drive if slides else 0.0))
    if body.gravity == 0.0:
        notes.append(
            "gravity: the model has none; switch gravity off in the simulation of this joint"
        )
    elif body.gravity != STANDARD_GRAVITY:
        notes.append(f"gravity of {body.gravity!r} m/s²")
    lines = [
        '<?xml version="1.0"?>',
        comment(statements(subject, notes=notes)),
        f"<robot name={attribute(name)}>",
        f"  <link name={base}/>",
        f"  <link name={link}>",
        "    <inertial>",
        f'      <origin xyz="{x!r} 0 {z!r}" rpy="0 0 0"/>',
        f'      <mass value="{mass}"/>',
        f'      <inertia ixx="{around}" ixy="0" ixz="0" iyy="{around}" iyz="0" izz="{around}"/>',
        "    </inertial>",
        "  </link>",
        f'  <joint name={attribute(name)} type="{kind}">',
        f"    <parent link={base}/>",
        f"    <child link={link}/>",
        f'    <axis xyz="{axis}"/>',
        f'    <dynamics damping="{nearest.slope!r}" friction="{nearest.constant!r}"/>',
        *limit,
        "  </joint>",
        "</robot>",
        "",
    ]
    return "\n".join(lines)


TARGET = Target(
    name="urdf", endings=(".urdf", ".xacro"), meaning="URDF dynamics", write=_write, edits=True
)
