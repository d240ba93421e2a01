"""Inertia, gravity and friction from a joint's file, for limits that predict the motion."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from jointid import _core
from jointid.joint.joint import Joint

_BRAKES = 0.9
"""Usable share of the torque limit for braking, because a drive may round a command down."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MovingJoint:
    """Inertia, gravity and friction of a joint, as its file states them.

    Attributes
    ----------
    inertia : float
        Inertia that the drive's torque accelerates, including the link [kg·m²].
    weight, angle : float
        Largest torque of gravity on the link [N·m], and angle of the center of mass above the horizontal at
        position 0 [rad].
    dry : float or None
        Largest friction just above zero velocity [N·m]; None if not known.
    growing : tuple of (str, float)
        Keys and largest coefficients of terms without shape that are 0 at rest, such as viscous friction.
    """

    inertia: float
    weight: float = 0.0
    angle: float = 0.0
    dry: float | None = None
    growing: tuple[tuple[str, float], ...] = ()

    @classmethod
    def of(cls, joint: object) -> MovingJoint | None:
        """Return the values of a joint; None if there is none, or if its inertia is not known."""
        if not isinstance(joint, Joint):
            return None
        values = _values(joint)
        inertia = values.get("inertia", joint.reflected_inertia)
        if inertia is None or not inertia > 0.0:
            return None
        if joint.sensor or "inertia" not in values:
            inertia += joint.link_inertia
        link = joint.link if joint.kind == "revolute" else None
        weight = 0.0 if link is None else link.mass * link.gravity * link.centre_of_mass
        return cls(
            inertia=inertia,
            weight=weight,
            angle=0.0 if link is None else link.angle,
            dry=breakaway(joint),
            growing=tuple(
                (term.key, size)
                for term, size in _sizes(values)
                if not (term.at_rest or term.shapes)
            ),
        )

    def braking(self, torque: float) -> tuple[float, float] | None:
        """Return the torque for braking [N·m] and the smallest deceleration that it causes [rad/s²].

        None if the friction is not known, or if gravity may be stronger.

        Parameters
        ----------
        torque : float
            The session's limit [N·m].
        """
        if not math.isfinite(torque):
            return None
        used = _BRAKES * torque
        surely = (used - self.weight) / self.inertia
        return (used, surely) if surely > 0.0 else None

    def energy(self, position: float, velocity: float) -> float:
        """Return the kinetic energy plus the potential energy of the link's weight [J]."""
        height = self.weight * math.sin(position + self.angle)
        return 0.5 * self.inertia * velocity * velocity + height

    def needed(self, position: float, velocity: float, acceleration: float) -> float | None:
        """Return the largest magnitude of the torque that a motion needs [N·m]; None if the friction is not known."""
        if self.dry is None:
            return None
        gravity = abs(self.weight * math.cos(position + self.angle))
        speed = np.array([abs(velocity)])
        growing = (size * _core.friction_basis(key, speed, ())[0] for key, size in self.growing)
        friction = self.dry + float(sum(growing))
        return friction + self.inertia * abs(acceleration) + gravity


def breakaway(joint: object) -> float | None:
    """Return the largest friction in slow motion that a joint states [N·m]; None if its constant part is not known."""
    if not isinstance(joint, Joint):
        return None
    sizes = _sizes(_values(joint))
    if not any(term.settles for term, _ in sizes):
        return None
    return float(sum(max(float(term.at_rest), float(term.settles)) * size for term, size in sizes))


def _values(joint: Joint) -> dict[str, float]:
    """Return the parameters with a known value."""
    return {
        name: parameter.value
        for name, parameter in joint.parameters.items()
        if parameter.value is not None
    }


def _sizes(values: dict[str, float]) -> list[tuple[_core.Term, float]]:
    """Return the friction terms with a known value, the larger one of both directions; one term for each name."""
    rows = {
        t.name: t for t in reversed(_core.terms()) if t.friction and not (t.needs_load or t.side)
    }
    found = []
    for name, term in reversed(rows.items()):
        sides = (name, f"{name}_positive", f"{name}_negative")
        known = [abs(values[side]) for side in sides if side in values]
        if known:
            found.append((term, max(known)))
    return found
