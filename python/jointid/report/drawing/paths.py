"""SVG path strings for places in whole tenths of a unit: short, exact, and in one notation."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Places = NDArray[np.int64]


def runs(shown: NDArray[np.bool_]) -> Iterator[slice]:
    """Yield the intervals of shown samples without a gap."""
    if shown.all():
        if len(shown):
            yield slice(0, len(shown))
        return
    edges = np.flatnonzero(np.diff(np.concatenate([[False], shown, [False]]).view(np.int8)))
    for start, stop in edges.reshape(-1, 2).tolist():
        yield slice(start, stop)


def line_path(across: Places, up: Places) -> str:
    """Return the path along these points. A single point is a dot."""
    steps = np.column_stack([np.diff(across), np.diff(up)])
    steps = steps[(steps != 0).any(axis=1)]
    start = f"M{across[0]} {up[0]}"
    return f"{start}l{_numbers(steps)}" if len(steps) else f"{start}h0"


def points_path(across: Places, up: Places) -> str:
    """Return a path of dots: lines of zero length with round ends, which scaling does not distort."""
    return ("M%d %dh0" * len(across)) % tuple(np.column_stack([across, up]).ravel().tolist())


def area_path(across: Places, low: Places, high: Places) -> str:
    """Return the path around the area between two lines."""
    there = np.concatenate([across, across[::-1]])
    return f"{line_path(there, np.concatenate([high, low[::-1]]))}z"


def bars_path(left: Places, right: Places, top: Places, foot: int) -> str:
    """Return the path around bars with a common base line."""
    bars = zip(left.tolist(), right.tolist(), top.tolist(), strict=True)
    return "".join(f"M{a} {foot}V{up}H{b}V{foot}z" for a, b, up in bars)


def _numbers(steps: Places) -> str:
    return ("%d " * steps.size) % tuple(steps.ravel().tolist())
