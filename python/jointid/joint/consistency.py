"""Consistency checks between the facts of a joint."""

from __future__ import annotations

import math

from jointid.base.errors import InputError
from jointid.joint.joint_fields import JointFields

# Largest relative difference of two values of one inertia, because printed values are rounded.
_INERTIA_TOLERANCE = 1e-3


def check_consistency(joint: JointFields, owner: str) -> None:
    """Refuse fields that contradict each other.

    Parameters
    ----------
    joint : JointFields
    owner : str
        The joint as messages name it.

    Raises
    ------
    InputError
    """
    _check_inertia(joint, owner)
    _check_gravity(joint, owner)
    _check_tolerances(joint, owner)


def _check_inertia(joint: JointFields, owner: str) -> None:
    if joint.rotor_inertia is None:
        return
    reflected = joint.gear_ratio * joint.gear_ratio * joint.rotor_inertia
    product = f"gear_ratio² · rotor_inertia is {reflected:.6g}"
    if not math.isfinite(reflected) or reflected == 0.0:
        raise InputError(
            f"{product} kg·m², but a finite value above 0 is needed",
            argument="rotor_inertia",
            value=joint.rotor_inertia,
            place=owner,
        )
    tolerance = _INERTIA_TOLERANCE * reflected
    if joint.inertia is not None and abs(joint.inertia - reflected) > tolerance:
        raise InputError(
            f"but {product}",
            argument="inertia",
            value=joint.inertia,
            place=owner,
            remedy="give only one of inertia and rotor_inertia",
        )


def _check_gravity(joint: JointFields, owner: str) -> None:
    gravity = joint.model.resolved.gravity
    if gravity != "none" and joint.kind == "prismatic":
        raise InputError(
            "gravity on a prismatic joint is the same at every position",
            argument="gravity",
            value=gravity,
            place=owner,
            remedy="set gravity to none, and torque_offset to true",
        )
    if gravity == "known" and joint.link is None:
        raise InputError(
            "there is no link",
            argument="gravity",
            value=gravity,
            place=owner,
            remedy="give the link's mass and centre_of_mass",
        )


def _check_tolerances(joint: JointFields, owner: str) -> None:
    facts = joint.facts
    for name, stated in joint.tolerances.given.items():
        if name in ("mass", "centre_of_mass", "link_inertia") and joint.link is None:
            raise InputError(
                "there is no link",
                argument=name,
                value=stated,
                place=f"{owner}: tolerances",
                remedy="give the link's mass and centre_of_mass",
            )
        if not isinstance(stated, str) and facts.get(name, stated) is None:
            raise InputError(
                "the joint does not state this fact",
                argument=name,
                value=stated,
                place=f"{owner}: tolerances",
                remedy='state the fact, or give the tolerance as a share such as "5 %"',
            )
