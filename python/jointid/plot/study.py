"""Pictures of a study: a quantity over one or two swept settings."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.plot.appearance import MEASURED, given_or_new, line_style
from jointid.study.study_result import Study

if TYPE_CHECKING:
    from matplotlib.axes import Axes


Array = NDArray[np.float64]

STATISTICS: dict[str, Callable[[Array], Any]] = {
    "median": np.median,
    "mean": np.mean,
    "spread": lambda values: np.std(values, ddof=1) if len(values) > 1 else np.nan,
    "best": np.min,
    "worst": np.max,
}


def sweep(
    study: Study,
    x: str | None = None,
    y: str | None = None,
    value: str = "penalty",
    statistic: str = "median",
    axes: Axes | None = None,
) -> Axes:
    """Draw a quantity over one swept setting as points and a line, over two as a heat map.

    Parameters
    ----------
    study : Study
    x, y : str, optional
        Swept settings. Default: the first, and the second if there is one and it is not `x`. Trials of
        the other settings are taken together.
    value : str
        A column of the study's table (``"penalty"``, a parameter, ``"tracking_after"``, …), or
        ``"error.NAME"``: a parameter's relative error [%]; ``"error.worst"``: the largest of them.
        Default ``"penalty"``.
    statistic : str
        "median" (default), "mean", "spread", "best" or "worst" of the trials; for an error, of its size.
    axes : Axes, optional
        Drawn into; default: new ones.

    Raises
    ------
    InputError
        Something that the study has not swept, or does not hold.
    """
    require_kind("study", study, Study)
    if statistic not in STATISTICS:
        raise InputError(f"statistic '{statistic}' is not known; use {', '.join(STATISTICS)}")
    if not study.swept:
        raise InputError("the study has swept nothing, so there is nothing to draw it over")
    x = study.swept[0] if x is None else x
    if y is None and len(study.swept) > 1 and axes is None:
        y = next((name for name in study.swept if name != x), None)
    for name in (x, y):
        if name is not None and name not in study.swept:
            raise InputError(f"the study has not swept '{name}'; it has {', '.join(study.swept)}")
    values, title = _values(study, value)
    across = _labels(study, x)
    axes = given_or_new(axes)
    if y is None:
        _line(axes, study, x, across, values, statistic)
        axes.set_ylabel(title)
        if _wide(values):
            axes.set_yscale("log")
        return axes
    _map(axes, study, (x, across), (y, _labels(study, y)), values, statistic)
    axes.set_title(f"{title}, {statistic} of the trials", fontsize="medium")
    return axes


def _values(study: Study, value: str) -> tuple[Array, str]:
    kind, _, name = value.partition(".")
    if kind != "error" or not name:
        column = study.column(value)
        if column.dtype.kind not in "fiu":
            raise InputError(f"'{value}' is a column of texts; one of numbers can be drawn")
        return column.astype(np.float64), _title(study, value)
    if name == "worst":
        known = sorted(set(study.truth_of(0)) & set(study.parameters))
        if not known:
            raise InputError("the study knows no truth; give sweep(truth={...})")
        return np.max([_values(study, f"error.{n}")[0] for n in known], axis=0), "worst error [%]"
    found = study.column(name).astype(np.float64)
    try:
        true = np.array([study.truth_of(row.cell)[name] for row in study.rows])
    except KeyError:
        raise InputError(f"the study knows no truth of '{name}'; draw '{name}' itself") from None
    return 100.0 * np.abs(found / true - 1.0), f"error of {name} [%]"


def _title(study: Study, value: str) -> str:
    if value == "penalty":
        sensor = "sensor_gain" in study.parameters
        return "penalty [(sensor units·s)²]" if sensor else "penalty [(N·m·s)²]"
    units = {"evaluations": "[–]", "generations": "[–]"}
    units |= {shape.name: f"[{shape.unit}]" for shape in _core.shapes()}
    units |= {term.name: f"[{term.unit}]" for term in _core.terms()}
    base = value.removesuffix("_stderr")
    unit = "[rad]" if value.startswith("tracking_") else units.get(base, "")
    return f"{value} {unit}".strip()


def _labels(study: Study, name: str) -> list[Any]:
    return list(dict.fromkeys(cell[name] for cell in study.cells))


def _of(study: Study, name: str, label: Any) -> NDArray[np.bool_]:
    return np.array([study.cells[row.cell][name] == label for row in study.rows])


def _statistic(statistic: str, values: Array) -> float:
    known = values[~np.isnan(values)]
    return float(STATISTICS[statistic](known)) if len(known) else np.nan


def _wide(values: Array) -> bool:
    """Whether only a logarithm shows it all."""
    known = values[np.isfinite(values)]
    return len(known) > 0 and bool(known.min() > 0.0 and known.max() > 20.0 * known.min())


def _line(
    axes: Axes, study: Study, x: str, labels: list[Any], values: Array, statistic: str
) -> None:
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in labels)
    places = labels if numbers else list(range(len(labels)))
    line = []
    for place, label in zip(places, labels, strict=True):
        mine = values[_of(study, x, label)]
        axes.plot([place] * len(mine), mine, ".", color=MEASURED, markersize=4, zorder=1)
        line.append(_statistic(statistic, mine))
    # Between words there is nothing to draw a line through.
    look = line_style(2) if numbers else line_style(2) | {"linestyle": "none"}
    axes.plot(places, line, marker="o", markersize=5, label=statistic, **look)
    if numbers and _wide(np.array(labels, dtype=np.float64)):
        axes.set_xscale("log")
    if not numbers:
        axes.set_xticks(places, [str(label) for label in labels])
    axes.plot([], [], ".", color=MEASURED, label="a trial")
    axes.set_xlabel(x)
    axes.legend(loc="best", frameon=False)


def _map(
    axes: Axes,
    study: Study,
    across: tuple[str, list[Any]],
    up: tuple[str, list[Any]],
    values: Array,
    statistic: str,
) -> None:
    from matplotlib.colors import LogNorm, Normalize

    (x, columns), (y, lines) = across, up
    table = np.array(
        [
            [
                _statistic(statistic, values[_of(study, y, line) & _of(study, x, column)])
                for column in columns
            ]
            for line in lines
        ]
    )
    known = table[np.isfinite(table)]
    low, high = (known.min(), known.max()) if len(known) else (0.0, 1.0)
    norm = LogNorm(low, high) if _wide(table) else Normalize(low, high)
    image = axes.imshow(table, norm=norm, cmap="cividis_r", aspect="auto", origin="lower")
    for row, column in np.ndindex(table.shape):
        number = table[row, column]
        dark = np.isfinite(number) and float(norm(number)) > 0.55
        axes.text(
            column,
            row,
            f"{number:.3g}" if np.isfinite(number) else "–",
            ha="center",
            va="center",
            color="white" if dark else "black",
            fontsize=8,
        )
    axes.set_xticks(range(len(columns)), [str(label) for label in columns])
    axes.set_yticks(range(len(lines)), [str(label) for label in lines])
    axes.grid(visible=False)
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    bar = axes.figure.colorbar(image, ax=axes)
    bar.outline.set_visible(False)
