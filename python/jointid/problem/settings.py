"""The settings of a problem, declared once: what `identify` takes besides recordings, joint and search.

A new option is an entry of a `TypedDict` below, of the narrowest that all its functions take, and a field of
`Settings`. Signatures, reference, command line and app follow.
"""

from collections.abc import Callable, Collection, Mapping
from typing import Annotated, Any, Self, TypedDict, get_args

import numpy as np

from jointid.base.errors import InputError
from jointid.base.options import Option, checked, options_of
from jointid.base.values import dataclass
from jointid.joint.checks import check_choice, check_flag, check_mapping
from jointid.joint.model import Model, ModelName
from jointid.joint.parameters import Parameter
from jointid.problem.terms import RESIDUALS, Residual
from jointid.problem.windows import Windows, checked_windows
from jointid.recording.shifting import checked_shift
from jointid.recording.signals import TorqueHold

Parameters = Mapping[str, float | Mapping[str, object] | Parameter]
"""Changes of parameters by name: values to fix, or fields to change."""

_FASTEST = 1e6  # [rad/s or m/s]


def _or_none(check: Callable[[str, Any], Any]) -> Callable[[str, Any], Any]:
    """The check of an option that may be left out."""
    return lambda name, value: None if value is None else check(name, value)


def _one_of(known: Collection[str]) -> Callable[[str, Any], Any]:
    def check(name: str, value: Any) -> Any:
        check_choice("", name, value, known)
        return value

    return _or_none(check)


def _flag(name: str, value: Any) -> bool:
    check_flag("", name, value)
    return bool(value)


def _mapping(name: str, value: Any) -> Any:
    check_mapping("", name, value)
    return value


def _speed(name: str, value: Any) -> float:
    number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
    if not number or not 0.0 <= float(value) < _FASTEST:
        raise InputError(
            "a speed of 0 or more is expected, in rad/s or m/s", argument=name, value=value
        )
    return float(value)


class MaskOptions(TypedDict, total=False):
    """What joints and robots share."""

    mask_standstill: Annotated[
        bool,
        Option(
            kind="bool",
            help="Whether to leave out the parts in which the joint sticks or stands still, where friction is "
            "set-valued and the model does not apply. Default True.",
            default=True,
            checked=_flag,
        ),
    ]


class SignalOptions(TypedDict, total=False):
    """What is known of the parameters, and how the signals are read."""

    parameters: Annotated[
        Parameters | None,
        Option(
            kind="mapping, optional",
            help='Changes by name: a number fixes the parameter; {"value", "min", "max", "vary"} or a `Parameter` '
            "changes those fields. Values in SI units.",
            checked=_or_none(_mapping),
            flag="--set",
            phrase="fix a parameter (SI)",
            form="numbers by name",
            metavar="PARAMETER=VALUE",
        ),
    ]
    residual: Annotated[
        Residual | None,
        Option(
            kind="str, optional",
            help='"instruments" (default with a sensor): the gain from the part of the reading that gravity and '
            "inertia of a rigid link explain, which neither the reading's noise nor friction that the model lacks "
            'biases. "sensor" (the thesis) compares the reading with what the torque leaves for it, "torque" (default '
            'without a sensor) the torque with the reading. Where instruments are weak the default is "sensor", and '
            '`settings` says why. On line instruments are refused, and the default is "sensor".',
            checked=_one_of(RESIDUALS),
            flag="--residual",
            phrase="residual to minimise: instruments, sensor or torque",
        ),
    ]
    torque_hold: Annotated[
        TorqueHold | None,
        Option(
            kind="str, optional",
            help='"zoh" for a torque command held between samples, "linear" for a measured torque. Default: the '
            "recording's, else the joint's, else \"linear\".",
            checked=_one_of(get_args(TorqueHold)),
            flag="--torque-hold",
            phrase="torque between samples: zoh (held command) or linear (measured)",
        ),
    ]


class BalanceOptions(SignalOptions, MaskOptions, total=False):
    """What poses the balance of a joint, on line, too."""


