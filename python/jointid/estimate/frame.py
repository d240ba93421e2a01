"""An estimate's parameters as a data frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from jointid.base.frames import data_frame
from jointid.estimate.derived import DerivedValue, derived_values
from jointid.estimate.record import EstimateRecord
from jointid.estimate.statistics import ParameterEstimate

if TYPE_CHECKING:
    import pandas as pd


def parameter_frame(estimate: EstimateRecord) -> pd.DataFrame:
    """Return one row for each parameter and derived quantity: see `Estimate.to_pandas`."""
    rows = [_row(p) for p in estimate.parameters.values()]
    rows += [_row(each) for each in derived_values(estimate).values()]
    return data_frame(rows, index="name")


def _row(p: ParameterEstimate | DerivedValue) -> dict[str, Any]:
    low, high = p.interval or (None, None)
    row = {name: getattr(p, name, None) for name in ("name", "value", "stderr")}
    row |= {"systematic": p.systematic_total, "low": low, "high": high}
    return row | {
        name: getattr(p, name, None)
        for name in ("min", "max", "vary", "at_bound", "unit", "meaning")
    }
