"""Schema of the JSON of a robot's estimate."""

from jointid.base.schema import Flag, Kind, ListOf, Number, OrNull, Plain, Record, TableOf, Text
from jointid.estimate.json_schema import FINDING, MATRIX, PARAMETER, RESIDUALS, VERDICT, WINDOWS
from jointid.robot.links.inertia_modes import MODES
from jointid.robot.links.models import MODELS, modelled
from jointid.robot.links.position_drive import HOLDS

_MOST = 1000  # largest number of joints
_ANY = Number(infinite=True, undefined=True)
_SIZE = Number(low=-1e12, high=1e12)  # far beyond any robot, and its cube is still a number
_TRIPLE = ListOf(_SIZE, 3, 3)

_JOINT = Record(
    {
        "model": Text(
            known=tuple(
                modelled(name, asymmetric=asymmetric, load_friction=load)
                for name in MODELS
                for asymmetric in (False, True)
                for load in (False, True)
            )
        ),
        "parameters": TableOf(PARAMETER),
        "residuals": RESIDUALS,
        "windows": OrNull(WINDOWS),
    }
)
_LINK = Record(
    {
        "name": Text(longest=200),
        "parent": Number(low=-1, high=_MOST, whole=True),
        "kind": Text(known=("revolute", "prismatic")),
        "rotation": ListOf(ListOf(Number(low=-1.1, high=1.1), 3, 3), 3, 3),
        "translation": _TRIPLE,
        "axis": ListOf(Number(low=-1.1, high=1.1), 3, 3),
        "inertial": ListOf(_SIZE, 10, 10),
        "rotor_inertia": OrNull(Number(low=0.0, high=1e12)),
    }
)
_STIFFNESS = ListOf(Number(low=0.0, high=1e12))
_DRIVE = Record(
    {"kp": ListOf(OrNull(Number(low=0.0, high=1e12))), "kd": _STIFFNESS, "hold": Text(known=HOLDS)},
    {"torque_limits": _STIFFNESS, "delay": ListOf(Number(low=0.0, high=1.0))},
)
_ROBOT = Record(
    {
        "joints": ListOf(_LINK, 1, _MOST),
        "gravity": _TRIPLE,
        "couplings": ListOf(ListOf(_SIZE)),
        "gear_ratios": OrNull(ListOf(_SIZE)),
        "zero_offsets": OrNull(ListOf(_SIZE)),
        "side": OrNull(Text(known=("joint", "motor"))),
    },
    {
        **{
            key: OrNull(ListOf(_SIZE))
            for key in ("torque_scales", "directions", "torque_constants")
        },
        "drive": OrNull(_DRIVE),
    },
)
_SAID = OrNull(Number(infinite=True, undefined=True))
_CROSS_CHECK = Record(
    {
        "parameters": TableOf(
            Record(
                {
                    "value": _ANY,
                    "stderr": _ANY,
                    "second": _SAID,
                    "second_stderr": _SAID,
                    "spread": _SAID,
                    "agrees": OrNull(Flag()),
                    "reason": Text(),
                }
            )
        ),
        "residuals": TableOf(ListOf(_ANY, 2, 2)),
        "agrees": OrNull(Flag()),
        "reason": Text(),
        "explained": Flag(),
    }
)
# Only fields that are used again are declared. All other fields are for readers of the file.
_SETTINGS = Record(
    {
        "window_duration": Number(low=1e-9, high=1e9),
        "min_speed": ListOf(Number(low=0.0, high=1e12)),
        "mask_standstill": Flag(),
        "recordings": ListOf(OrNull(Text()), 1),
    },
    {"recorded_velocity": ListOf(Text())},
    other=Plain(),
)
ROBOT_ESTIMATE: Kind = Record(
    {
        "schema": Number(low=2, high=2, whole=True),
        "kind": Text(),
        "name": Text(longest=200),
        "seconds": Number(low=0.0, high=1e12),
        "inertia": Text(known=MODES),
        "consistent": OrNull(Flag()),
        "impossible_by": Number(low=0.0, high=1e100),
        "relative_residual": _ANY,
        "condition": _ANY,
        "joints": TableOf(_JOINT, _MOST),
        "base_parameters": ListOf(PARAMETER),
        "inertial": ListOf(ListOf(_SIZE, 10, 10), 1, _MOST),
        "free": ListOf(Text()),
        "covariance": MATRIX,
        "robot": _ROBOT,
        "findings": ListOf(FINDING),
        "settings": _SETTINGS,
    },
    {
        "bootstrap": Plain(),
        "verdict": VERDICT,
        "cross_check": OrNull(_CROSS_CHECK),
        "within": TableOf(_ANY),
    },
)
