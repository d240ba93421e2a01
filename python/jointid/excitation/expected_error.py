"""The error that a motion lets one expect of an identified parameter."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class ExpectedError:
    """How well one parameter will be identified from one recording of a motion, and of what is known already.

    Attributes
    ----------
    name, unit : str
    value : float
        Of the nominal joint [unit].
    stderr : float
        Standard error to expect there [unit]; infinite where the motion does not determine the parameter.
    relative : float
        `stderr` over the parameter's size.
    worst : float
        Largest relative one over the joints that the motion was judged with.
    before : float, optional
        Standard error of what is known without this motion [unit]; infinite where nothing determines the
        parameter. Default None: nothing was said to be known.
    """

    name: str
    unit: str
    value: float
    stderr: float
    relative: float
    worst: float
    before: float | None = None
