"""A joint, its parameters' values and its payload, in the core's form for a simulation."""

import math
from collections.abc import Sequence
from typing import Any

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import not_negative, positive_number, set_numbers
from jointid.joint.joint import Joint
from jointid.joint.link import Link
from jointid.simulation.terms import require_compensated, require_simulated, require_used, terms_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Bristle:
    """Friction behind a spring: Dahl's model (thesis 2-4) or, with damping and static friction, LuGre's (2-6).

    While the joint slides, friction follows the joint's own model.

    Parameters
    ----------
    stiffness : float
        Stiffness sigma_0 [N·m/rad].
    damping : float
        Damping sigma_1 [N·m·s/rad]. Default 0.

    Examples
    --------
    >>> Bristle(stiffness=1e5).stiffness
    100000.0
    """

    stiffness: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        set_numbers(self, "Bristle", ("stiffness",), positive_number)
        set_numbers(self, "Bristle", ("damping",), not_negative)


class Values:
    """The values of a joint's parameters. `used` has the values that were read, by name."""

    def __init__(self, joint: Joint) -> None:
        self._joint = joint
        self.terms = terms_of(joint)
        self.used: dict[str, float] = {}

    def get(self, name: str) -> float | None:
        """Return a parameter's value, or None where there is none."""
        parameter = self._joint.parameters.get(name)
        value = None if parameter is None else parameter.value
        if value is not None:
            self.used[name] = value
        return value

    def need(self, name: str) -> float:
        """Return a parameter's value. Refuse a parameter without a value."""
        value = self.get(name)
        if value is None:
            raise InputError(
                "a simulation needs a value of this parameter",
                argument=f"parameters.{name}",
                remedy=f"give the joint a value of '{name}'",
            )
        return value

    def both(self, name: str) -> tuple[float, float]:
        """Return a friction coefficient for positive and negative velocity; 0 where the model has none."""
        sides = (name, name)
        if self._joint.model.resolved.asymmetric:
            sides = (f"{name}_positive", f"{name}_negative")
        if not {term.name for term in self.terms}.issuperset(sides):
            return 0.0, 0.0
        return self.need(sides[0]), self.need(sides[1])

    def friction(self) -> list[tuple[str, float, float, Sequence[float]]]:
        """Return the friction that depends only on the speed: basis, coefficients of both directions, shapes."""
        found: dict[tuple[str, tuple[float, ...]], list[float]] = {}
        for term in self.terms:
            if not term.friction or term.needs_load:
                continue
            shapes = tuple(self._size(name) for name in term.shapes)
            sides = found.setdefault((term.basis, shapes), [0.0, 0.0])
            value = self._size(term.name)
            if term.side >= 0:
                sides[0] += value
            if term.side <= 0:
                sides[1] += value
        return [(basis, one, other, shapes) for (basis, shapes), (one, other) in found.items()]

    def _size(self, name: str) -> float:
        value = self.need(name)
        if value < 0.0:
            raise InputError("must be at least 0", argument=f"joint.{name}", value=value)
        return value


