"""The settings of an estimate, and the functions that read the model from them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from jointid.base.schema import Flag, ListOf, Number, OrNull, Plain, Record, TableOf, Text
from jointid.joint.model import FIELDS, Model
from jointid.problem.terms import RESIDUALS

# Only settings that the program reads are declared. All others are for people, and to repeat the run.
SETTINGS = Record(
    fields={
        "version": Text(),
        "kind": Text(known=("revolute", "prismatic")),
        "method": Text(),
        "model": Text(),
        "terms": ListOf(Text(), shortest=1, longest=1000),
        "residual": Text(known=RESIDUALS),
        "windows": Number(low=1e-9, high=1e9),
        "torque_hold": OrNull(Text(known=("zoh", "linear"))),
        "mask_standstill": Flag(),
        "seed": Number(low=0, high=2**64 - 1, whole=True),
        "ga": OrNull(TableOf(Plain())),
        "recordings": ListOf(
            Record({"name": OrNull(Text()), "fingerprint": Text()}, other=Plain()), shortest=1
        ),
    },
    optional={
        "dropped": Text(),
        "bounds_from_data": ListOf(Text()),
        "shift": TableOf(Number(low=-1.0, high=1.0)),
        "min_speed": Number(low=0.0, high=1e6),
        "residual_reason": Text(),
    },
    other=Plain(),
)


def model_of(settings: Mapping[str, Any]) -> Model:
    """Return the identified model; settings of schema 1 have its fields next to its name.

    Raises
    ------
    InputError
        The saved model is invalid.
    """
    # Here "terms" are the keys of the core's terms, not the model's own terms.
    beside = {name: settings[name] for name in FIELDS if name in settings and name != "terms"}
    return Model.of(beside).over(Model.parse(settings["model"]))


def model_description(settings: Mapping[str, Any]) -> str:
    """Return model and residual as text, e.g. "stribeck:ripple=2, residual of the sensor"."""
    text = f"{model_of(settings).resolved}, {residual_text(settings['residual'])}"
    if settings.get("residual_reason"):
        text = f"{text} ({settings['residual_reason']})"
    return f"{text} (without {settings['dropped']})" if settings.get("dropped") else text


def residual_text(residual: str) -> str:
    """Return the compared signal as text, e.g. "residual of the torque"."""
    return (
        "gain by instrumental variables"
        if residual == "instruments"
        else f"residual of the {residual}"
    )


def torque_unit(settings: Mapping[str, Any]) -> str:
    """Return the unit of the drive's torque or force."""
    return "N" if settings["kind"] == "prismatic" else "N·m"


def residual_unit(settings: Mapping[str, Any]) -> str:
    """Return the unit of the signal that the residual compares."""
    return torque_unit(settings) if settings["residual"] == "torque" else "sensor units"
