"""An estimate of the online identifier."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from jointid.base.json_layout import json_types
from jointid.base.result import Overview, Result
from jointid.estimate.statistics import ParameterEstimate
from jointid.joint.joint import Joint

_PLAIN = (
    *("undetermined", "at_bound", "begin", "end", "windows", "penalty", "update", "seconds"),
    "dropped",
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OnlineEstimate(Result):
    """Estimate from the last seconds of a continuing motion.

    The intervals contain random errors only. `identify` with a recording also checks the signals. Its intervals
    include the effect of the choice of windows.

    Attributes
    ----------
    parameters : mapping of str to ParameterEstimate
        Parameters by name, including fixed parameters.
    undetermined : tuple of str
        Free parameters that the last seconds do not determine: standard error above 5 % of the value.
    at_bound : tuple of str
        Parameters that ended on a bound.
    begin, end : float
        Time of the first and last sample used [s].
    windows : int
        Number of integration windows with motion.
    penalty : float
        Sum of squared window residuals, computed directly from the residuals.
    joint : Joint
        Joint with the estimated values, ready for a controller.
    update : int
        Number of estimates so far, including this one.
    seconds : float
        Computing time of this update [s].
    dropped : int
        Number of samples left out so far, because they arrived too fast.

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

    _KIND = "online"

    @property
    def overview(self) -> Overview:
        """Return the summary that a report page shows."""
        from jointid.estimate.overview import quantity_of

        unknown = ", ".join(self.undetermined)
        does = f"do not determine {unknown}" if unknown else "determine all free parameters"
        return Overview(
            title=f"{self.joint.name or 'joint'}: friction, online",
            answer=(f"The last seconds {does}.",),
            parameters=tuple(map(quantity_of, self.parameters.values())),
            fit=(("penalty", f"{self.penalty:.4g}"),),
            facts=(
                ("time", f"{self.begin:.2f} to {self.end:.2f} s"),
                ("windows", str(self.windows)),
                ("update", f"number {self.update}, computed in {1e3 * self.seconds:.2g} ms"),
                ("samples left out", str(self.dropped)),
            ),
        )

    def to_dict(self) -> dict[str, Any]:
        """Return all attributes except the joint in JSON's types; a number that is not finite becomes a text."""
        return dict(
            json_types(
                {
                    "parameters": {name: asdict(p) for name, p in self.parameters.items()},
                    **{name: getattr(self, name) for name in _PLAIN},
                }
            )
        )

    def report(self, *, verbose: bool = False) -> str:
        """Return the values of the free parameters as text.

        Parameters
        ----------
        verbose : bool
            Whether to add the fixed and the undetermined parameters. Default False.
        """
        lines = [str(self)]
        if verbose:
            lines += [
                f"  {p.name:<16} {p.value:12.5g} {p.unit} (fixed)"
                for p in self.parameters.values()
                if not p.vary
            ]
            lines += [f"  not determined: {name}" for name in self.undetermined]
        return "\n".join(lines)

    def __str__(self) -> str:
        lines = [f"{self.begin:.2f} to {self.end:.2f} s, {self.windows} windows"]
        for p in self.parameters.values():
            if p.vary:
                error = p.at_bound or ("?" if p.stderr is None else f"{p.stderr:.2g}")
                lines.append(f"  {p.name:<16} {p.value:12.5g} ± {error} {p.unit}")
        return "\n".join(lines)