def simulated_joint(
    joint: Joint, values: Values, payload: Link | float, bristle: Bristle | None
) -> _core.SimulatedJoint:
    """Return the core's joint. Refuse a model that cannot be simulated, and a joint that lacks a value."""
    require_simulated(joint, values.terms)
    revolute = joint.kind == "revolute"
    inertia, link_inertia = _inertias(joint, values)
    weights = []
    if (
        joint.link is not None
        and revolute
        and joint.sensor
        and joint.model.resolved.gravity == "none"
    ):
        weights.append(_weight(joint.link))
    load = 0.0
    if isinstance(payload, Link):
        link_inertia += Joint(kind=joint.kind, link=payload).link_inertia
        if revolute:
            weights.append(_weight(payload))
    else:
        load = payload
    harmonics = [
        (order, values.need(f"position_cos_{order:g}"), values.need(f"position_sin_{order:g}"))
        for order in joint.model.resolved.harmonics
    ]
    turned = math.copysign(1.0, joint.gear_ratio)
    harmonics += [
        (
            order * abs(joint.gear_ratio),
            values.need(f"ripple_cos_{order:g}"),
            turned * values.need(f"ripple_sin_{order:g}"),
        )
        for order in joint.model.resolved.ripple
    ]
    if joint.model.resolved.gravity == "known":
        known = joint.gravity_coefficients
        harmonics.append((1.0, known.cos, known.sin))
    elif joint.model.resolved.gravity == "free":
        harmonics.append((1.0, values.need("gravity_cos"), values.need("gravity_sin")))
    limit = torque_limit(joint)
    plant = _core.SimulatedJoint(
        inertia=inertia,
        link_inertia=link_inertia,
        load=load,
        torque_offset=values.get("torque_offset") or 0.0,
        torque_limit=1e300 if limit is None else limit,
        friction=values.friction(),
        load_friction=values.need("load_friction") if joint.model.resolved.load_friction else 0.0,
        bristles=bristle is not None,
        bristle_stiffness=0.0 if bristle is None else bristle.stiffness,
        bristle_damping=0.0 if bristle is None else bristle.damping,
        weights=weights,
        harmonics=harmonics,
    )
    # The caller reads the sensor's gain and offset. Known gravity is part of the link's data.
    require_used(
        [term for term in values.terms if term.option not in ("sensor", "gravity")], values.used
    )
    return plant


def torque_limit(joint: Joint) -> float | None:
    """Return the torque limit, or the torque at the current limit if that is smaller [N·m]."""
    limits = joint.limits
    known = [] if limits.torque is None else [limits.torque]
    if limits.current is not None and joint.torque_constant is not None:
        known.append(limits.current * joint.torque_constant * abs(joint.gear_ratio))
    return min(known, default=None)


def control_estimates(joint: Joint) -> dict[str, Any]:
    """Return the parameters that a model-based controller assumes, from a joint's values.

    Use the result as ``jid.AdaptiveRobust(**jid.control_estimates(joint))``. If friction differs between the
    directions, its mean is used. Gravity, a constant offset, ripple and harmonics are not compensated. The
    controller's feedback corrects their effect.

    Parameters
    ----------
    joint : Joint
        Joint with values for its parameters, e.g. the joint of an estimate.

    Returns
    -------
    dict of str to float
        Values of `inertia`, `coulomb`, `viscous`, `static` and `stribeck`, 0 for terms that the model does not have.
        `sensor_gain` and `sensor_offset` are 0 without a sensor; the inertia then includes the inertia of the link.

    Raises
    ------
    InputError
        A value is missing, or the model has friction that no controller compensates: the exponent of
        "stribeck_general", or load friction.

    Examples
    --------
    >>> jid.control_estimates(known)["coulomb"]
    25.0
    """
    require_kind("joint", joint, Joint)
    values = Values(joint)
    require_compensated(joint, values.terms)
    drive, link = _inertias(joint, values)
    estimates: dict[str, Any] = {"inertia": drive if joint.sensor else drive + link}
    for name in ("coulomb", "static", "viscous"):
        estimates[name] = sum(values.both(name)) / 2.0
    # 0 is written explicitly: a controller must not keep an earlier value.
    fades = any("stribeck" in term.shapes for term in values.terms)
    estimates["stribeck"] = values.need("stribeck") if fades else 0.0
    for name in ("sensor_gain", "sensor_offset"):
        estimates[name] = values.need(name) if joint.sensor else 0.0
    require_used(
        [term for term in values.terms if term.control == _core.Control.compensated], values.used
    )
    return estimates


def _inertias(joint: Joint, values: Values) -> tuple[float, float]:
    """Return the inertia of the drive, and of the link behind the sensor."""
    link = joint.link_inertia
    identified = values.get("inertia")
    if identified is not None:
        # Without a sensor the identified inertia includes the link's.
        return identified, link if joint.sensor else 0.0
    drive = joint.reflected_inertia
    if drive is None:
        raise InputError(
            "a simulation needs a value of this parameter",
            argument="inertia",
            remedy="give the joint inertia or rotor_inertia, or a value of the parameter 'inertia'",
        )
    values.used["inertia"] = drive if joint.sensor else drive + link
    return drive, link


def _weight(link: Link) -> tuple[float, float]:
    return link.mass * link.gravity * link.centre_of_mass, link.angle
