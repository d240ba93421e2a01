"""Values of many runs side by side: a frozen dataclass whose numbers are one value, or one for each run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PerRun = float | Array


@dataclass(frozen=True, kw_only=True)
class Columns:
    """Base of `Plant`, `Law` and `Log`: each field is a number for all runs, or an array (runs,)."""

    def spread(self, runs: int) -> Self:
        """The same with every field as an array of one value for each run."""
        arrays = {
            f.name: np.broadcast_to(np.asarray(getattr(self, f.name)), (runs,)).copy()
            for f in fields(self)
        }
        return replace(self, **arrays)

    def of(self, chosen: NDArray[np.intp]) -> Self:
        """These runs only, of a value that is spread."""
        return replace(self, **{f.name: getattr(self, f.name)[chosen] for f in fields(self)})

    def one(self, run: int) -> dict[str, Any]:
        """The fields of one run as plain values, of a value that is spread."""
        return {f.name: getattr(self, f.name)[run].item() for f in fields(self)}

    @classmethod
    def stack(cls, parts: Sequence[Self]) -> Self:
        """Runs of several spread values, one after the other."""
        names = [f.name for f in fields(cls)]
        return cls(**{n: np.concatenate([getattr(part, n) for part in parts]) for n in names})
