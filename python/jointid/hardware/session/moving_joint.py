"""What a joint's file says about its motion: inertia, gravity, friction; for limits that look ahead."""

from __future__ import annotations

import math
from dataclasses import dataclass

from jointid.joint.joint import Joint

_BRAKES = 0.9
"""Share of the torque limit that braking may count on: a drive rounds a command down."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MovingJoint:
    """Inertia, gravity and friction of a joint, as its file states them.

    Attributes
    ----------
    inertia : float
        That the drive's torque accelerates, with the link's [kg·m²].
    weight, angle : float
        Largest torque of gravity on the link [N·m], and the centre of mass's angle above the horizontal
        at position 0 [rad].
    dry, viscous : float or None
        Largest dry friction [N·m] and viscous friction [N·m·s/rad]; None: not known.
    """

    inertia: float
    weight: float = 0.0
    angle: float = 0.0
    dry: float | None = None
    viscous: float | None = None

    @classmethod
    def of(cls, joint: object) -> MovingJoint | None:
        """Return what a joint states; None when there is none, or its inertia is not known."""
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
            viscous=_largest(values, "viscous"),
        )

    def braking(self, torque: float) -> tuple[float, float] | None:
        """Return the torque for braking [N·m] and the deceleration that it surely gives [rad/s²].

        None: it cannot be told, or gravity may be stronger.

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
        """Kinetic energy, and potential energy of the link's weight [J]."""
        height = self.weight * math.sin(position + self.angle)
        return 0.5 * self.inertia * velocity * velocity + height

    def needed(self, position: float, velocity: float, acceleration: float) -> float | None:
        """Magnitude of the torque that a motion needs at most [N·m]; None where friction is not known."""
        if self.dry is None:
            return None
        gravity = abs(self.weight * math.cos(position + self.angle))
        friction = self.dry + (self.viscous or 0.0) * abs(velocity)
        return friction + self.inertia * abs(acceleration) + gravity


def breakaway(joint: object) -> float | None:
    """Return the largest dry friction that a joint states [N·m], of Coulomb and static; None: it is not known."""
    if not isinstance(joint, Joint):
        return None
    values = _values(joint)
    coulomb = _largest(values, "coulomb")
    return None if coulomb is None else coulomb + (_largest(values, "static") or 0.0)


def _values(joint: Joint) -> dict[str, float]:
    """Those parameters whose value is known."""
    return {
        name: parameter.value
        for name, parameter in joint.parameters.items()
        if parameter.value is not None
    }


def _largest(values: dict[str, float], name: str) -> float | None:
    """Of a friction coefficient, in either direction."""
    found = [
        abs(value)
        for known, value in values.items()
        if known in (name, f"{name}_positive", f"{name}_negative")
    ]
    return max(found, default=None)
