"""Distance of a session's signals from its limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from jointid.recording.recording import Recording

_UNITS = {
    "position": ("rad", "m"),
    "velocity": ("rad/s", "m/s"),
    "torque": ("N·m", "N"),
    "torque_rate": ("N·m/s", "N/s"),
    "tracking_error": ("rad", "m"),
}


def margin_rows(runs: Sequence[Recording]) -> list[list[str]]:
    """Return signal, largest value, limit and used share. The first row is the head; without limits it is alone."""
    rows = [["signal", "largest", "limit", "share of the limit"]]
    limits = runs[0].metadata.get("limits", {})
    slides = runs[0].kind == "prismatic"
    for name, units in _UNITS.items():
        limit = limits.get(name)
        reached = [_reached(run, name) for run in runs]
        if limit is None or any(each is None for each in reached):
            continue
        unit = units[slides]
        low, high = (min(r[0] for r in reached if r), max(r[1] for r in reached if r))
        if name == "position":
            share = _share_of_range(low, high, *limit)
            told = [f"{_figures(a)} to {_figures(b)} {unit}" for a, b in ((low, high), limit)]
        else:
            largest = max(-low, high)
            share = largest / limit
            told = [f"{_figures(each)} {unit}" for each in (largest, limit)]
        rows.append([name.replace("_", " "), *told, f"{100.0 * share:.0f} %"])
    return rows


def _share_of_range(low: float, high: float, least: float, most: float) -> float:
    """Return the used share of the distance from the middle of the range to its nearer end; 1 at the end."""
    middle, half = 0.5 * (least + most), 0.5 * (most - least)
    return max(middle - low, high - middle) / half


def _reached(run: Recording, name: str) -> tuple[float, float] | None:
    """Return the lowest and highest value of a signal; None if the recording lacks it."""
    values: Any = None
    if name == "tracking_error":
        values = None if run.reference is None else run.position - run.reference
    elif name == "torque_rate":
        values = None if run.torque is None else np.diff(run.torque) / np.diff(run.time)
    else:
        values = getattr(run, name)
    if values is None or not np.isfinite(values).any():
        return None
    return float(np.nanmin(values)), float(np.nanmax(values))


def _figures(value: float) -> str:
    return f"{value:.0f}" if 1e4 <= abs(value) < 1e9 else f"{value:.4g}"
