"""The cross-check of an identification: the values of two fits, and whether they agree."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True, kw_only=True)
class Compared:
    """One parameter in both fits.

    Attributes
    ----------
    value, stderr : float
        Value and standard error of the identification.
    second, second_stderr : float or None
        Value and standard error of the cross-check.
    spread : float or None
        Largest change of the value with other filters and rows of the cross-check.
    agrees : bool or None
        Whether both values agree. None: the cross-check does not determine the value.
    reason : str
        Reason why the cross-check does not determine the value.
    """

    value: float
    stderr: float
    second: float | None = None
    second_stderr: float | None = None
    spread: float | None = None
    agrees: bool | None = None
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class CrossCheck:
    """The cross-check of a robot's identification: an independent plain least squares.

    Attributes
    ----------
    parameters : mapping of str to Compared
        Compared values, by the names of `RobotEstimate.parameters`.
    residuals : mapping of str to (float, float)
        Joint → residual over torque in the rows of the cross-check, with the identified values and with its own values.
    agrees : bool or None
        Whether both fits agree. None: no value was compared.
    reason : str
        Reason why there is no cross-check.
    explained : bool
        Whether both fits agree once the named facts are corrected, or with the advised models.
    """

    parameters: Mapping[str, Compared] = field(default_factory=dict)
    residuals: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    agrees: bool | None = None
    reason: str = ""
    explained: bool = False

    def __str__(self) -> str:
        if self.agrees is None:
            return f"none: {self.reason}"
        compared = sum(each.agrees is not None for each in self.parameters.values())
        apart = [name for name, each in self.parameters.items() if each.agrees is False]
        if not self.agrees:
            what = f"disagrees: {', '.join(apart)}" if apart else "explains much more of the torque"
            also = "; the findings explain why" if self.explained else ""
            return f"a simple filtered least-squares fit {what}{also}"
        return f"a simple filtered least-squares fit agrees ({compared} of {len(self.parameters)} values compared)"
