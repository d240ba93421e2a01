"""The friction model of each joint, as it is asked for: a name, and ``:asymmetric`` where directions differ."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from jointid.base.errors import InputError
from jointid.joint.model import FIELDS, Model

PLAIN, STRIBECK, AUTO = "coulomb_viscous", "stribeck", "auto"
_NAMES = (PLAIN, STRIBECK, AUTO)


def friction_models(
    model: object, names: Sequence[str], usual: Sequence[str] | None = None
) -> list[str]:
    """Return the name of each joint's model.

    Parameters
    ----------
    model : Model, str, mapping or None
        One for all, or by joints' names.
    names : sequence of str
        Of the joints.
    usual : sequence of str, optional
        Models of joints for which none is given. Default: "auto".

    Raises
    ------
    InputError
        No such joint, or a model that is not known here.
    """
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
    if chosen.name not in (None, *_NAMES) or stated:
        raise InputError(
            f"of a whole robot's friction, one of {', '.join(_NAMES)} is identified, each also as NAME:asymmetric",
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


def asymmetric(models: Sequence[str]) -> list[bool]:
    """Return which models' friction differs between the directions."""
    return [bool(Model.parse(each).asymmetric) for each in models]
