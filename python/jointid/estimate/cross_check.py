"""The cross-check of an estimate: values of an independent least squares, and whether they agree."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field

from jointid.base.values import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class SecondValue:
    """One parameter by the cross-check.

    Attributes
    ----------
    value : float
        In the parameter's unit.
    stderr : float
        Standard error from blocks of the recording that are left out in turn.
    spread : float
        Range of the value over the settings of filter and rows; 0 where the first setting agrees, and no other is
        asked.
    agrees : bool
        Whether it contradicts the estimate's value by no more than both errors and 5 %.
    """

    value: float
    stderr: float
    spread: float
    agrees: bool

    @property
    def error(self) -> float:
        """Error of all kinds, as one standard error."""
        return math.hypot(self.stderr, self.spread)


@dataclass(frozen=True, slots=True, kw_only=True)
class CrossCheck:
    """An independent plain least squares on the signals as recorded.

    Attributes
    ----------
    values : mapping of str to SecondValue
        By parameter, those that the cross-check determines. Static friction and the Stribeck shape are never among
        them. Default: none.
    delay : float
        By which the torque (with a sensor: the reading) was shifted [s]. Default 0.
    reason : str
        Why there is no cross-check. Default: there is one.
    """

    values: Mapping[str, SecondValue] = field(default_factory=dict)
    delay: float = 0.0
    reason: str = ""

    @property
    def contradicted(self) -> tuple[str, ...]:
        """Parameters at which the two ways disagree."""
        return tuple(name for name, each in self.values.items() if not each.agrees)

    @property
    def disagrees(self) -> bool | None:
        """Whether any value disagrees; None where there is no cross-check."""
        return None if self.reason else bool(self.contradicted)
