"""Write a design's file: its tables, with comments."""

from __future__ import annotations

from dataclasses import asdict, fields
from typing import Any

from jointid import _core
from jointid.base.toml_text import toml_of
from jointid.excitation.design_fields import DesignFields
from jointid.excitation.expected_error import ExpectedError
from jointid.joint.joint_file import joint_document
from jointid.simulation.motion_file import COMMENTS, SCHEMA, motion_table
from jointid.simulation.setting_tables import controller_table, plain, sensors_table

_SAYS = COMMENTS | {
    "trajectory": "a sum of sines: amplitude · sin(frequency · t + phase)",
    "believed": "joints drawn from these ranges keep the limits",
    "limits": "limits of the motion",
    "peaks": "largest values over joints drawn from the prior",
    "reference": "largest relative errors in the thesis's motion, for comparison",
    "design.control_period": "s",
    "controller": "that drives the joint",
    "joint": "the nominal one",
}


def document_of(design: DesignFields) -> dict[str, Any]:
    """Return a design as the tables of its file, in JSON types."""
    own = {item.name for item in fields(ExpectedError)} - {"name"}
    return {
        "schema": SCHEMA,
        "trajectory": motion_table(design.trajectory),
        "expected": {
            name: {
                key: plain(value)
                for key, value in asdict(each).items()
                if key in own and value is not None
            }
            for name, each in design.parameters.items()
        },
        **(
            {"reference": {name: plain(share) for name, share in design.reference.items()}}
            if design.reference
            else {}
        ),
        **(
            {"believed": {name: list(ends) for name, ends in design.believed.items()}}
            if design.believed
            else {}
        ),
        "limits": {
            name: list(value) if isinstance(value, tuple) else value
            for name, value in design.limits.asdict().items()
        },
        "peaks": {
            name: value for name, value in design.peaks.to_dict().items() if value is not None
        },
        "controller": controller_table(design.controller),
        "sensors": sensors_table(design.sensors),
        "joint": joint_document(design.joint),
        "design": {
            "status": design.status,
            **({"reason": design.reason} if design.reason else {}),
            "criterion": design.criterion,
            "joints": design.joints,
            "evaluations": design.evaluations,
            "seed": design.seed,
            "control_period": design.control_period,
            "weakest": design.weakest,
            "limited_by": design.limited_by,
            "jointid": _core.__version__,  # the last line: a truncated file lacks it
        },
    }


def design_text(design: DesignFields) -> str:
    """Return the text of a design's .toml file."""
    return toml_of(document_of(design), _SAYS)
