"""Models of a comparison: those of the call, or the default ones with the gravity that the recordings show."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from jointid.base.errors import InputError
from jointid.identification.prepared import prepare
from jointid.joint.joint import Joint
from jointid.joint.model import Gravity, Model, ModelName
from jointid.problem.settings import Settings
from jointid.recording.recording import Recording

_MODELS: tuple[ModelName, ...] = ("coulomb_viscous", "stribeck")


def default_models() -> tuple[Model, ...]:
    """Return the models compared by default: Coulomb + viscous and Stribeck, each also asymmetric."""
    return tuple(Model(name, asymmetric=side) for side in (False, True) for name in _MODELS)


def compared_models(models: object) -> tuple[Model, ...]:
    """Return the models of a call: one or several, each as `Model.of` accepts it; symmetric unless stated.

    Raises
    ------
    InputError
        There is no model, an invalid object, a model without a name, or the same model twice.
    """
    alone = isinstance(models, str | Model | Mapping)
    if not alone and not isinstance(models, Iterable):
        raise InputError("a list of models is expected", argument="models", value=models)
    given = (models,) if alone else tuple(models)  # type: ignore[arg-type]
    entries = tuple(Model.of(each).over(Model(asymmetric=False)) for each in given)
    if not entries:
        raise InputError(
            "at least one model is expected, e.g. stribeck", argument="models", value=[]
        )
    for index, model in enumerate(entries):
        if not model.named:
            raise InputError(
                "a compared model needs a name", argument="models", value=text_of(model)
            )
        if model in entries[:index]:
            raise InputError("it is given twice", argument="models", value=text_of(model))
    return entries


def shown_gravity(
    runs: Sequence[Recording], joint: Joint | None, settings: Settings
) -> Gravity | None:
    """Return the gravity that `identify` would choose from the recordings; None if there is none, or if it is stated.

    Parameters
    ----------
    runs : sequence of Recording
    joint : Joint or None
    settings : Settings
    """
    if joint is not None and joint.model.gravity is not None:
        return None
    try:
        model = prepare(tuple(runs), joint, settings, choose=True).problem.choice.model
    except InputError:  # each fit reports its own error
        return None
    found = model.resolved.gravity
    return None if found == "none" else found


def text_of(spec: Model) -> str:
    """Return a compared model's text; symmetry is not mentioned in it."""
    return str(spec if spec.asymmetric else spec.replace(asymmetric=None))
