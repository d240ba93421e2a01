"""Pictures of the page, as options of Apache ECharts: signals over time, and windows, linked."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.estimate import Estimate
from jointid.estimate.window_views import fitted_signal, map_velocities, whole_windows
from jointid.joint.units import torque_unit
from jointid.recording.recording import Recording
from jointid.recording.signals import shown_unit

Array = NDArray[np.float64]
Stretch = tuple[float, float]

_SHOWN = ("position", "velocity", "torque", "motor_torque", "current", "sensor")
_POINTS = 1200  # of a line; more are not seen
_TEXT = "#808080"  # readable on light and on dark ground
_LINE, _SECOND, _CHOSEN, _OUT = "#3b7dd8", "#d9822b", "#d6336c", "rgba(128,128,128,.35)"
_GRID = "rgba(128,128,128,.25)"
_HEIGHT = 120  # pixels of a signal's panel


def outlined(time: Array, values: Array, points: int = _POINTS) -> list[list[float]]:
    """Return a line's points, or of a long one the smallest and the largest value of each part, in their order."""
    if len(time) <= points:
        return _pairs(time, values)
    edges = np.linspace(0, len(time), points // 2 + 1).astype(int)
    chosen: list[int] = []
    for begin, end in itertools.pairwise(edges):
        part = values[begin:end]
        chosen += sorted({begin + int(part.argmin()), begin + int(part.argmax())})
    return _pairs(time[chosen], values[chosen])


def signals_height(recording: Recording) -> int:
    """Height of the picture of signals in pixels."""
    return _HEIGHT * len(_signals(recording)) + 70


def signals_options(recording: Recording, left_out: tuple[Stretch, ...]) -> dict[str, Any]:
    """Each signal over time, with what is left out in grey; a stretch can be brushed."""
    names = _signals(recording)
    limits = {"min": float(recording.time[0]), "max": float(recording.time[-1])}
    grey = {
        "silent": True,
        "itemStyle": {"color": _OUT},
        "data": [[{"xAxis": start}, {"xAxis": stop}] for start, stop in left_out],
    }
    last = len(names) - 1
    return {
        "animation": False,
        "textStyle": {"color": _TEXT},
        "tooltip": {"trigger": "axis"},
        "axisPointer": {"link": [{"xAxisIndex": "all"}]},
        "brush": {
            "xAxisIndex": "all",
            "brushLink": "all",
            "throttleType": "debounce",
            "throttleDelay": 100,
            "outOfBrush": {"colorAlpha": 1},
            "toolbox": [],
        },
        "grid": [
            {"left": 70, "right": 20, "top": 35 + _HEIGHT * k, "height": _HEIGHT - 30}
            for k in range(len(names))
        ],
        "xAxis": [
            {
                "type": "value",
                "gridIndex": k,
                **limits,
                "axisLabel": {"show": k == last, "color": _TEXT},
                "splitLine": {"lineStyle": {"color": _GRID}},
                **(
                    {"name": "time [s]", "nameLocation": "middle", "nameGap": 25}
                    if k == last
                    else {}
                ),
            }
            for k in range(len(names))
        ],
        "yAxis": [
            {
                "type": "value",
                "gridIndex": k,
                "scale": True,
                "splitNumber": 3,
                "name": f"{name} [{shown_unit(name, recording.kind)}]",
                "nameTextStyle": {"align": "left", "color": _TEXT},
                "axisLabel": {"color": _TEXT},
                "splitLine": {"lineStyle": {"color": _GRID}},
            }
            for k, name in enumerate(names)
        ],
        "series": [
            {
                "type": "line",
                "name": name,
                "xAxisIndex": k,
                "yAxisIndex": k,
                "showSymbol": False,
                "lineStyle": {"width": 1, "color": _LINE},
                "itemStyle": {"color": _LINE},
                "data": outlined(recording.time, getattr(recording, name)),
                "markArea": grey,
            }
            for k, name in enumerate(names)
        ],
    }


def estimate_options(estimate: Estimate, brushed: Stretch | None = None) -> dict[str, Any]:
    """Friction map and residuals; windows inside the brushed stretch stand out in both."""
    windows, kind = estimate.windows, str(estimate.settings["kind"])
    whole = whole_windows(windows)
    centre = 0.5 * (windows.start + windows.stop)
    inside = np.zeros(len(centre), dtype=bool)
    if brushed is not None:
        inside = (centre >= brushed[0]) & (centre <= brushed[1])
    curve = estimate.friction(map_velocities(float(np.abs(windows.velocity).max()), 100))
    residual = windows.residual / windows.duration
    unit = torque_unit(kind)
    rate = shown_unit("velocity", kind)
    rest = len(curve.velocity) // 2  # friction takes any value there: two curves
    curves = (slice(0, rest), slice(rest, None))
    return {
        "animation": False,
        "textStyle": {"color": _TEXT},
        "tooltip": {"trigger": "item"},
        "grid": [
            {"left": 70, "right": "55%", "top": 30, "bottom": 45},
            {"left": "55%", "right": 20, "top": 30, "bottom": 45},
        ],
        "xAxis": [
            _axis(0, f"velocity [{rate}]"),
            _axis(1, "time [s]"),
        ],
        "yAxis": [
            _upward(0, f"friction [{unit}]"),
            _upward(1, f"residual [{fitted_signal(estimate)[1]}]"),
        ],
        "series": [
            _points(
                0,
                "window",
                windows.velocity[whole & ~inside],
                windows.friction[whole & ~inside],
                _TEXT,
            ),
            _points(
                0,
                "brushed",
                windows.velocity[whole & inside],
                windows.friction[whole & inside],
                _CHOSEN,
            ),
            *(
                {
                    "type": "line",
                    "name": "identified",
                    "xAxisIndex": 0,
                    "yAxisIndex": 0,
                    "showSymbol": False,
                    "lineStyle": {"width": 2, "color": _LINE},
                    "data": _pairs(curve.velocity[part], curve.torque[part]),
                }
                for part in curves
            ),
            _points(1, "residual", centre[~inside], residual[~inside], _SECOND),
            _points(1, "brushed", centre[inside], residual[inside], _CHOSEN),
        ],
    }


def _signals(recording: Recording) -> list[str]:
    return [name for name in _SHOWN if getattr(recording, name) is not None]


def _axis(grid: int, name: str) -> dict[str, Any]:
    return {
        "type": "value",
        "gridIndex": grid,
        "scale": True,
        "name": name,
        "nameLocation": "middle",
        "nameGap": 28,
        "axisLabel": {"color": _TEXT},
        "splitLine": {"lineStyle": {"color": _GRID}},
    }


def _upward(grid: int, name: str) -> dict[str, Any]:
    return {
        "type": "value",
        "gridIndex": grid,
        "scale": True,
        "name": name,
        "nameTextStyle": {"align": "left", "color": _TEXT},
        "axisLabel": {"color": _TEXT},
        "splitLine": {"lineStyle": {"color": _GRID}},
    }


def _points(grid: int, name: str, across: Array, up: Array, colour: str) -> dict[str, Any]:
    return {
        "type": "scatter",
        "name": name,
        "xAxisIndex": grid,
        "yAxisIndex": grid,
        "symbolSize": 4,
        "itemStyle": {"color": colour},
        "data": _pairs(across, up),
    }


def _pairs(across: Array, up: Array) -> list[list[float]]:
    return [[round(float(x), 6), float(f"{y:.6g}")] for x, y in zip(across, up, strict=True)]
