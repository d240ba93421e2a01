"""A joint, its parameters' values and its payload, as the core simulates them."""

import math
from dataclasses import dataclass
from typing import Any

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.joint.checks import not_negative, positive_number, set_numbers
from jointid.joint.joint import Joint
from jointid.joint.link import Link

_DECAY = {"coulomb_viscous": "none", "stribeck": "gaussian", "stribeck_general": "general"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Bristle:
    """Friction behind a spring: Dahl's model (2-4), or with damping and static friction LuGre (2-6).

    The friction that is reached when the joint slides is that of the joint's own model.

    Parameters
    ----------
    stiffness : float
        sigma_0 [N·m/rad].
    damping : float
        sigma_1 [N·m·s/rad]. Default 0.
    """

    stiffness: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        set_numbers(self, "Bristle", ("stiffness",), positive_number)
        set_numbers(self, "Bristle", ("damping",), not_negative)


class Values:
    """The values of a joint's parameters, and which of them were asked for."""

    def __init__(self, joint: Joint) -> None:
        self._joint = joint
        self.used: dict[str, float] = {}

    def get(self, name: str) -> float | None:
        """Return a parameter's value, or None where there is none."""
        parameter = self._joint.parameters.get(name)
        value = None if parameter is None else parameter.value
        if value is not None:
            self.used[name] = value
        return value

    def need(self, name: str) -> float:
        """Return a parameter's value; one sentence where there is none."""
        value = self.get(name)
        if value is None:
            raise InputError(
                f"the joint's parameter '{name}' has no value, which a simulation needs; give it with "
                f"joint.with_parameters({{'{name}': ...}})"
            )
        return value

    def both(self, name: str) -> tuple[float, float]:
        """Return a friction coefficient for positive and negative velocity."""
        if self._joint.model.resolved.asymmetric:
            return self.need(f"{name}_positive"), self.need(f"{name}_negative")
        value = self.need(name)
        return value, value


def simulated_joint(
    joint: Joint, values: Values, payload: Link | float, bristle: Bristle | None
) -> _core.SimulatedJoint:
    """Return the core's joint.

    Raises
    ------
    InputError
        A value that the simulation needs is missing or cannot be.
    """
    decay = _DECAY[joint.model.resolved.name]
    coulomb, viscous = values.both("coulomb"), values.both("viscous")
    static = (0.0, 0.0) if decay == "none" else values.both("static")
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
        link_inertia += _inertia(payload, revolute)
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
    return _core.SimulatedJoint(
        inertia=inertia,
        link_inertia=link_inertia,
        load=load,
        torque_offset=values.get("torque_offset") or 0.0,
        torque_limit=1e300 if limit is None else limit,
        decay=decay,
        coulomb_positive=coulomb[0],
        coulomb_negative=coulomb[1],
        static_positive=static[0],
        static_negative=static[1],
        viscous_positive=viscous[0],
        viscous_negative=viscous[1],
        stribeck=values.need("stribeck") if decay == "gaussian" else 0.0,
        stribeck_velocity=values.need("stribeck_velocity") if decay == "general" else 1.0,
        stribeck_exponent=values.need("stribeck_exponent") if decay == "general" else 1.0,
        load_friction=values.need("load_friction") if joint.model.resolved.load_friction else 0.0,
        bristles=bristle is not None,
        bristle_stiffness=0.0 if bristle is None else bristle.stiffness,
        bristle_damping=0.0 if bristle is None else bristle.damping,
        weights=weights,
        harmonics=harmonics,
    )


def torque_limit(joint: Joint) -> float | None:
    """Return the smaller of the torque limit and what the current limit gives [N·m]."""
    limits = joint.limits
    known = [] if limits.torque is None else [limits.torque]
    if limits.current is not None and joint.torque_constant is not None:
        known.append(limits.current * joint.torque_constant * abs(joint.gear_ratio))
    return min(known, default=None)


def control_estimates(joint: Joint) -> dict[str, Any]:
    """Return what a model-based controller believes of a joint, from its parameters' values.

    Use it as ``jid.AdaptiveRobust(**jid.control_estimates(joint))``. Friction that differs between
    the directions is averaged.

    Parameters
    ----------
    joint : Joint
        With values for its parameters, e.g. an estimate's.

    Returns
    -------
    dict of str to float
        `inertia`, `coulomb`, `viscous`, `static` and `stribeck` (0 where the model has none),
        `sensor_gain` and `sensor_offset` (0 without a sensor: the inertia then holds the link's).

    Raises
    ------
    InputError
        A value is missing, or the friction model is one that no controller has.
    """
    require_kind("joint", joint, Joint)
    if joint.model.resolved.name == "stribeck_general":
        raise InputError(
            "controllers compensate the friction models 'coulomb_viscous' and 'stribeck', not "
            "'stribeck_general'; identify with model='stribeck' for the controller"
        )
    values = Values(joint)
    drive, link = _inertias(joint, values)
    estimates: dict[str, Any] = {"inertia": drive if joint.sensor else drive + link}
    stribeck = joint.model.resolved.name == "stribeck"
    for name in ("coulomb", "static", "viscous") if stribeck else ("coulomb", "viscous"):
        estimates[name] = sum(values.both(name)) / 2.0
    if stribeck:
        estimates["stribeck"] = values.need("stribeck")
    else:  # said, lest a controller keeps what it believed before
        estimates |= {"static": 0.0, "stribeck": 0.0}
    for name in ("sensor_gain", "sensor_offset"):
        estimates[name] = values.need(name) if joint.sensor else 0.0
    return estimates


def _inertias(joint: Joint, values: Values) -> tuple[float, float]:
    """Inertia of the drive, and of the link behind the sensor."""
    link = 0.0 if joint.link is None else _inertia(joint.link, joint.kind == "revolute")
    identified = values.get("inertia")
    if identified is not None:
        # Without a sensor the identified inertia holds the link's.
        return identified, link if joint.sensor else 0.0
    drive = joint.reflected_inertia
    if drive is None:
        raise InputError(
            "the joint's inertia is not known, which a simulation needs; give inertia or rotor_inertia, or "
            "joint.with_parameters({'inertia': ...})"
        )
    values.used["inertia"] = drive if joint.sensor else drive + link
    return drive, link


def _inertia(link: Link, revolute: bool) -> float:
    if not revolute:
        return link.mass
    if link.inertia is not None:
        return link.inertia
    return link.mass * link.centre_of_mass * link.centre_of_mass


def _weight(link: Link) -> tuple[float, float]:
    return link.mass * link.gravity * link.centre_of_mass, link.angle
