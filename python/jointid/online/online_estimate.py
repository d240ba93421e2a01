"""What an on-line identifier knows at one moment."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from jointid.estimate.statistics import ParameterEstimate
from jointid.joint.joint import Joint


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OnlineEstimate:
    """An estimate from the last seconds of a motion that goes on.

    Its intervals are of chance alone: how the values move with the choice of windows, and the checks of
    the signals, take `identify` on a recording.

    Attributes
    ----------
    parameters : mapping of str to ParameterEstimate
        By name; fixed ones too.
    undetermined : tuple of str
        Free parameters whose standard error exceeds 5 % of the value: the last seconds do not tell them.
    at_bound : tuple of str
        Parameters that a bound holds.
    begin, end : float
        What was used, on the samples' clock [s].
    windows : int
        Windows with motion.
    penalty : float
        Sum of squared window residuals, by the direct sum.
    joint : Joint
        With the values found, ready for a controller.
    update : int
        How many estimates there were, this one included.
    seconds : float
        What this update took [s].
    dropped : int
        Samples that came faster than they could be digested, and were left out so far.
    """

    parameters: Mapping[str, ParameterEstimate]
    undetermined: tuple[str, ...]
    at_bound: tuple[str, ...]
    begin: float
    end: float
    windows: int
    penalty: float
    joint: Joint
    update: int
    seconds: float
    dropped: int

    def __str__(self) -> str:
        lines = [f"{self.begin:.2f} to {self.end:.2f} s, {self.windows} windows"]
        for p in self.parameters.values():
            if p.vary:
                error = p.at_bound or ("?" if p.stderr is None else f"{p.stderr:.2g}")
                lines.append(f"  {p.name:<16} {p.value:12.5g} ± {error} {p.unit}")
        return "\n".join(lines)
