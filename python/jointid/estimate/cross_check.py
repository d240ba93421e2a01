"""The cross-check of an estimate: values of an independent least squares, and whether they agree."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field

from jointid.base.values import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class SecondValue:
    """One parameter from the cross-check.

    Attributes
    ----------
    value : float
        Value in the parameter's unit.
    stderr : float
        Standard error from leaving out blocks of the recording in turn.
    spread : float
        Range of the value over settings of filter and rows; 0 if the first setting agrees, because no other is
        then tried.
    agrees : bool
        Whether the difference from the estimate's value is within both errors and 5 %.
    """

    value: float
    stderr: float
    spread: float
    agrees: bool

    @property
    def error(self) -> float:
        """Total error, as one standard error."""
        return math.hypot(self.stderr, self.spread)


@dataclass(frozen=True, slots=True, kw_only=True)
class CrossCheck:
    """An independent plain least squares on the signals as recorded.

    Attributes
    ----------
    values : mapping of str to SecondValue
        Parameter → value, for parameters that the cross-check determines. Static friction and the Stribeck shape
        are never among them. Default: none.
    delay : float
        Shift of the torque (with a sensor: of the reading) [s]. Default 0.
    reason : str
        Reason why there is no cross-check. Default: there is one.
    """

    values: Mapping[str, SecondValue] = field(default_factory=dict)
    delay: float = 0.0
    reason: str = ""

    @property
    def contradicted(self) -> tuple[str, ...]:
        """Parameters for which the two methods disagree."""
        return tuple(name for name, each in self.values.items() if not each.agrees)

    @property
    def disagrees(self) -> bool | None:
        """Whether any value disagrees; None without a cross-check."""
        return None if self.reason else bool(self.contradicted)
