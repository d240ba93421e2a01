"""The torque law of a joint as plain numbers: friction, torques over the position, inertia, sensor."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.joint import Joint
from jointid.joint.own_terms import CENTRED, POSITION

Array = NDArray[np.float64]
Over = Literal["gravity", "harmonics", "ripple"]
Function = Literal["torque", "inertia"]


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionTerm:
    """One friction term: a coefficient times the core's basis."""

    term: _core.Term
    value: float
    shapes: Mapping[str, float]  # in the core's order

    @property
    def vanishes(self) -> bool:
        """Whether the friction is zero at zero speed."""
        return self.term.at_rest == 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Harmonic:
    """A torque that is periodic in an angle: ``cos * cos(order * angle) + sin * sin(order * angle)``."""

    over: Over  # "ripple" is over the motor's angle; all others are over the joint's
    order: float
    cos: float
    sin: float

    @property
    def amplitude(self) -> float:
        """Largest torque [N·m or N]."""
        return math.hypot(self.cos, self.sin)


@dataclass(frozen=True, slots=True, kw_only=True)
class Centred:
    """A function of the joint's angle: ``cos * (cos(angle - centre) - 1) + sin * sin(angle - centre)``."""

    kind: Function  # with "inertia", the torque also has slope · v² / 2
    centre: float
    cos: float
    sin: float

    def value(self, position: Array) -> Array:
        """Return the function's values at positions."""
        angle = position - self.centre
        return np.asarray(self.cos * (np.cos(angle) - 1.0) + self.sin * np.sin(angle))

    def slope(self, position: Array) -> Array:
        """Return the derivative with respect to the position."""
        angle = position - self.centre
        return np.asarray(self.sin * np.cos(angle) - self.cos * np.sin(angle))

    @property
    def size(self) -> float:
        """Upper bound of the magnitude."""
        return abs(self.cos) + math.hypot(self.cos, self.sin)


@dataclass(frozen=True, slots=True, kw_only=True)
class Law:
    """The torque that a motion needs from the drive, on the joint side of the gear."""

    friction: tuple[FrictionTerm, ...]
    harmonics: tuple[Harmonic, ...]
    inertia: float | None  # before a torque sensor; without a sensor, total inertia; None: unknown
    link_inertia: float  # after the torque sensor; 0 without a sensor
    offset: float
    sensor: tuple[float, float] | None  # gain and offset: torque = gain · reading + offset
    gear_ratio: float
    centred: tuple[Centred, ...] = ()  # own terms that depend on the joint's own position

    @property
    def total_inertia(self) -> float | None:
        """Inertia of drive and link together."""
        return None if self.inertia is None else self.inertia + self.link_inertia

    @property
    def loaded_by(self) -> str:
        """The torque on which load friction depends, in words; "" without load friction."""
        loads = [each.term for each in self.friction if each.term.needs_load]
        if not loads:
            return ""
        return "behind the gear" if any(term.behind_gear for term in loads) else "of the drive"

    def over(self, kind: Over) -> tuple[Harmonic, ...]:
        """Return the harmonics of one kind."""
        return tuple(each for each in self.harmonics if each.over == kind)

    def friction_torque(
        self, velocity: ArrayLike, load: float = 0.0, *, width: float = 0.0
    ) -> Array:
        """Return the friction at each velocity [N·m or N]. Friction at rest fades below the speed `width`."""
        velocities = np.atleast_1d(np.asarray(velocity, dtype=np.float64))
        fade = np.tanh(np.abs(velocities) / width) if width > 0.0 else np.ones_like(velocities)
        total = np.zeros_like(velocities)
        for each in self.friction:
            shapes = np.array([*each.shapes.values()], dtype=np.float64)
            torque = each.value * _core.friction_basis(each.term.key, velocities, shapes, load)
            total += torque if each.vanishes else torque * fade
        return total

    def position_torque(self, position: ArrayLike, *kinds: Over) -> Array:
        """Return the torque over the position [N·m or N] of some kinds, or of all. Own torques are "harmonics"."""
        positions = np.atleast_1d(np.asarray(position, dtype=np.float64))
        total = np.zeros_like(positions)
        for each in self.harmonics:
            if not kinds or each.over in kinds:
                scale = self.gear_ratio if each.over == "ripple" else 1.0
                angle = each.order * (scale * positions)
                total += each.cos * np.cos(angle) + each.sin * np.sin(angle)
        for own in self.functions("torque"):
            if not kinds or "harmonics" in kinds:
                total += own.value(positions)
        return total

    def functions(self, kind: Function) -> tuple[Centred, ...]:
        """Return the own functions of the joint's angle of one kind."""
        return tuple(each for each in self.centred if each.kind == kind)

    def inertia_torque(self, position: float, velocity: float, acceleration: float) -> float:
        """Return the torque that accelerates drive and link [N·m or N]. An unknown inertia counts as 0."""
        at = np.atleast_1d(np.float64(position))
        own = self.functions("inertia")
        inertia = (self.total_inertia or 0.0) + sum(float(each.value(at)[0]) for each in own)
        slope = sum(float(each.slope(at)[0]) for each in own)
        return inertia * acceleration + 0.5 * slope * velocity**2


