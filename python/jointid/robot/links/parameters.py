"""The parameters of a robot's joint: those in the core's table of terms, and those that only a robot has."""

from __future__ import annotations

import numpy as np

from jointid import _core
from jointid.robot.links.models import LOAD, MODELS, PLAIN, linear_terms, modelled, terms_of

LINEAR_TERMS = {term.key: term for model in MODELS for term in linear_terms(model)}
"""Terms of the speed without shape parameters that any model has, by key."""
CONSTANT, VISCOUS = (
    next(term for term in linear_terms(PLAIN) if term.basis == basis)
    for basis in ("constant", "linear")
)
POSITION_GAIN = "position_gain"
"""Parameter of a joint with a drive of unknown gain."""
DIFFERENCE = f"{VISCOUS.name}_difference"
"""Parameter of joints with asymmetric friction; half the difference of the constant term is in the offset."""
MOTOR_TERMS = {f"motor_{term.name}": term for term in linear_terms(PLAIN)}
"""Friction of a motor that turns with several joints."""


def parameter_facts(*models: str) -> dict[str, tuple[str, str, str]]:
    """Return the meaning and units of each parameter of joints with these models: meaning, unit of a hinge, of a slide.

    The order is that of tables.
    """
    keys = {term.key for model in models for term in terms_of(model)}
    found: dict[str, tuple[str, str, str]] = {}
    for term in _core.terms():
        if term.key in keys:
            others = ", the other joints at rest" if term.basis == VISCOUS.basis else ""
            found.setdefault(term.name, _facts(term, f"{term.meaning}{others}"))
            for shape in map(_core.shape, term.shapes):
                found.setdefault(shape.name, _facts(shape, shape.meaning))
    more = f"half the difference of {VISCOUS.meaning}: positive direction minus negative direction"
    scale = "factor on all inertial parameters of the link that the joint moves"
    gain = "torque of the drive per position error, identified from the weight of the links"
    return {
        **found,
        DIFFERENCE: _facts(VISCOUS, more),
        **{
            name: _facts(term, f"{term.meaning} of the motor, from the motor's own speed")
            for name, term in MOTOR_TERMS.items()
        },
        "torque_offset": _facts(CONSTANT, "constant torque"),
        "rotor_inertia": ("inertia of the motor and its gear, at the joint", "kg·m²", "kg"),
        "inertia_scale": (scale, "", ""),
        POSITION_GAIN: (gain, "N·m/rad", "N/m"),
    }


def _facts(row: _core.Term | _core.Shape, meaning: str) -> tuple[str, str, str]:
    return meaning, row.unit, row.unit_prismatic


PARAMETERS = tuple(parameter_facts(*MODELS, modelled(PLAIN, load_friction=True)))
"""Names of a joint's parameters, in the order of tables."""
FRICTION = frozenset(PARAMETERS) - {
    *("torque_offset", "rotor_inertia", "inertia_scale", POSITION_GAIN)
}
"""Names of friction parameters."""
SHAPES = frozenset(name for model in MODELS for term in terms_of(model) for name in term.shapes)
JOINT_FRICTION = (*dict.fromkeys(term.name for term in LINEAR_TERMS.values()), LOAD.name)
LINEAR_FRICTION = (*JOINT_FRICTION, *MOTOR_TERMS)
"""Friction without shape parameters: of joints on their own speed and load, and of motors on theirs."""


def least_of(term: _core.Term) -> float:
    """Return the lower bound of a term's coefficient."""
    return 0.0 if term.non_negative else -np.inf