class FitOptions(BalanceOptions, total=False):
    """What all fits of a comparison share."""

    windows: Annotated[
        Windows,
        Option(
            kind='int, float, "cumulative" or WindowOptions, optional',
            help="An int is the approximate number of windows (gaps and several recordings change it), a float their "
            'duration [s]; "cumulative" compares the running integral at each sample, as the thesis\'s MATLAB program '
            "does. Default: the shortest windows that the noise of the velocity allows.",
            checked=lambda _, value: checked_windows(value),
            flag="--windows",
            phrase="number of windows, duration (0.05s) or cumulative; default: as short as the noise allows",
            form="windows",
        ),
    ]
    shift: Annotated[
        Mapping[str, float] | None,
        Option(
            kind="mapping of str to float, optional",
            help='Delays of "torque", "sensor" and "velocity" against the position [s], to be taken away; positive: '
            "the signal is late. An empty mapping shifts nothing. Default: the delays that are certain, but for a "
            "torque that is early by more than a sample, as it seems beside a late or coarse position; the "
            "estimate's `delays` and its report tell them.",
            checked=_or_none(lambda _, value: checked_shift(value)),
            flag="--shift",
            phrase="delay of torque, sensor or velocity to remove, positive: late; torque=0 removes none (default: "
            "delays that are certain)",
            form="numbers by name",
            metavar="SIGNAL=SECONDS",
        ),
    ]


class ModelOptions(TypedDict, total=False):
    """Which model is identified."""

    model: Annotated[
        Model | ModelName | Mapping[str, Any] | None,
        Option(
            kind="Model, str or mapping, optional",
            help='Terms of the torque balance, e.g. ``"stribeck:ripple=2"``; each stated field overrides that of the '
            "joint's model. Default: the joint's. Where neither names one, or the name is \"auto\", the model is "
            'chosen by held-out prediction: "coulomb_viscous" or "stribeck", with gravity free or none where that is '
            "neither stated nor known; `Estimate.selection` has the scores. A sweep chooses none: it takes "
            '"coulomb_viscous".',
            checked=lambda _, value: Model.of(value),
        ),
    ]
    terms: Annotated[
        Mapping[str, str] | None,
        Option(
            kind="mapping of str to str, optional",
            help="Own terms: extra signals of the recordings and how they enter, e.g. "
            '``{"q6_rate": "viscous+coulomb", "tau_model": "known"}``; the same as the field `terms` of the model. '
            "Default: the model's.",
            flag="--term",
            phrase="own term: a column (or --extra) and its kind: viscous, coulomb, known, scaled, inertia, ...; "
            "viscous@rate+coulomb@rate: of its rate; may be repeated",
            form="texts by name",
            metavar="SIGNAL=KIND",
        ),
    ]


class SpeedOptions(TypedDict, total=False):
    """From which part of the motion."""

    min_speed: Annotated[
        float | None,
        Option(
            kind="float, optional",
            help="Motion slower than this is left out [rad/s or m/s]; 0 leaves out nothing. Default: chosen; 0 unless "
            "slow motion contradicts the friction that faster motion shows (creep), and 0 for models whose friction "
            'depends on slow motion, such as "stribeck". The estimate\'s `slow_motion` tells it.',
            checked=_or_none(_speed),
            flag="--min-speed",
            phrase="leave out motion slower than this, rad/s or m/s; 0: leave out nothing (default: chosen from the "
            "data)",
            form="number",
        ),
    ]


class ProblemOptions(ModelOptions, FitOptions, SpeedOptions, total=False):
    """All options that pose a problem."""


def stated_model(options: Mapping[str, Any] | ProblemOptions) -> Model:
    """The model of a call's options, with its own terms.

    Raises
    ------
    InputError
        A model or terms that cannot be used.
    """
    model, terms = Model.of(options.get("model")), options.get("terms")
    return model if terms is None else model.replace(terms=terms)


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """The options of a call, complete and checked; None: chosen from the recordings, or as the joint has it."""

    model: Model  # with the own terms
    parameters: Parameters | None
    residual: Residual | None
    torque_hold: TorqueHold | None
    mask_standstill: bool
    windows: Windows
    shift: Mapping[str, float] | None
    min_speed: float | None

    @classmethod
    def of(cls, options: Mapping[str, Any] | ProblemOptions) -> Self:
        """The settings of a call's options; others are left out.

        Raises
        ------
        InputError
            A value that cannot be used with any recording.
        """
        found = checked(ProblemOptions, options)
        del found["terms"]
        return cls(**found | {"model": stated_model(options)})

    @property
    def kept(self) -> dict[str, Any]:
        """What an estimate keeps of them as it is: of the others it says what was chosen."""
        others = {"model", "terms", "parameters", "residual", "windows"}
        return {n: getattr(self, n) for n in options_of(ProblemOptions) if n not in others}


USUAL = Settings.of({})
"""All options by default."""