def law_of(joint: Joint, terms: Sequence[str], values: Mapping[str, float]) -> Law:
    """Return the law of a joint from the keys of the core's terms and the parameter values."""
    sensor = "sensor_gain" in terms
    model = joint.model.resolved
    harmonics = []
    for over, cos, sin, orders in (
        ("gravity", "gravity_cos", "gravity_sin", ()),
        ("harmonics", "position_cos_", "position_sin_", model.harmonics),
        ("ripple", "ripple_cos_", "ripple_sin_", model.ripple),
    ):
        for order in orders or ((1.0,) if over == "gravity" and cos in terms else ()):
            keys = [f"{name}{order:g}" if orders else name for name in (cos, sin)]
            harmonics.append(_harmonic(over, order, [values[key] for key in keys]))
    link = 0.0
    if sensor and joint.link is not None:
        # After the sensor, which measures its weight: part of the torque, but not a term of the balance.
        link = joint.link_inertia
        if joint.kind == "revolute" and not any(each.over == "gravity" for each in harmonics):
            known = joint.gravity_coefficients
            harmonics.insert(0, _harmonic("gravity", 1.0, [known.cos, known.sin]))
    return Law(
        friction=tuple(_friction(key, values) for key in terms if _core.term(key).friction),
        harmonics=tuple(harmonics),
        inertia=values.get("inertia"),
        link_inertia=link,
        offset=values.get("torque_offset", 0.0),
        sensor=(values["sensor_gain"], values["sensor_offset"]) if sensor else None,
        gear_ratio=joint.gear_ratio,
        centred=_centred(joint, values),
    )


def _centred(joint: Joint, values: Mapping[str, float]) -> tuple[Centred, ...]:
    found = []
    for own in joint.model.resolved.terms.each:
        if own.signal != POSITION or own.kind not in CENTRED:
            continue
        if own.centre is None:
            raise InputError(
                "an export needs the centre of this term",
                argument=f"terms.{POSITION}",
                value=str(own),
                place=joint.owner,
                remedy="identify the joint, or write the angle in brackets behind the kind",
            )
        cos, sin = (values[key] for key in own.keys)
        kind: Function = "torque" if own.kind == "torque_over" else "inertia"
        found.append(Centred(kind=kind, centre=own.centre, cos=cos, sin=sin))
    return tuple(found)


def _harmonic(over: str, order: float, parts: Sequence[float]) -> Harmonic:
    return Harmonic(over=over, order=order, cos=parts[0], sin=parts[1])  # type: ignore[arg-type]


def _friction(key: str, values: Mapping[str, float]) -> FrictionTerm:
    term = _core.term(key)
    shapes = {name: values[name] for name in term.shapes}
    return FrictionTerm(term=term, value=values[term.name], shapes=shapes)
