"""The expected error of an identified parameter."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class ExpectedError:
    """Expected error of one parameter, from one recording of a motion and from prior information.

    Attributes
    ----------
    name, unit : str
    value : float
        Value of the nominal joint [unit].
    stderr : float
        Expected standard error for the nominal joint [unit]; infinite if the motion does not determine the
        parameter.
    relative : float
        `stderr` divided by the parameter's size.
    worst : float
        Largest relative error over the joints with which the motion was evaluated.
    before : float, optional
        Standard error without this motion [unit]; infinite if nothing determines the parameter. Default None:
        no prior information.
    """

    name: str
    unit: str
    value: float
    stderr: float
    relative: float
    worst: float
    before: float | None = None
