"""Keyword options of `identify` and `compare` for a servo."""

from collections.abc import Mapping
from typing import Annotated, Any, TypedDict

from jointid.base.options import Option
from jointid.joint.model import Model, ModelName
from jointid.servo.windows import SLOWEST, WINDOW


class ServoFitOptions(TypedDict, total=False):
    """Options that all models of a comparison share."""

    window: Annotated[
        float,
        Option(kind="float", help="Duration of a window [s]. Default 0.05.", default=WINDOW),
    ]
    slowest: Annotated[
        float,
        Option(
            kind="float",
            help="Speed below which windows are left out [rad/s]. Default 0.1.",
            default=SLOWEST,
        ),
    ]
    lead: Annotated[
        float | None,
        Option(
            kind="float, optional",
            help="Time by which the position of a row is older than the duty of this row [s]. The bus reads both one "
            "after the other. Default: estimated if the position loop is known and the duty is logged, otherwise 0.",
        ),
    ]


class ServoOptions(ServoFitOptions, total=False):
    """Options of one identification."""

    model: Annotated[
        Model | ModelName | Mapping[str, Any] | None,
        Option(
            kind="Model, str or mapping, optional",
            help='Friction model without shape parameters, such as "coulomb_viscous", with or without `load_friction`. '
            "Default: the joint's model, otherwise a model with load friction.",
        ),
    ]
    draws: Annotated[
        int,
        Option(
            kind="int",
            help="Number of resampled sets of runs for errors and intervals. Default 200; 0 computes no errors.",
            default=200,
        ),
    ]
    seed: Annotated[int, Option(kind="int", help="Seed of the resampling. Default 0.", default=0)]
