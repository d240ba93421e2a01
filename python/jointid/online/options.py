"""Keyword options of `OnlineIdentifier` in addition to joint, window and update."""

import numbers
from collections.abc import Mapping
from typing import Annotated, Any, TypedDict

from jointid.base.errors import InputError
from jointid.base.options import Option
from jointid.joint.checks import finite_number, is_number
from jointid.joint.model import Model, ModelName
from jointid.problem.settings import BalanceOptions


def checked_duration(name: str, value: Any) -> float:
    """Return a duration [s], or refuse an invalid one."""
    if not is_number(value):
        raise InputError("a duration in seconds is expected", argument=name, value=value)
    try:
        seconds = finite_number("", name, value)
    except InputError as error:
        value, seconds = error.value, 0.0
    if seconds <= 0.0:
        raise InputError("a finite duration above 0 s is expected", argument=name, value=value)
    return seconds


def _windows(name: str, value: Any) -> float | None:
    if value is None:
        return None
    seconds = checked_duration(name, value)
    if isinstance(value, numbers.Integral):
        raise InputError(
            "the duration of a window in seconds is expected, like 0.02",
            argument=name,
            value=value,
        )
    return seconds


class _OwnOptions(TypedDict, total=False):
    model: Annotated[
        Model | ModelName | Mapping[str, Any] | None,
        Option(
            kind="Model, str or mapping, optional",
            help="Friction model as for `identify`, with at most one shape parameter and no automatic choice. "
            'Default: the joint\'s model, or "coulomb_viscous".',
        ),
    ]
    windows: Annotated[
        float | None,
        Option(
            kind="float, optional",
            help="Duration of an integration window [s]; `window` must hold more than two integration windows per "
            "parameter. Default: chosen from the noise of the samples.",
            checked=_windows,
        ),
    ]


class OnlineOptions(_OwnOptions, BalanceOptions, total=False):
    """Options of the balance, and of the online identifier."""
