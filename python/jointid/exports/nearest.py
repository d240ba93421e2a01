"""The nearest Coulomb and viscous friction, and the parts of a joint's torque law that it loses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.exports.law import Law
from jointid.exports.subject import Subject

_SPEEDS = 400


@dataclass(frozen=True, slots=True, kw_only=True)
class Nearest:
    """Coulomb and viscous friction, the same in both directions."""

    constant: float  # friction at every speed [N·m or N]
    slope: float  # friction per speed
    lost: tuple[str, ...] = ()  # lost parts of the law; empty if the friction is exact
    speed: float | None = None  # the fit's largest speed; None without a fit
    # Largest difference of the friction without load, and of the torques over the position.
    worst: float = 0.0
    rms: float = 0.0  # root mean square of the difference over equally weighted speeds


def lost_terms(subject: Subject) -> tuple[str, ...]:
    """Return descriptions of the parts of a law that Coulomb and viscous friction cannot represent."""
    law, unit = subject.law, subject.torque_unit
    lost = []
    excess = [each for each in law.friction if each.shapes and not each.vanishes]
    if excess:
        sizes = " and ".join(f"{each.value:.4g}" for each in excess)
        lost.append(f"Stribeck friction ({sizes} {unit} above Coulomb at rest)")
    revolute = subject.joint.kind == "revolute"
    lost += [
        f"{'the smooth rise of ' * each.term.settles}{each.term.meaning} "
        f"({each.value:.4g} {each.term.unit if revolute else each.term.unit_prismatic})"
        for each in law.friction
        if each.term.basis not in ("constant", "linear", "load") and each not in excess
    ]
    if any(each.term.side for each in law.friction):
        lost.append("the difference between the two directions")
    lost += [
        f"load friction ({each.value:.4g} {unit} per {unit} of load)"
        for each in law.friction
        if each.term.needs_load and each.value != 0.0
    ]
    for over, angle in (("ripple", "motor"), ("harmonics", "joint")):
        found = [each for each in law.harmonics if each.over == over]
        if found:
            size = sum(each.amplitude for each in found)
            name = "ripple" if over == "ripple" else "torque"
            lost.append(f"{name} over the {angle}'s angle (up to {size:.4g} {unit})")
    return tuple(lost)


def _own_lost(subject: Subject) -> tuple[str, ...]:
    """Return descriptions of the own terms that a body with Coulomb and viscous friction cannot represent."""
    unit = subject.torque_unit
    lost = [
        f"torque over the joint's angle (up to {each.size:.4g} {unit})"
        if each.kind == "torque"
        else f"inertia over the joint's angle (up to {each.size:.4g} kg·m²)"
        for each in subject.law.centred
    ]
    return (*lost, *([subject.others] if subject.others else []))


def nearest_friction(subject: Subject, *, approximate: bool, target: str) -> Nearest:
    """Return Coulomb and viscous friction: the law's own or, with `approximate`, the nearest fit."""
    law, own = subject.law, _own_lost(subject)
    friction = lost_terms(subject)
    lost = (*friction, *own)
    for each in law.friction:
        if each.value < 0.0:  # a simulator refuses it, or gains energy
            raise InputError(
                f"{target} has no negative friction",
                argument=f"parameters.{each.term.name}",
                value=each.value,
            )
    if lost and not approximate:
        needed = {"approximate": True} | (
            {"speed": ...} if friction and subject.speed is None else {}
        )
        raise InputError(
            f"{target} has only Coulomb and viscous friction; the export would lose {' and '.join(lost)}",
            argument="model",
            value=subject.model,
            remedy=Action("call", needed, "the nearest Coulomb and viscous friction", "export"),
        )
    if not friction:  # it is Coulomb and viscous friction
        return Nearest(
            constant=sum(each.value for each in law.friction if each.term.basis == "constant"),
            slope=sum(each.value for each in law.friction if each.term.basis == "linear"),
            lost=own,
        )
    if subject.speed is None:
        raise InputError(
            "the nearest friction needs a range of speeds, but a joint file has no such range",
            argument="speed",
            remedy=Action("call", {"speed": ...}, "the largest speed", "export"),
        )
    return _fitted(law, lost, subject.speed)


def _fitted(law: Law, lost: tuple[str, ...], peak: float) -> Nearest:
    """Return the least-squares fit over equally weighted speeds in both directions, without negative values."""
    half = (np.arange(_SPEEDS) + 0.5) / _SPEEDS * peak
    speed = np.concatenate([half, half])
    torque = np.concatenate([law.friction_torque(half), -law.friction_torque(-half)])
    columns = np.column_stack([np.ones_like(speed), speed])
    candidates = [np.linalg.lstsq(columns, torque, rcond=None)[0]]
    for kept in (0, 1):
        part = columns[:, kept] @ torque / (columns[:, kept] @ columns[:, kept])
        candidates.append(np.where(np.arange(2) == kept, part, 0.0))
    allowed = [each for each in candidates if np.all(each >= 0.0)] or [np.zeros(2)]
    constant, slope = min(allowed, key=lambda each: float(np.sum((torque - columns @ each) ** 2)))
    edge = np.array([1e-9, 1.0]) * peak  # lowest and highest speed
    tried = np.concatenate([half, edge])
    worst = max(
        float(np.max(np.abs(sign * law.friction_torque(sign * tried) - constant - slope * tried)))
        for sign in (1.0, -1.0)
    )
    periodic = sum(each.amplitude for each in law.harmonics if each.over != "gravity")
    periodic += sum(each.size for each in law.functions("torque"))
    return Nearest(
        constant=float(constant),
        slope=float(slope),
        lost=lost,
        speed=peak,
        worst=worst + periodic,
        rms=float(np.sqrt(np.mean((torque - columns @ [constant, slope]) ** 2))),
    )
