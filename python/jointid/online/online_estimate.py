"""An estimate of the on-line identifier."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from jointid.estimate.statistics import ParameterEstimate
from jointid.joint.joint import Joint


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OnlineEstimate:
    """An estimate from the last seconds of a motion that continues.

    Its intervals contain random errors only. `identify` on a recording also checks the signals, and
    includes the effect of the choice of windows.

    Attributes
    ----------
    parameters : mapping of str to ParameterEstimate
        By name; fixed ones too.
    undetermined : tuple of str
        Free parameters whose standard error exceeds 5 % of the value: the last seconds do not determine
        them.
    at_bound : tuple of str
        Parameters that a bound holds.
    begin, end : float
        First and last instant of the samples used, on their clock [s].
    windows : int
        Number of integration windows with motion.
    penalty : float
        Sum of squared window residuals, by the direct sum.
    joint : Joint
        With the estimated values, ready for a controller.
    update : int
        Number of estimates so far, this one included.
    seconds : float
        Computing time of this update [s].
    dropped : int
        Number of samples that arrived faster than they could be processed and were left out so far.

    Examples
    --------
    >>> with jid.OnlineIdentifier(joint, window=5.0) as identifier:
    ...     for block in recording.split(24):
    ...         identifier.feed(time=block.time, position=block.position, velocity=block.velocity,
    ...                         torque=block.torque, sensor=block.sensor)
    ...     found = identifier.wait()
    >>> isinstance(found, jid.OnlineEstimate)
    True
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
