"""One trial of a study, as a row of the study's file and table."""

from __future__ import annotations

import math
import sys
from dataclasses import asdict, dataclass, field, fields
from typing import Any

from jointid.base.schema import Number, Plain, Record, TableOf, Text

REFUSED = "refused"


_LEAST = -sys.float_info.max


@dataclass(frozen=True, slots=True)
class _Measured:
    """A number that may be infinite or undefined: Infinity and NaN in a study's lines, "inf" and "nan" in its JSON."""

    def read(self, value: Any, place: str) -> float:
        """Return a float."""
        if isinstance(value, float) and (math.isnan(value) or value == math.inf):
            return value
        return float(Number(low=_LEAST, infinite=True, undefined=True).read(value, place))


_COUNT = Number(low=0, high=2**63 - 1, whole=True)
_ROW = Record(
    fields={
        **dict.fromkeys(("cell", "trial", "evaluations", "generations"), _COUNT),
        "seed": Number(low=0, high=2**65, whole=True),
        **dict.fromkeys(("status", "message"), Text(longest=1_000_000)),
        "penalty": _Measured(),
        "values": TableOf(Number()),
        **dict.fromkeys(("stderr", "tracking"), TableOf(_Measured())),
    },
    other=Plain(),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """The result of one identification, bit-identical in any process and with any number of threads.

    Attributes
    ----------
    cell, trial : int
        Index of the combination of settings, and index of the repetition.
    seed : int
        Seed of the search and of a simulation's noise. `identify` with this seed gives this row.
    status : str
        "converged", "stopped", or "refused" if these settings cannot be used here.
    message : str
        Reason for the end of the search, or for the refusal of the settings.
    penalty : float
        Penalty of the result; NaN if refused.
    evaluations, generations : int
        Numbers of candidates and of generations in the search.
    values, stderr : dict of str to float
        Parameters, and their standard errors if requested [SI].
    tracking : dict of str to float
        Root mean square of the tracking error [rad] with the scenario's parameters ("before"), the
        identified ones ("after"), and the true ones ("true"), if requested.
    """

    cell: int
    trial: int
    seed: int
    status: str
    message: str = ""
    penalty: float = math.nan
    evaluations: int = 0
    generations: int = 0
    values: dict[str, float] = field(default_factory=dict)
    stderr: dict[str, float] = field(default_factory=dict)
    tracking: dict[str, float] = field(default_factory=dict)

    @property
    def place(self) -> tuple[int, int]:
        """Cell and trial."""
        return self.cell, self.trial

    def asdict(self) -> dict[str, Any]:
        """Return the fields for a file. Numbers keep all their bits."""
        return asdict(self)

    @classmethod
    def of(cls, record: object) -> Row:
        """Return the row in a record.

        Parameters
        ----------
        record : object
            Record of JSON types. Unknown keys are ignored.

        Raises
        ------
        InputError
            The record is not a row.
        """
        known = _ROW.read(record, "")
        return cls(**{item.name: known[item.name] for item in fields(cls)})
