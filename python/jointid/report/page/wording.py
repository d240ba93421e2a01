"""Text of a table cell: value, error and unit together."""

from __future__ import annotations

import math

from jointid.base.result import Quantity
from jointid.estimate.wording import number, rounded, two_digits


def value_cell(quantity: Quantity) -> str:
    """Return a value with its standard error and unit: "1934 ± 72 N·m·s/rad"."""
    if quantity.value is None:
        return "–"
    error = quantity.error
    if error is None or error == 0.0:
        shown = number(quantity.value)
    elif not math.isfinite(error):
        shown = f"{number(quantity.value)} ± ∞"
    else:
        value, scatter = rounded(quantity.value, error), two_digits(error)
        if "e" in scatter and "e" not in value:
            scatter = f"{error:.{len(value.partition('.')[2])}f}"
        shown = f"{value} ± {scatter}"
    return f"{shown} {quantity.unit}".rstrip() if quantity.unit != "1" else shown
