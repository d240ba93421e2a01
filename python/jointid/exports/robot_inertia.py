"""Write a whole robot's inertia into its URDF: mass, centre and inertia of every moved link."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.exports.urdf_model import is_joint
from jointid.exports.xml_patch import Element, comment, elements, tag_end
from jointid.robot.links.inertia_modes import FREE, URDF
from jointid.robot.result.result import RobotEstimate

Array = NDArray[np.float64]

_STILL = "fixed"
_TURNING = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def with_link_inertias(estimate: RobotEstimate, content: bytes, place: str) -> bytes:
    """Return a URDF with the inertial parameters of an estimate. Everything else keeps its bytes.

    The link that a joint moves gets the inertia of all bodies fixed to it. Those bodies lose their own inertia.
    """
    _check(estimate)
    found = elements(content, place)
    edits: list[tuple[int, int, bytes]] = []
    for number, owned in enumerate(_bodies(estimate, found, place)):
        for first, link in zip((True, *(False,) * (len(owned) - 1)), owned, strict=True):
            text = _inertial(estimate, number, content, link) if first else b""
            edits.append(_edit(found, content, link, text))
    for start, stop, text in sorted(edits, reverse=True):
        content = content[:start] + text + content[stop:]
    return content


def _check(estimate: RobotEstimate) -> None:
    again = Action("call", {"inertia": FREE}, function="identify_robot")
    if estimate.inertia == URDF:
        raise InputError(
            "the links' inertia was not identified: the values are those of the URDF",
            argument="inertia",
            value=True,
            remedy=again,
        )
    if not estimate.consistent:
        raise InputError(
            "the identified inertia is impossible for rigid bodies, so a simulator would refuse it",
            argument="inertia",
            value=True,
            remedy=() if estimate.inertia == FREE else again,
        )


def _bodies(estimate: RobotEstimate, found: Sequence[Element], place: str) -> list[list[Element]]:
    """Return the links of each body: the link that its joint moves, and the links fixed to it."""
    links = {
        each.attributes.get("name", ""): each
        for each in found
        if each.tag == "link" and each.parent == 0
    }
    joints = {each.attributes["name"]: each for each in found if is_joint(each)}
    names = estimate.robot.names
    others = [
        name
        for name, each in joints.items()
        if each.attributes["type"] != _STILL and name not in names
    ]
    missing = [name for name in names if name not in joints]
    if others or missing:
        what = "other joints that move" if others else "no such joints"
        which = ", ".join(others or missing)
        raise InputError(
            f"the inertia of a body needs all joints to be identified; the URDF has {what}: {which}",
            argument="inertia",
            value=True,
            place=place,
        )
    ends = {name: _ends(each, found, place) for name, each in joints.items()}
    fixed = [ends[name] for name, each in joints.items() if each.attributes["type"] == _STILL]
    bodies = []
    for name in names:
        body = [ends[name][1]]
        for link in body:  # the list grows in the loop
            body += [child for parent, child in fixed if parent == link and child not in body]
        bodies.append(body)
    for link in (each for body in bodies for each in body):
        if link not in links:
            raise InputError("there is no such link", argument="into", value=link, place=place)
    return [[links[link] for link in body] for body in bodies]


def _ends(joint: Element, found: Sequence[Element], place: str) -> tuple[str, str]:
    """Return the names of a joint's parent and child link."""
    number = found.index(joint)
    named = {each.tag: each.attributes.get("link", "") for each in found if each.parent == number}
    if not {"parent", "child"} <= named.keys():
        name = joint.attributes["name"]
        raise InputError(
            "this joint has no parent and child", argument="into", value=name, place=place
        )
    return named["parent"], named["child"]


def _edit(
    found: Sequence[Element], content: bytes, link: Element, text: bytes
) -> tuple[int, int, bytes]:
    """Return the place of a link's inertia in the file, and the new content."""
    number = found.index(link)
    for each in found:
        if each.parent == number and each.tag == "inertial":
            closed = content[each.inner - 2 : each.inner] == b"/>"
            return each.start, each.inner if closed else tag_end(content, each.stop), text
    if content[link.inner - 2 : link.inner] == b"/>":
        if not text:
            return link.inner, link.inner, b""
        return link.inner - 2, link.inner, b">" + text + b"</link>"
    return link.inner, link.inner, text


def _inertial(estimate: RobotEstimate, number: int, content: bytes, link: Element) -> bytes:
    """Return the element, indented like the link."""
    m, x, y, z, xx, xy, yy, xz, yz, zz = (float(each) for each in estimate.inertial[number])
    if m <= 0.0:
        return b""
    centre = np.array([x, y, z]) / m
    turning = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    about = turning - m * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    line = content[: link.start].rpartition(b"\n")[2]
    indent = (line[: len(line) - len(line.lstrip())]).decode() + "  "
    values = zip(_TURNING, about[np.triu_indices(3)].tolist(), strict=True)
    turning_values = [f'{name}="{value!r}"' for name, value in values]
    lines = [
        "<inertial>",
        f"  {comment(list(_words(estimate, number)), f'{indent}  ')}",
        f'  <origin xyz="{" ".join(repr(each) for each in centre.tolist())}" rpy="0 0 0"/>',
        f'  <mass value="{m!r}"/>',
        f"  <inertia {' '.join(turning_values)}/>",
        "</inertial>",
    ]
    return f"\n{indent}".join(lines).encode()


def _words(estimate: RobotEstimate, number: int) -> Iterator[str]:
    name = estimate.robot.names[number]
    joint = estimate.joints[name]
    if estimate.inertia == FREE:
        yield (
            f"inertia of all bodies between {name} and the next joint; other inertias give the same "
            "motion,"
        )
        yield "so use only the complete set, not single numbers"
    else:
        yield f"inertia of all bodies between {name} and the next joint: scaled from the URDF"
    rotor = joint.parameters.get("rotor_inertia")
    if rotor is not None:
        yield f"without the motor's inertia, which URDF cannot hold: {rotor.value!r} {rotor.unit} at the joint"
    elif estimate.robot.rotor_inertias[number] is None:
        yield "with the motor's inertia about the joint's axis, which no motion separates from the link's"
