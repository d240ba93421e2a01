"""The friction model of each joint as text: a name, and ``:asymmetric`` where the directions differ; and its terms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.model import AUTO, FIELDS, Model


def terms_of(model: str) -> list[_core.Term]:
    """Return the terms of a model, each for both directions."""
    return [_core.term(key) for key in _core.model_terms(name_of(model))]


def linear_terms(model: str) -> list[_core.Term]:
    """Return the terms whose basis has no shape parameter."""
    return [term for term in terms_of(model) if not term.shapes]


def shaped_term(model: str) -> _core.Term | None:
    """Return the term whose basis has a shape parameter, if the model has one."""
    return next((term for term in terms_of(model) if term.shapes), None)


def friction_models(
    model: object, names: Sequence[str], usual: Sequence[str] | None = None
) -> list[str]:
    """Return the text of each joint's model, from one for all or a mapping; joints without one have the `usual` one."""
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
    stated = {name for name in chosen.stated() if name not in ("name", "asymmetric")}
    if chosen.name not in (None, *MODELS, AUTO) or stated:
        raise InputError(
            f"of a whole robot's friction, one of {', '.join((*MODELS, AUTO))} is identified, each also as "
            "NAME:asymmetric",
            argument="model",
            value=str(chosen),
        )
    return modelled(chosen.name or AUTO, bool(chosen.asymmetric))


def modelled(name: str, asymmetric: bool) -> str:
    """Return a model's text."""
    return f"{name}:asymmetric" if asymmetric else name


def name_of(model: str) -> str:
    """Return the name in a model's text."""
    return model.partition(":")[0]


def is_asymmetric(model: str) -> bool:
    """Return whether a model's friction differs between the directions."""
    return bool(Model.parse(model).asymmetric)


MODELS = tuple(
    model.name
    for model in _core.models()
    if sum(len(term.shapes) for term in terms_of(model.name)) <= 1
)
"""Of a robot's joint: at most one shape parameter."""
PLAIN = next(name for name in MODELS if shaped_term(name) is None)
SHAPED = next(name for name in MODELS if shaped_term(name) is not None)
"""What "auto" tries: `PLAIN`, and this model where it predicts better."""
