"""Pictures of the page, as options of Apache ECharts: signals over time, and linked pictures of windows."""

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
_POINTS = 1200  # points of a line; more are not visible
# Variables of the style sheet: the drawings are SVG and adapt when light changes to dark.
_TEXT, _MEASURED, _LINE, _SECOND = "var(--ink)", "var(--measured)", "var(--second)", "var(--fourth)"
_CHOSEN, _OUT, _GRID = "var(--fitted)", "var(--measured)", "var(--grid)"
_TOOLTIP = {
    "backgroundColor": "var(--well)",
    "borderColor": "var(--muted)",
    "textStyle": {"color": _TEXT},
}
_HEIGHT = 120  # pixels of a signal's panel


def outlined(time: Array, values: Array, points: int = _POINTS) -> list[list[float]]:
    """Return a line's points. For a long line, return the minimum and the maximum of each part, in order."""
    if len(time) <= points:
        return _pairs(time, values)
    edges = np.linspace(0, len(time), points // 2 + 1).astype(int)
    chosen: list[int] = []
    for begin, end in itertools.pairwise(edges):
        part = values[begin:end]
        chosen += sorted({begin + int(part.argmin()), begin + int(part.argmax())})
    return _pairs(time[chosen], values[chosen])


def signals_height(recording: Recording) -> int:
    """Return the height of the picture of signals in pixels."""
    return _HEIGHT * len(_signals(recording)) + 70


def signals_options(recording: Recording, left_out: tuple[Stretch, ...]) -> dict[str, Any]:
    """Return each signal over time, with excluded stretches in grey. A stretch can be selected."""
    names = _signals(recording)
    limits = {"min": float(recording.time[0]), "max": float(recording.time[-1])}
    grey = {
        "silent": True,
        "itemStyle": {"color": _OUT, "opacity": 0.35},
        "data": [[{"xAxis": start}, {"xAxis": stop}] for start, stop in left_out],
    }
    last = len(names) - 1
    even = float(f"{limits['max']:.3g}") == limits["max"]  # the label is short
    return {
        "animation": False,
        "textStyle": {"color": _TEXT},
        "tooltip": {"trigger": "axis", **_TOOLTIP},
        "toolbox": {"show": False},
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
                "axisLabel": {"show": k == last, "color": _TEXT, "showMaxLabel": even},
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


def signals_text(recording: Recording) -> str:
    """Return the picture of signals in words."""
    spans = ", ".join(
        f"{name} from {_span(getattr(recording, name))} {shown_unit(name, recording.kind)}"
        for name in _signals(recording)
    )
    return f"Signals over {_span(recording.time)} s: {spans}"


def friction_options(estimate: Estimate, brushed: Stretch | None = None) -> dict[str, Any]:
    """Return the friction map. Windows in the selected stretch are highlighted."""
    windows, kind = estimate.windows, str(estimate.settings["kind"])
    whole = whole_windows(windows)
    inside = _inside(_centre(estimate), brushed)
    curve = estimate.friction(map_velocities(float(np.abs(windows.velocity).max()), 100))
    rest = len(curve.velocity) // 2  # friction can have any value at rest, so there are two curves
    return _picture(
        f"velocity [{shown_unit('velocity', kind)}]",
        f"friction [{torque_unit(kind)}]",
        [
            *(
                _points(
                    name, windows.velocity[whole & some], windows.friction[whole & some], colour
                )
                for name, some, colour in (
                    ("window", ~inside, _MEASURED),
                    ("chosen window", inside, _CHOSEN),
                )
            ),
            *(
                {
                    "type": "line",
                    "name": "identified",
                    "showSymbol": False,
                    "lineStyle": {"width": 2, "color": _LINE},
                    "data": _pairs(curve.velocity[part], curve.torque[part]),
                }
                for part in (slice(0, rest), slice(rest, None))
            ),
        ],
    )


def friction_text(estimate: Estimate) -> str:
    """Return the friction map in words."""
    windows, kind = estimate.windows, str(estimate.settings["kind"])
    curve = estimate.friction(map_velocities(float(np.abs(windows.velocity).max()), 100))
    return (
        f"Friction map: {len(windows.velocity)} windows and the identified line, "
        f"{_span(curve.torque)} {torque_unit(kind)} at velocities of {_span(curve.velocity)} "
        f"{shown_unit('velocity', kind)}"
    )


def residual_options(estimate: Estimate, brushed: Stretch | None = None) -> dict[str, Any]:
    """Return the residuals over time. Windows in the selected stretch are highlighted."""
    centre, residual = _centre(estimate), _residual(estimate)
    inside = _inside(centre, brushed)
    return _picture(
        "time [s]",
        f"residual [{fitted_signal(estimate)[1]}]",
        [
            _points("residual", centre[~inside], residual[~inside], _SECOND),
            _points("chosen window", centre[inside], residual[inside], _CHOSEN),
        ],
    )


def residual_text(estimate: Estimate) -> str:
    """Return the residuals in words."""
    residual = _residual(estimate)
    unit = fitted_signal(estimate)[1]
    root_mean_square = float(np.sqrt(np.mean(residual**2)))
    return (
        f"Residuals over time: root mean square {root_mean_square:.3g} {unit}, "
        f"{_span(residual)} {unit}"
    )


def _centre(estimate: Estimate) -> Array:
    return np.asarray(0.5 * (estimate.windows.start + estimate.windows.stop))


def _residual(estimate: Estimate) -> Array:
    return np.asarray(estimate.windows.residual / estimate.windows.duration)


def _inside(centre: Array, brushed: Stretch | None) -> NDArray[np.bool_]:
    if brushed is None:
        return np.zeros(len(centre), dtype=bool)
    return (centre >= brushed[0]) & (centre <= brushed[1])


def _span(values: Array) -> str:
    return f"{float(np.min(values)):.4g} to {float(np.max(values)):.4g}"


def _picture(across: str, up: str, series: list[dict[str, Any]]) -> dict[str, Any]:
    return {
        "animation": False,
        "textStyle": {"color": _TEXT},
        "tooltip": {"trigger": "item", **_TOOLTIP},
        "grid": {"left": 70, "right": 20, "top": 30, "bottom": 45},
        "xAxis": {**_axis(across), "nameLocation": "middle", "nameGap": 28},
        "yAxis": {**_axis(up), "nameTextStyle": {"align": "left", "color": _TEXT}},
        "series": series,
    }


def _signals(recording: Recording) -> list[str]:
    return [name for name in _SHOWN if getattr(recording, name) is not None]


def _axis(name: str) -> dict[str, Any]:
    return {
        "type": "value",
        "scale": True,
        "name": name,
        "nameTextStyle": {"color": _TEXT},
        "axisLabel": {"color": _TEXT, "hideOverlap": True},
        "axisLine": {"onZero": False, "lineStyle": {"color": _GRID}},
        "splitLine": {"lineStyle": {"color": _GRID}},
    }


def _points(name: str, across: Array, up: Array, colour: str) -> dict[str, Any]:
    return {
        "type": "scatter",
        "name": name,
        "symbolSize": 4,
        "itemStyle": {"color": colour},
        "data": _pairs(across, up),
    }


def _pairs(across: Array, up: Array) -> list[list[float]]:
    return [[round(float(x), 6), float(f"{y:.6g}")] for x, y in zip(across, up, strict=True)]
