"""The result of a block bootstrap: scatter of the values over draws of stretches of the recording."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.error_text import printable
from jointid.base.json_layout import json_types
from jointid.base.result import Overview, Quantity, Result
from jointid.base.text_table import aligned
from jointid.base.values import dataclass
from jointid.estimate.wording import number, percent, two_digits

Array = NDArray[np.float64]

_LONGEST_NAME = 40  # characters in a table


@dataclass(frozen=True, slots=True, kw_only=True)
class BootstrapParameter:
    """One parameter over the draws.

    Attributes
    ----------
    name, unit : str
    value : float
        Value of the estimate.
    stderr : float
        Standard error: half of the range of the middle 68.3 % of the draws. A few draws that lack a direction of
        motion do not affect it.
    interval : tuple of float
        95 % interval: value ± t · stderr, or percentiles of the draws if `near_bound`.
    ratio : float or None
        `stderr` over the estimate's random error; None if the estimate has none.
    near_bound : bool
        Whether a bound is within three standard errors, or at least 1 % of the draws end on a bound.
    """

    name: str
    unit: str
    value: float
    stderr: float
    interval: tuple[float, float]
    ratio: float | None
    near_bound: bool


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Bootstrap(Result):
    """A block bootstrap of an estimate.

    Attributes
    ----------
    parameters : mapping of str to BootstrapParameter
        Free parameters, in the order of the torque balance.
    samples : ndarray, shape (n, p)
        Refitted values of each draw, one column for each of `parameters`.
    block : float
        Length of a block [s].
    blocks : int
        Number of blocks per draw.
    seed : int

    Examples
    --------
    >>> drawn = estimate.bootstrap(50)
    >>> len(drawn.samples), sorted(drawn.parameters)[0]
    (50, 'coulomb')
    """

    parameters: Mapping[str, BootstrapParameter]
    samples: Array = field(repr=False)
    block: float
    blocks: int
    seed: int

    _KIND = "bootstrap"

    def __repr__(self) -> str:
        errors = ", ".join(f"{name}=±{p.stderr:.2g}" for name, p in self.parameters.items())
        return f"Bootstrap({errors}; {len(self.samples)} draws of {self.blocks} blocks)"

    @property
    def overview(self) -> Overview:
        """Return the summary that a report page shows."""
        return Overview(
            title="block bootstrap: errors of the values",
            answer=(self._drawn,),
            parameters=tuple(
                Quantity(
                    name=p.name,
                    value=p.value,
                    error=p.stderr,
                    unit=p.unit,
                    meaning=f"95 % interval {p.interval[0]:.5g} … {p.interval[1]:.5g}",
                    remark="" if p.ratio is None else f"{p.ratio:.2f} of the reported error",
                )
                for p in self.parameters.values()
            ),
            settings=(("draws", str(len(self.samples))), ("seed", str(self.seed))),
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the content of `report` in JSON's types, without the samples."""
        document: dict[str, Any] = json_types(
            {
                "parameters": {name: asdict(p) for name, p in self.parameters.items()},
                "draws": len(self.samples),
                "blocks": self.blocks,
                "block": self.block,
                "seed": self.seed,
            }
        )
        return document

    document = to_dict

    def report(self, *, verbose: bool = False) -> str:
        """Return the bootstrap as text: errors, intervals and the ratio to the estimate's errors.

        Parameters
        ----------
        verbose : bool
            No effect: the report is always complete.
        """
        del verbose
        table = [("parameter", "value", "± bootstrap", "95 % interval", "unit", "of reported")]
        for p in self.parameters.values():
            share = f" ({percent(p.stderr / abs(p.value))})" if p.value else ""
            remark = "–" if p.ratio is None else f"{p.ratio:.2f}"
            interval = f"{p.interval[0]:.5g} … {p.interval[1]:.5g}"
            interval += " (percentiles)" if p.near_bound else ""
            error = f"{two_digits(p.stderr)}{share}"
            table.append((_short(p.name), number(p.value), error, interval, p.unit, remark))
        lines = aligned(table)
        return printable("\n".join([*lines, "", f"{self._drawn}, seed {self.seed}"]))

    @property
    def _drawn(self) -> str:
        return f"{len(self.samples)} draws of {self.blocks} blocks of {self.block:.2g} s"


def _short(name: str) -> str:
    """Return a name short enough for the table; a base parameter of a robot is a long sum."""
    return name if len(name) <= _LONGEST_NAME else f"{name[: _LONGEST_NAME - 1]}…"
