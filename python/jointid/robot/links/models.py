"""The friction model of each joint as text, and its terms.

The text is a name, plus ``:asymmetric`` if the directions differ and ``:load_friction`` if the load adds friction.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.model import AUTO, FIELDS, Model

LOAD = next(term for term in _core.terms() if term.needs_load and term.behind_gear)
"""Friction in proportion to the torque of the links."""


def terms_of(model: str) -> list[_core.Term]:
    """Return the terms of a model, each for both directions."""
    of_speed = [_core.term(key) for key in _core.model_terms(name_of(model))]
    return [*of_speed, LOAD] if is_loaded(model) else of_speed


def linear_terms(model: str) -> list[_core.Term]:
    """Return the terms without a shape parameter."""
    return [term for term in terms_of(model) if not term.shapes]


def shaped_term(model: str) -> _core.Term | None:
    """Return the term with a shape parameter, if the model has one."""
    return next((term for term in terms_of(model) if term.shapes), None)


def friction_models(
    model: object, names: Sequence[str], usual: Sequence[str] | None = None
) -> list[str]:
    """Return the text of each joint's model, from one for all or a mapping. Joints without a model get `usual`."""
    if isinstance(model, Mapping) and not (model and set(model) <= set(FIELDS)):
        for name in model:
            if name not in names:
                raise InputError(
                    f"the robot has no such joint; it has {', '.join(names)}",
                    argument="model",
                    value=name,
                )
        given = [model.get(name) for name in names]
    else:
        given = [model] * len(names)
    return [_named(*each) for each in zip(given, usual or [AUTO] * len(given), strict=True)]


def _named(model: object, usual: str) -> str:
    chosen = Model.of(model)
    if not chosen.stated():
        return usual
    stated = {name for name in chosen.stated() if name not in _FIELDS}
    if chosen.name not in (None, *MODELS, AUTO) or stated or chosen.load_friction == "drive":
        raise InputError(
            f"a robot's friction model is one of {', '.join((*MODELS, AUTO))}; options follow the name: "
            "NAME:asymmetric, NAME:load_friction (friction from the links' torque), or both",
            argument="model",
            value=str(chosen),
        )
    return modelled(
        chosen.name or AUTO,
        asymmetric=bool(chosen.asymmetric),
        load_friction=bool(chosen.load_friction),
    )


_FIELDS = ("name", "asymmetric", LOAD.option)


def modelled(name: str, *, asymmetric: bool = False, load_friction: bool = False) -> str:
    """Return a model's text."""
    options = {"asymmetric": asymmetric, LOAD.option: load_friction}
    return ":".join([name, *(option for option, stated in options.items() if stated)])


def renamed(model: str, name: str) -> str:
    """Return a model's text with another name and the same options."""
    return ":".join([name, *model.split(":")[1:]])


def name_of(model: str) -> str:
    """Return the name in a model's text."""
    return model.partition(":")[0]


def is_asymmetric(model: str) -> bool:
    """Return whether a model's friction differs between the directions."""
    return "asymmetric" in model.split(":")[1:]


def is_loaded(model: str) -> bool:
    """Return whether a model's friction grows with the load."""
    return LOAD.option in model.split(":")[1:]


MODELS = tuple(
    model.name
    for model in _core.models()
    if sum(len(term.shapes) for term in terms_of(model.name)) <= 1
)
"""Models for a robot's joint: they have at most one shape parameter."""
PLAIN = next(name for name in MODELS if shaped_term(name) is None)
SHAPED = next(name for name in MODELS if shaped_term(name) is not None)
"""The model that "auto" compares with `PLAIN`; it is used if it predicts better."""
