"""Likely units of columns that an error message proposes, judged by their values."""

from __future__ import annotations

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.signals import header_unit
from jointid.recording.stamp_units import unit_of_stamps
from jointid.recording.table import Table
from jointid.recording.units import UNITS, likely_unit


def unit_by_values(table: Table, index: int, signal: str, kind: str) -> str:
    """Return the likely unit of a column: SI, unless another unit makes the values plausible; empty if unknown."""
    if signal == "time":
        return _unit_of_time(table, index)
    usual = header_unit(signal, kind)
    if kind != "revolute":
        return usual
    try:
        (values,) = table.numbers([index])
    except InputError:  # a later message names the text
        return usual
    return likely_unit(signal, float(np.nanmax(np.abs(values), initial=0.0))) or usual


def _unit_of_time(table: Table, index: int) -> str:
    """Return the likely unit of a proposed time column; empty if a later message asks for it."""
    try:
        (stamps,) = table.numbers([index])
    except InputError:  # dates, or text: no unit is needed
        return "s"
    if not len(stamps):
        return "s"
    try:
        with np.errstate(all="ignore"):
            unit = unit_of_stamps(float(stamps[0]), stamps - stamps[0], "")
    except InputError as error:  # prefer ms to s; other pairs are equally likely
        calls = [each.arguments for each in error.remedy if isinstance(each, Action)]
        units = [str(call["units"]["time"]) for call in calls if "units" in call]
        return units[0] if len(units) == 1 or "s" in units else ""
    return "s" if unit is None else unit.name if unit.name in UNITS else ""
