"""The body that a joint moves, for rigid-body simulators: mass, centre of mass, inertia, and the drive's part."""

from __future__ import annotations

import math
from dataclasses import dataclass

from jointid.base.errors import InputError
from jointid.exports.law import Law
from jointid.exports.subject import Subject
from jointid.joint.joint import Joint
from jointid.joint.link import STANDARD_GRAVITY

# Smallest inertia of a body, as a share, if the joint has none. It is too small to affect results.
_NOTHING = 1e-9
# Smallest share of a sliding joint's mass that belongs to its body.
_SHARE = 0.02


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """The moved body, which gives the law's inertia and gravity about the joint's axis."""

    mass: float  # [kg]
    distance: float  # distance of the centre of mass from the axis [m]
    angle: float  # angle of the centre of mass above the horizontal, at position 0 [rad]
    inertia: float  # about the centre of mass [kg·m²]
    gravity: float  # [m/s²]; 0 if the model has no gravity
    drive: float  # inertia of the drive on the joint side [kg·m²], or [kg]
    note: str = ""  # chosen values that are not identified


def drive_inertia(subject: Subject) -> float | None:
    """Return the inertia of the drive alone, on the joint side; None if it cannot be separated from the link's."""
    joint, law = subject.joint, subject.law
    if joint.sensor and law.inertia is not None:
        return law.inertia
    if joint.reflected_inertia is not None:
        return joint.reflected_inertia
    if joint.link is None or law.inertia is None:
        return None
    return _left(joint, law.inertia)


def body_of(subject: Subject) -> Body:
    """Return a body that, with the drive, has the inertia and the gravity of the joint."""
    joint, law = subject.joint, subject.law
    total = law.total_inertia
    if total is None or total <= 0.0:
        raise InputError(
            "a model for simulation needs this value",
            argument="inertia",
            place=joint.owner,
            remedy="give the joint inertia or rotor_inertia, or identify the joint",
        )
    least = _NOTHING * total
    weight = sum(each.amplitude for each in law.over("gravity"))
    if joint.model.resolved.gravity == "free" and weight > 0.0:
        return _equivalent(law, joint, total, weight)
    slides = joint.kind == "prismatic"
    if joint.link is None:
        # A sliding joint's dry friction depends on the body's mass, so the body has all of it.
        mass, drive = (total, 0.0) if slides else (least, total)
        return Body(mass=mass, distance=0.0, angle=0.0, inertia=least, gravity=0.0, drive=drive)
    sensed = law.inertia if joint.sensor else None
    drive = _left(joint, total) if sensed is None else sensed
    link = joint.link
    if slides:
        mass = max(link.mass, _SHARE * total)
        return Body(
            mass=mass, distance=0.0, angle=0.0, inertia=least, gravity=0.0, drive=total - mass
        )
    inner = joint.link_inertia - link.mass * link.centre_of_mass**2
    if inner < -1e-9 * joint.link_inertia:
        raise InputError(
            "the link's inertia cannot be below mass · centre_of_mass²",
            argument="inertia",
            value=joint.link_inertia,
            place=f"{joint.owner}: link",
        )
    return Body(
        mass=max(link.mass, least),
        distance=link.centre_of_mass,
        angle=link.angle,
        inertia=max(inner, least),
        gravity=link.gravity if weight > 0.0 else 0.0,
        drive=drive,
    )


def _left(joint: Joint, total: float) -> float:
    """Return the drive's part of an inertia that includes the link's."""
    drive = total - joint.link_inertia
    if drive < 0.0:
        raise InputError(
            f"this inertia includes the link, so it must be at least the link's inertia, {joint.link_inertia:.6g}",
            argument="parameters.inertia",
            value=total,
            place=joint.owner,
            remedy="check the link's mass, centre_of_mass and inertia",
        )
    return drive


def _equivalent(law: Law, joint: Joint, total: float, weight: float) -> Body:
    """Return a point mass with the identified torque of gravity. Only mass · distance is known."""
    (gravity,) = law.over("gravity")
    field = STANDARD_GRAVITY if joint.link is None else joint.link.gravity
    field = field or STANDARD_GRAVITY
    drive = joint.reflected_inertia
    if drive is None or not total - drive > 0.0:
        drive = total / 2.0
    distance = (total - drive) * field / weight
    return Body(
        mass=weight / (field * distance),
        distance=distance,
        angle=math.atan2(-gravity.sin, gravity.cos),
        inertia=_NOTHING * total,
        gravity=field,
        drive=drive,
        note="mass and distance of the body are chosen. The recording determines only mass × distance (from gravity), "
        "and the inertia of drive and body together",
    )
