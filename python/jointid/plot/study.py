"""Plot of a study: a quantity over one or two swept settings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.argument_checks import require_kind
from jointid.base.error_text import alternatives
from jointid.base.errors import InputError
from jointid.panels.marks import Line
from jointid.panels.study import STATISTICS, over_setting, quantity, spans_decades, statistic_of
from jointid.plot.appearance import axes_or_new
from jointid.plot.drawing import draw, of_kind
from jointid.study.study_result import Study

if TYPE_CHECKING:
    from matplotlib.axes import Axes


Array = NDArray[np.float64]


def sweep(
    study: Study,
    x: str | None = None,
    y: str | None = None,
    value: str = "penalty",
    statistic: str = "median",
    ax: Axes | None = None,
    **style: Any,
) -> Axes:
    """Draw a quantity over one swept setting as points and a line, or over two settings as a heat map.

    Instead of a heat map, a report draws one line for each value of the second setting.

    Parameters
    ----------
    study : Study
    x, y : str, optional
        Swept settings of the horizontal and vertical axis. Default: the first two; `y` is None if only one setting
        is swept or `ax` is set. Trials of the other settings are combined.
    value : str
        Drawn quantity: a column of the study's table (``"penalty"``, a parameter, ``"tracking_after"``, …).
        ``"error.NAME"``: a parameter's relative error [%]. ``"error.worst"``: the largest of these errors [%].
        Default ``"penalty"``.
    statistic : str
        Statistic of the trials: "median" (default), "mean", "spread", "best" or "worst". The statistic of an error
        uses the error's magnitude.
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the line or of `Axes.imshow` for the map, e.g. ``color="black"``.

    Returns
    -------
    Axes
        For one setting: the quantity over the setting, with one row per value if the values are not numbers. For
        two settings: the settings on the axes, and the quantity as colour and number.

    Raises
    ------
    InputError
        A setting was not swept, a quantity or statistic is unknown, or an error is requested without true values.

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
                f"this setting is not swept; the swept settings are {', '.join(study.swept)}",
                argument=argument,
                value=name,
            )
    values, title = quantity(study, value)
    axes = axes_or_new(ax)
    if y is None:
        panel = over_setting(study, x, values, title, statistic=statistic, combined=True)
        return draw(axes, panel, style, of_kind(panel, Line))
    _heat_map(axes, study, (x, _labels(study, x)), (y, _labels(study, y)), values, statistic, style)
    axes.set_title(f"{title}, {statistic} of the trials", fontsize="medium")
    return axes


def _labels(study: Study, name: str) -> list[Any]:
    return list(dict.fromkeys(cell[name] for cell in study.cells))


def _trials_with(study: Study, name: str, label: Any) -> NDArray[np.bool_]:
    return np.array([study.cells[row.cell][name] == label for row in study.rows])


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
                statistic_of(
                    statistic, values[_trials_with(study, y, line) & _trials_with(study, x, column)]
                )
                for column in columns
            ]
            for line in lines
        ]
    )
    known = table[np.isfinite(table)]
    low, high = (known.min(), known.max()) if len(known) else (0.0, 1.0)
    norm = LogNorm(low, high) if spans_decades(table) else Normalize(low, high)
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
