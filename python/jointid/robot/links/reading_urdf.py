"""A link tree from a URDF, read by pinocchio (the extra `robot`)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np

from jointid.base.errors import InputError
from jointid.robot.links.link_tree import LinkTree

_MOST = {
    "links": 1000,
    "joints": 1000,
    "attributes of an element": 100,
    "elements inside each other": 50,
}


def tree_of_urdf(path: Path, joints: Sequence[str] | None, gravity: Sequence[float]) -> LinkTree:
    """Return the links that some joints of a URDF move, by default all; its other joints stay at zero."""
    try:
        import pinocchio
    except ModuleNotFoundError:
        raise InputError(
            "reading a robot needs pinocchio",
            argument="path",
            value=path.name,
            remedy="pip install pin",
        ) from None
    if joints is not None and (isinstance(joints, str) or not isinstance(joints, Sequence)):
        raise InputError("a list of names is expected", argument="joints", value=joints)
    text = _xml(path)
    try:
        model: Any = pinocchio.buildModelFromXML(text)
    except (ValueError, RuntimeError) as error:
        raise InputError(f"no URDF: {error}", argument="path", value=path.name) from None
    names = list(model.names)[1:]
    kept = names if joints is None else list(joints)
    for name in kept:
        if kept.count(name) > 1:
            raise InputError("each joint may be named only once", argument="joints", value=name)
        if name not in names:
            shown = ", ".join(names)
            raise InputError(
                f"the URDF has no such moving joint; it has {shown}", argument="joints", value=name
            )
    if not kept:
        raise InputError("the URDF has no moving joint", argument="path", value=path.name)
    expected = [name for name in names if name in kept]
    if (
        kept != expected
    ):  # the values of other lists would belong to other joints than the author intends
        raise InputError(
            "the joints are expected in the order of the URDF: " + ", ".join(expected),
            argument="joints",
            value=list(kept),
            remedy="use this order in gear_ratios and all other lists",
        )
    locked = [model.getJointId(name) for name in names if name not in kept]
    if locked:
        model = pinocchio.buildReducedModel(model, locked, pinocchio.neutral(model))
    order = list(model.names)[1:]
    axes = [_axis(model, name) for name in order]
    return LinkTree(
        names=tuple(order),
        parents=tuple(int(parent) - 1 for parent in list(model.parents)[1:]),
        rotations=np.array([place.rotation for place in list(model.jointPlacements)[1:]]),
        translations=np.array([place.translation for place in list(model.jointPlacements)[1:]]),
        axes=np.array([axis for axis, _ in axes]),
        prismatic=tuple(slides for _, slides in axes),
        inertias=np.array([each.toDynamicParameters() for each in list(model.inertias)[1:]]),
        gravity=np.array(gravity, dtype=np.float64),
        locked=tuple(name for name in names if name not in kept),
        spans=tuple(_span(model, name) for name in order),
    )


def _span(model: Any, name: str) -> float:
    """Return the range of a joint by the URDF's limits; infinity if it has none."""
    joint = model.joints[model.getJointId(name)]
    if joint.nq != 1:
        return float("inf")
    low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
    return float(high - low) if high > low else float("inf")


def _axis(model: Any, name: str) -> tuple[np.ndarray[Any, np.dtype[np.float64]], bool]:
    """Return a joint's axis, and whether it slides along it."""
    joint = model.joints[model.getJointId(name)]
    if joint.nv != 1:
        raise InputError(
            "this joint has several degrees of freedom; only revolute and prismatic joints are read",
            argument="joints",
            value=name,
            remedy="leave this joint out of joints",
        )
    state = joint.createData()
    neutral = np.array([1.0, 0.0]) if joint.nq == 2 else np.zeros(1)
    joint.calc(state, neutral, np.zeros(1))
    motion = np.asarray(state.S, dtype=np.float64).ravel()
    slides = bool(np.any(motion[:3] != 0.0))
    return (motion[:3] if slides else motion[3:]), slides


def _xml(path: Path) -> str:
    """Return the text of a URDF. Invalid XML is refused here, because pinocchio would print its own complaint."""
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        raise InputError("there is no such file", place=str(path)) from None
    except OSError as error:
        reason = f"it cannot be read: {error.strerror}"
        raise InputError(reason, place=str(path)) from None
    seen = _Elements(path.name)
    parser = expat.ParserCreate()
    parser.StartElementHandler = seen.start
    parser.EndElementHandler = seen.end
    try:
        text = content.decode("utf-8")
        parser.Parse(content, True)
    except UnicodeDecodeError:
        raise InputError(
            "no URDF: text in UTF-8 is expected", argument="path", value=path.name
        ) from None
    except expat.ExpatError as error:
        reason = f"no URDF: {expat.ErrorString(error.code)}, line {error.lineno}"
        raise InputError(reason, argument="path", value=path.name) from None
    if seen.first != "robot":
        raise InputError(
            f"this is not a URDF: it begins with <{seen.first}>, not with <robot>",
            argument="path",
            value=path.name,
        )
    return text


class _Elements:
    """Limits on a URDF's size: pinocchio follows chains by recursion, and its cost grows with the cube of the links."""

    def __init__(self, name: str) -> None:
        self._name = name
        self.first = ""
        self._depth = 0
        self._counts = dict.fromkeys(("link", "joint"), 0)

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self.first = self.first or tag
        self._depth += 1
        self._refuse(len(attributes), "attributes of an element")
        self._refuse(self._depth, "elements inside each other")
        if tag in self._counts:
            self._counts[tag] += 1
            self._refuse(self._counts[tag], f"{tag}s")

    def end(self, _: str) -> None:
        self._depth -= 1

    def _refuse(self, count: int, what: str) -> None:
        most = _MOST[what]
        if count > most:
            raise InputError(
                f"a URDF with at most {most} {what} is expected", argument="path", value=self._name
            )
