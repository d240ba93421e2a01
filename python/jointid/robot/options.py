"""Keyword options of `identify` and `compare` for a robot."""

from collections.abc import Mapping, Sequence
from typing import Annotated

from jointid.base.options import Option
from jointid.joint.model import Model
from jointid.problem.settings import MaskOptions
from jointid.robot.motion.shifts import Shift


class RobotFitOptions(MaskOptions, total=False):
    """Options that all candidates of a comparison share."""

    windows: Annotated[
        float | None,
        Option(
            kind="float or int, optional",
            help="Duration of the windows [s], or, as a whole number, their number. Default: a duration from the "
            "noise of the velocities, at most 0.1 s; recordings of several minutes or more have longer windows.",
        ),
    ]
    min_speed: Annotated[
        float | Sequence[float] | Mapping[str, float] | None,
        Option(
            kind="float, sequence or mapping of float, optional",
            help="Motion of a joint below this speed is left out [rad/s or m/s]: one speed for all joints, one per "
            "joint, or a mapping by name. Default 0.",
        ),
    ]
    shift: Annotated[
        Shift | None,
        Option(
            kind="mapping, optional",
            help='Delay of the "torque" against the position [s], to be removed; positive: the torque is late. One '
            "for all joints, a sequence with one for each, or a mapping by joints' names, e.g. "
            '``{"torque": 0.001}``; "torque_filter" is the time constant of the torque\'s low-pass '
            "filter [s]. An empty mapping shifts nothing. Default: identified: one delay for all joints, another one "
            "for a joint that clearly differs, or a filter if it explains more of the torque. A torque that is early "
            "by more than one sample is reported, but not shifted.",
        ),
    ]


class RobotOptions(RobotFitOptions, total=False):
    """Options of one identification."""

    model: Annotated[
        Model | str | Mapping[str, Model | str] | None,
        Option(
            kind="Model, str or mapping, optional",
            help='Friction of the joints: "coulomb_viscous", "stribeck", "smooth_coulomb_viscous" (Coulomb friction '
            'rises with the speed), or "auto": a joint gets static friction if '
            "this model predicts its held-out torque better. With ``:asymmetric`` after the name, or "
            '``Model(asymmetric=True)``, friction differs between the directions: "viscous" is the mean, '
            '"viscous_difference" half the difference (positive − negative). Half the difference of Coulomb '
            'friction is in "torque_offset". With ``:load_friction``, friction also grows with the torque of the '
            "links. A mapping from joint names to models sets the models of these joints. "
            'Default: the robot\'s models, otherwise "auto".',
        ),
    ]
