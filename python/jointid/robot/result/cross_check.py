"""What the second look says of an identification: both values, and whether they agree."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True, kw_only=True)
class Compared:
    """One parameter in both looks.

    Attributes
    ----------
    value, stderr : float
        Of the identification.
    second, second_stderr : float or None
        Of the second look.
    spread : float or None
        How far the second look's other filters and rows are from its value.
    agrees : bool or None
        None: the second look says nothing.
    reason : str
        Why it says nothing.
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
    """The second look at a robot's identification.

    Attributes
    ----------
    parameters : mapping of str to Compared
        By the names of `RobotEstimate.parameters`.
    residuals : mapping of str to (float, float)
        Joint → residual over torque in the second look's rows: with the identified values, and with its own.
    agrees : bool or None
        None: nothing was compared.
    reason : str
        Why there is no second look.
    explained : bool
        Whether both agree once the wrong facts that are named are corrected, or with the models that are advised.
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
            what = f"disagrees: {', '.join(apart)}" if apart else "explains far more"
            also = "; what the findings name explains it" if self.explained else ""
            return f"a plain filtered least squares {what}{also}"
        return (
            f"a plain filtered least squares agrees ({compared} of {len(self.parameters)} values)"
        )
