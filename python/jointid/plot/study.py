"""Plot of a study: a quantity over one or two swept settings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.argument_checks import require_kind
from jointid.base.error_text import alternatives
from jointid.base.errors import InputError
from jointid.joint.units import parameter_unit
from jointid.plot.appearance import MEASURED, axes_or_new, line_style, look
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
    ax: Axes | None = None,
    **style: Any,
) -> Axes:
    """Draw a quantity over one swept setting as points and a line, over two as a heat map.

    Parameters
    ----------
    study : Study
    x, y : str, optional
        Swept settings. Default: the first two; `y` none if only one is swept or `ax` is given.
        Trials of the other settings are combined.
    value : str
        A column of the study's table (``"penalty"``, a parameter, ``"tracking_after"``, …), or
        ``"error.NAME"``: a parameter's relative error [%]; ``"error.worst"``: the largest of them.
        Default ``"penalty"``.
    statistic : str
        "median" (default), "mean", "spread", "best" or "worst" of the trials; of an error, its
        magnitude.
    ax : Axes, optional
        Drawn into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the line, of `Axes.imshow` for the map, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Over one setting: the quantity over the setting. Over two: the settings, the quantity as
        colour and number.

    Raises
    ------
    InputError
        A setting that was not swept, an unknown quantity or statistic, an error without true values.

    Examples
    --------
    >>> jid.plot.sweep(study, "ga.population", value="sensor_gain")
    """
    require_kind("study", study, Study)
    if statistic not in STATISTICS:
        raise InputError(
            f"{alternatives(tuple(STATISTICS))} is expected", argument="statistic", value=statistic
        )
    if not study.swept:
        raise InputError("no setting was swept", argument="study")
    x = study.swept[0] if x is None else x
    if y is None and len(study.swept) > 1 and ax is None:
        y = next((name for name in study.swept if name != x), None)
    for argument, name in (("x", x), ("y", y)):
        if name is not None and name not in study.swept:
            raise InputError(
                f"not a swept setting; swept are {', '.join(study.swept)}",
                argument=argument,
                value=name,
            )
    values, title = _values(study, value)
    across = _labels(study, x)
    axes = axes_or_new(ax)
    if y is None:
        _line(axes, study, x, across, values, statistic, style)
        axes.set_ylabel(title)
        if _needs_log_scale(values):
            axes.set_yscale("log")
        return axes
    _heat_map(axes, study, (x, across), (y, _labels(study, y)), values, statistic, style)
    axes.set_title(f"{title}, {statistic} of the trials", fontsize="medium")
    return axes


def _values(study: Study, value: str) -> tuple[Array, str]:
    kind, _, name = value.partition(".")
    if kind != "error" or not name:
        column = study.column(value)
        if column.dtype.kind not in "fiu":
            raise InputError("a column of numbers is expected", argument="value", value=value)
        return column.astype(np.float64), _title(study, value)
    if name == "worst":
        known = sorted(set(study.truth_of(0)) & set(study.parameters))
        if not known:
            raise _no_truth(value)
        return np.max([_values(study, f"error.{n}")[0] for n in known], axis=0), "worst error [%]"
    found = study.column(name).astype(np.float64)
    truths = [study.truth_of(row.cell) for row in study.rows]
    if not all(name in truth for truth in truths):
        raise _no_truth(value, f"draw {name} itself")
    true = np.array([truth[name] for truth in truths])
    return 100.0 * np.abs(found / true - 1.0), f"error of {name} [%]"


def _no_truth(value: str, *remedies: str) -> InputError:
    return InputError(
        "the study has no true value, so there is no error",
        argument="value",
        value=value,
        remedy=("give the truth to the sweep", *remedies),
    )


def _title(study: Study, value: str) -> str:
    if value == "penalty":
        sensor = "sensor_gain" in study.parameters
        return "penalty [(sensor units·s)²]" if sensor else "penalty [(N·m·s)²]"
    if value in ("evaluations", "generations"):
        return f"{value} [–]"
    tracking = value.startswith("tracking_")
    unit = "rad" if tracking else parameter_unit(value.removesuffix("_stderr"))
    return f"{value} [{unit}]" if unit else value


def _labels(study: Study, name: str) -> list[Any]:
    return list(dict.fromkeys(cell[name] for cell in study.cells))


def _trials_with(study: Study, name: str, label: Any) -> NDArray[np.bool_]:
    return np.array([study.cells[row.cell][name] == label for row in study.rows])


def _statistic(statistic: str, values: Array) -> float:
    known = values[~np.isnan(values)]
    return float(STATISTICS[statistic](known)) if len(known) else np.nan


def _needs_log_scale(values: Array) -> bool:
    """Return whether the values are positive and span more than a factor of 20."""
    known = values[np.isfinite(values)]
    return len(known) > 0 and bool(known.min() > 0.0 and known.max() > 20.0 * known.min())


def _line(
    axes: Axes,
    study: Study,
    x: str,
    labels: list[Any],
    values: Array,
    statistic: str,
    style: Mapping[str, Any],
) -> None:
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in labels)
    places = labels if numbers else list(range(len(labels)))
    line = []
    for place, label in zip(places, labels, strict=True):
        trials = values[_trials_with(study, x, label)]
        axes.plot([place] * len(trials), trials, ".", color=MEASURED, markersize=4, zorder=1)
        line.append(_statistic(statistic, trials))
    # Settings that are not numbers have no scale: no line between them.
    ours = line_style(2) if numbers else line_style(2) | {"linestyle": "none"}
    axes.plot(places, line, **look(style, **ours, marker="o", markersize=5, label=statistic))
    if numbers and _needs_log_scale(np.array(labels, dtype=np.float64)):
        axes.set_xscale("log")
    if not numbers:
        axes.set_xticks(places, [str(label) for label in labels])
    axes.plot([], [], ".", color=MEASURED, label="single trial")
    axes.set_xlabel(x)
    axes.legend(loc="best", frameon=False)


def _heat_map(
    axes: Axes,
    study: Study,
    across: tuple[str, list[Any]],
    up: tuple[str, list[Any]],
    values: Array,
    statistic: str,
    style: Mapping[str, Any],
) -> None:
    from matplotlib.colors import LogNorm, Normalize

    (x, columns), (y, lines) = across, up
    table = np.array(
        [
            [
                _statistic(
                    statistic, values[_trials_with(study, y, line) & _trials_with(study, x, column)]
                )
                for column in columns
            ]
            for line in lines
        ]
    )
    known = table[np.isfinite(table)]
    low, high = (known.min(), known.max()) if len(known) else (0.0, 1.0)
    norm = LogNorm(low, high) if _needs_log_scale(table) else Normalize(low, high)
    ours = {"norm": norm, "cmap": "cividis_r", "aspect": "auto", "origin": "lower"}
    image = axes.imshow(table, **{**ours, **style})
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
