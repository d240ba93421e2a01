"""What `identify` and `compare` take of a robot by keyword."""

from collections.abc import Mapping, Sequence
from typing import Annotated

from jointid.base.options import Option
from jointid.joint.model import Model
from jointid.problem.settings import MaskOptions
from jointid.robot.motion.shifts import Shift


class RobotFitOptions(MaskOptions, total=False):
    """What all candidates of a comparison share."""

    windows: Annotated[
        float | None,
        Option(
            kind="float or int, optional",
            help="Duration of the windows [s]; a whole number is how many. Default: what the velocities' noise asks "
            "for, at most 0.1 s; of recordings longer than some minutes towards 0.1 s, because there are enough of "
            "them.",
        ),
    ]
    min_speed: Annotated[
        float | Sequence[float] | Mapping[str, float] | None,
        Option(
            kind="float, sequence or mapping of float, optional",
            help="Speed below which a joint's balance is left out [rad/s or m/s]; one for all, one a joint, or by "
            "name. Default 0.",
        ),
    ]
    shift: Annotated[
        Shift | None,
        Option(
            kind="mapping, optional",
            help='Delay of the "torque" against the position [s], to be taken away; positive: the torque is late. One '
            "for all joints, a sequence with one for each, or a mapping by joints' names, e.g. "
            '``{"torque": 0.001}``; "torque_filter" is the time constant of a low-pass filter that it passed [s]. An '
            "empty mapping shifts nothing. Default: found. One delay for all joints, another for a joint that clearly "
            "differs, or a filter if that explains more. A torque that is early by more than one sample is not "
            "shifted. The findings report it.",
        ),
    ]


class RobotOptions(RobotFitOptions, total=False):
    """What one identification takes."""

    model: Annotated[
        Model | str | Mapping[str, Model | str] | None,
        Option(
            kind="Model, str or mapping, optional",
            help='Friction of the joints: "coulomb_viscous", "stribeck", "smooth_coulomb_viscous" (Coulomb friction '
            'rises with the speed), or "auto": each joint has static friction if '
            "that predicts its held-out torque better. With ``:asymmetric`` behind it, or as "
            '``Model(asymmetric=True)``, friction differs between the directions: "viscous" is then the mean, and '
            '"viscous_difference" half of what is more in the positive direction; half the difference of Coulomb '
            'friction is in "torque_offset". With ``:load_friction`` it grows with the torque of the links, too. A '
            "mapping from joints' names to models says it for some of them. "
            'Default: the robot\'s models, else "auto".',
        ),
    ]
