"""Parameters as a data frame."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from jointid.base.frames import data_frame
from jointid.estimate.derived import DerivedValue, derived_values
from jointid.estimate.record import EstimateRecord
from jointid.estimate.statistics import ParameterEstimate

if TYPE_CHECKING:
    import pandas as pd


def parameter_frame(estimate: EstimateRecord) -> pd.DataFrame:
    """Return one row for each parameter and derived quantity: see `Estimate.to_pandas`."""
    return data_frame(estimate_rows(estimate), index="name")


def estimate_rows(estimate: EstimateRecord) -> list[dict[str, Any]]:
    """Return one record per parameter and derived quantity."""
    return parameter_rows((*estimate.parameters.values(), *derived_values(estimate).values()))


def parameter_rows(
    parameters: Iterable[ParameterEstimate | DerivedValue],
) -> list[dict[str, Any]]:
    """Return one record per parameter, with the columns of `Estimate.to_pandas`."""
    return [_row(p) for p in parameters]


def _row(p: ParameterEstimate | DerivedValue) -> dict[str, Any]:
    low, high = p.interval or (None, None)
    row = {name: getattr(p, name, None) for name in ("name", "value", "stderr")}
    row |= {"systematic": p.systematic_total, "low": low, "high": high}
    return row | {
        name: getattr(p, name, None)
        for name in ("min", "max", "vary", "at_bound", "unit", "meaning")
    }
