"""The settings of a problem, declared once: the options of `identify` except recordings, joint and search.

A new option is an entry of a `TypedDict` below and a field of `Settings`. Choose the narrowest `TypedDict` that all
functions with this option take. Signatures, reference, command line and app follow from it.
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
    """Return the check of an option that may be None."""
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
    """Options of joints and robots."""

    mask_standstill: Annotated[
        bool,
        Option(
            kind="bool",
            help="Whether to leave out the parts in which the joint sticks or stands still. The model is not "
            "valid in these parts, because friction at rest has no unique value. Default True.",
            default=True,
            checked=_flag,
        ),
    ]


class SignalOptions(TypedDict, total=False):
    """Prior knowledge of the parameters, and interpretation of the signals."""

    parameters: Annotated[
        Parameters | None,
        Option(
            kind="mapping, optional",
            help="Values or bounds by parameter name. A number fixes the parameter. A `Parameter`, or a mapping of "
            '"value", "min", "max" or "vary", changes these fields. Values are in SI units.',
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
            help='"instruments" (default with a sensor): instrumental variables. The gain follows from the part of the '
            "reading that gravity and inertia of a rigid link explain. Noise of the reading and friction outside the "
            'model do not bias the gain. "sensor" (the thesis) compares the reading with the torque minus all other '
            'terms. "torque" (default without a sensor) compares the torque with the sum of all terms. If gravity and '
            'inertia explain too little of the reading, the default is "sensor", and `settings` states the reason. '
            'Online, only "sensor" (default) and "torque" are possible.',
            checked=_one_of(RESIDUALS),
            flag="--residual",
            phrase="residual to minimise: instruments (instrumental variables), sensor or torque",
        ),
    ]
    torque_hold: Annotated[
        TorqueHold | None,
        Option(
            kind="str, optional",
            help='"zoh" for a torque command held between samples, "linear" for a measured torque. Default: the '
            'value of the recording, otherwise of the joint, otherwise "linear".',
            checked=_one_of(get_args(TorqueHold)),
            flag="--torque-hold",
            phrase="torque between samples: zoh (held command) or linear (measured)",
        ),
    ]


class BalanceOptions(SignalOptions, MaskOptions, total=False):
    """Options of a joint's balance, also online."""


class FitOptions(BalanceOptions, total=False):
    """Options that all fits of a comparison share."""

    windows: Annotated[
        Windows,
        Option(
            kind='int, float, "cumulative" or WindowOptions, optional',
            help="An int is the approximate number of windows (gaps and several recordings change this number). A "
            'float is the duration of each window [s]. "cumulative" compares the running integral at each sample, like '
            "the MATLAB program of the thesis. Default: the shortest windows that the noise of the velocity allows.",
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
            help='Delays to remove from "torque", "sensor" and "velocity", relative to the position [s]. Positive: '
            "the signal is late. An empty mapping removes no delay. Default: all certain delays. A torque that "
            "leads the position by more than a sample is not shifted: the position may be late or coarse instead. The "
            "estimate's `delays` and its report list the delays.",
            checked=_or_none(lambda _, value: checked_shift(value)),
            flag="--shift",
            phrase="delay to remove from torque, sensor or velocity (positive if the signal is late, 0 to remove none; "
            "default: all certain delays)",
            form="numbers by name",
            metavar="SIGNAL=SECONDS",
        ),
    ]


class ModelOptions(TypedDict, total=False):
    """Options of the model."""

    model: Annotated[
        Model | ModelName | Mapping[str, Any] | None,
        Option(
            kind="Model, str or mapping, optional",
            help='Terms of the torque balance, e.g. ``"stribeck:ripple=2"``. Each stated field overrides the field of '
            "the joint's model. Default: the joint's model. If neither has a name, or the name is \"auto\", held-out "
            'prediction chooses "coulomb_viscous" or "stribeck". It also chooses free or no gravity, if gravity is '
            "neither stated nor known. `Estimate.selection` has the scores. A sweep does not choose; it uses "
            '"coulomb_viscous".',
            checked=lambda _, value: Model.of(value),
        ),
    ]
    terms: Annotated[
        Mapping[str, str] | None,
        Option(
            kind="mapping of str to str, optional",
            help='Own terms: extra signals of the recordings and their kind of term, e.g. ``{"q6_rate": '
            '"viscous+coulomb", "tau_model": "known"}``. The field `terms` of the model has the same meaning. Default: '
            "the terms of the model.",
            flag="--term",
            phrase="own term, may be repeated: a column (or --extra) and its kind, such as viscous, coulomb, known, "
            "scaled or inertia; viscous@rate uses the column's derivative; + joins two kinds",
            form="texts by name",
            metavar="SIGNAL=KIND",
        ),
    ]


class SpeedOptions(TypedDict, total=False):
    """Options of the part of the motion that is used."""

    min_speed: Annotated[
        float | None,
        Option(
            kind="float, optional",
            help="Speed below which motion is left out [rad/s or m/s]. Default: 0 (no motion is left out). If slow "
            "motion contradicts the friction of faster motion (creep), the default leaves slow motion out. The default "
            'is always 0 for models with low-speed friction, such as "stribeck". See the estimate\'s `slow_motion`.',
            checked=_or_none(_speed),
            flag="--min-speed",
            phrase="leave out motion below this speed, rad/s or m/s (0: leave out no motion; default: chosen from the "
            "data)",
            form="number",
        ),
    ]


class ProblemOptions(ModelOptions, FitOptions, SpeedOptions, total=False):
    """All options of a problem."""


def stated_model(options: Mapping[str, Any] | ProblemOptions) -> Model:
    """Return the model of a call's options, with its own terms.

    Raises
    ------
    InputError
        The model or the terms cannot be used.
    """
    model, terms = Model.of(options.get("model")), options.get("terms")
    return model if terms is None else model.replace(terms=terms)


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """The options of a call, complete and checked; None: chosen from the recordings, or taken from the joint."""

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
        """Return the settings from a call's options; other options are ignored.

        Raises
        ------
        InputError
            A value cannot be used with any recording.
        """
        found = checked(ProblemOptions, options)
        del found["terms"]
        return cls(**found | {"model": stated_model(options)})

    @property
    def kept(self) -> dict[str, Any]:
        """Return the settings that an estimate keeps unchanged; for the others it keeps the choices."""
        others = {"model", "terms", "parameters", "residual", "windows"}
        return {n: getattr(self, n) for n in options_of(ProblemOptions) if n not in others}


USUAL = Settings.of({})
"""Default settings."""
