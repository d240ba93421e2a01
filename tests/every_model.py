"""A joint for every friction model of the core's table, with values made from its rows."""

from __future__ import annotations

from typing import get_args

import jointid as jid
from jointid import _core
from jointid.joint.model import AUTO, ModelName

FADED = 0.1  # rad/s: where friction has faded that has a shape
MODELS = tuple(name for name in get_args(ModelName) if name != AUTO)


def friction_values(name: str, *, asymmetric: bool = False, size: float = 25.0) -> dict[str, float]:
    """Values of a model's parameters: dry friction of `size`, the rest somewhat smaller."""
    values: dict[str, float] = {}
    for key in _core.model_terms(name, asymmetric=asymmetric):
        term = _core.term(key)
        share = 1.0 if term.basis == "constant" else 0.8
        values[term.name] = size * (share if term.side >= 0 else 0.7 * share)
        for shape in map(_core.shape, term.shapes):
            power = shape.speed_power
            values[shape.name] = FADED**power if power else shape.typical
    return values


def joint_of(name: ModelName, *, asymmetric: bool = False) -> jid.Joint:
    """A sensorless joint with all values."""
    joint = jid.Joint(
        name=f"joint with {name}{' of two sides' if asymmetric else ''}",
        inertia=2.5,
        limits=jid.Limits(torque=400.0, velocity=3.0, position=(-2.0, 2.0)),
        model=jid.Model(name, asymmetric=asymmetric),
    )
    return joint.with_parameters(
        friction_values(name, asymmetric=asymmetric) | {"torque_offset": 0.0}
    )
