"""The parameters of a robot's joint: those of the core's table of terms, and those that only a robot has."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from jointid import _core
from jointid.robot.models import MODELS, PLAIN, linear_terms, terms_of

LINEAR_TERMS = {term.key: term for model in MODELS for term in linear_terms(model)}
"""Terms without shape parameters that some model has, by key."""
CONSTANT, VISCOUS = (
    next(term for term in linear_terms(PLAIN) if term.basis == basis)
    for basis in ("constant", "linear")
)
DIFFERENCE = f"{VISCOUS.name}_difference"
"""Of joints with asymmetric friction; half the difference of the constant term is in the offset."""
MOTOR_TERMS = {f"motor_{term.name}": term for term in linear_terms(PLAIN)}
"""Friction of a motor that turns with several joints."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterFacts:
    """What a table says of a parameter: its meaning, and its units of a hinge and of a slide."""

    meaning: str
    units: tuple[str, str]


def _facts(row: _core.Term | _core.Shape, meaning: str) -> ParameterFacts:
    return ParameterFacts(meaning=meaning, units=(row.unit, row.unit_prismatic))


def parameter_facts(*models: str) -> dict[str, ParameterFacts]:
    """Return the facts of all parameters that a joint with one of these models can have, in the order of tables."""
    keys = {term.key for model in models for term in terms_of(model)}
    found: dict[str, ParameterFacts] = {}
    for term in _core.terms():
        if term.key in keys:
            others = ", the other joints at rest" if term.basis == VISCOUS.basis else ""
            found.setdefault(term.name, _facts(term, f"{term.meaning}{others}"))
            for name in term.shapes:
                found.setdefault(name, _facts(_core.shape(name), _core.shape(name).meaning))
    more = f"half of what {VISCOUS.meaning} is more in the positive than in the negative direction"
    found[DIFFERENCE] = _facts(VISCOUS, more)
    for name, term in MOTOR_TERMS.items():
        found[name] = _facts(term, f"{term.meaning} of the motor, on its own speed")
    found["torque_offset"] = _facts(CONSTANT, "constant torque")
    rotor = "inertia of the motor and its gear, at the joint"
    found["rotor_inertia"] = ParameterFacts(meaning=rotor, units=("kg·m²", "kg"))
    scale = "factor on all inertial parameters of the link that the joint moves"
    found["inertia_scale"] = ParameterFacts(meaning=scale, units=("", ""))
    return found


PARAMETERS = tuple(parameter_facts(*MODELS))
"""Names of a joint's parameters, in the order of tables."""
SHAPES = frozenset(name for model in MODELS for term in terms_of(model) for name in term.shapes)
LINEAR_FRICTION = tuple(dict.fromkeys(term.name for term in LINEAR_TERMS.values()))
"""Names of a joint's friction without shape parameters."""


def least_of(term: _core.Term) -> float:
    """Return the lower bound of a term's coefficient."""
    return 0.0 if term.non_negative else -np.inf
