"""Pictures of a study: a quantity of its trials over the swept settings."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.joint.units import parameter_unit
from jointid.panels.marks import Line, Mark, Panel, Picture, Points
from jointid.panels.rows import NamedRow, rows_panel
from jointid.study.summary import cell_name

if TYPE_CHECKING:
    from jointid.study.study_result import Study

Array = NDArray[np.float64]

_DRAWN = 20  # number of drawn rows; the table has all
_LINES = ("fitted", "second", "third", "fourth", "fifth")
_WIDE_RANGE = 20.0  # ratio of positive values above which an axis is logarithmic

STATISTICS: dict[str, Callable[[Array], Any]] = {
    "median": np.median,
    "mean": np.mean,
    "spread": lambda values: np.std(values, ddof=1) if len(values) > 1 else np.nan,
    "best": np.min,
    "worst": np.max,
}
"""Statistic of a cell's trials that is drawn."""


def study_pictures(study: Study) -> tuple[Picture, ...]:
    """Return pictures of each trial's largest error (without a truth: its penalty) and of the tracking error."""
    drawn = {"penalty": "The penalty"}
    if np.isfinite(_worst_errors(study)).any():
        drawn = {"error.worst": "The largest relative error of all parameters"}
    if any("after" in row.tracking for row in study.rows):
        drawn["tracking_after"] = "The tracking error with the identified parameters"
    return tuple(_picture(study, value, shown) for value, shown in drawn.items())


def _picture(study: Study, value: str, shown: str) -> Picture:
    values, title = quantity(study, value)
    panel = over_setting(study, study.swept[0] if study.swept else "", values, title)
    mark = "stroke" if panel.names else "line"
    said = f"{shown}; a grey point is one trial, the {mark} is the median."
    if panel.names and len(study.cells) > _DRAWN:
        said += f" The first {_DRAWN} of {len(study.cells)} cells."
    return Picture(caption=said, panels=(panel,))


def over_setting(
    study: Study,
    setting: str,
    values: Array,
    title: str,
    *,
    statistic: str = "median",
    combined: bool = False,
) -> Panel:
    """Return a quantity over a numeric setting, as points and lines; otherwise one row per cell.

    Parameters
    ----------
    study : Study
    setting : str
        A swept setting; "" if there is none.
    values : ndarray, shape (rows,)
        Values of the quantity for the trials.
    title : str
        Name and unit of the quantity.
    statistic : str
        A key of `STATISTICS`. Default "median".
    combined : bool
        Whether to combine cells that differ only in other settings. Default False: a line or a row for each.
    """
    places = [cell.get(setting) for cell in study.cells]
    numeric = all(isinstance(each, int | float) and not isinstance(each, bool) for each in places)
    others = [
        "" if combined else cell_name({k: v for k, v in cell.items() if k != setting})
        for cell in study.cells
    ]
    if numeric and len(set(places)) > 1 and len(set(others)) <= len(_LINES):
        return _lines(
            study, str(setting), np.array(places, float), others, values, title, statistic
        )
    names = [
        cell_name({setting: cell[setting]} if combined and setting else cell) or "all trials"
        for cell in study.cells
    ]
    rows = [
        NamedRow(name=name, value=statistic_of(statistic, trials), single=trials)
        for name in list(dict.fromkeys(names))[:_DRAWN]
        for trials in (values[_trials_of(study, names, name)],)
    ]
    labels = ("one trial", statistic, "")
    return rows_panel(rows, title, "cell", labels, logarithmic=spans_decades(values))


def _lines(
    study: Study,
    setting: str,
    places: Array,
    others: list[str],
    values: Array,
    title: str,
    statistic: str,
) -> Panel:
    cells = np.array([row.cell for row in study.rows], dtype=np.int64)
    marks: list[Mark] = [
        Points(look="measured", label="one trial", across=places[cells], up=values)
    ]
    names = list(dict.fromkeys(others))
    for look, name in zip(_LINES, names, strict=False):
        mine = _trials_of(study, others, name)
        across = np.unique(places[[number for number, each in enumerate(others) if each == name]])
        up = [statistic_of(statistic, values[mine & (places[cells] == place)]) for place in across]
        marks.append(
            Line(look=look, label=name or statistic, across=across, up=up, series=len(names) > 1)
        )
    return Panel(
        across=setting,
        up=title,
        marks=tuple(marks),
        logarithmic=spans_decades(values),
        logarithmic_across=spans_decades(places),
    )


def _trials_of(study: Study, names: list[str], name: str) -> NDArray[np.bool_]:
    """Return which trials belong to the cells with a name."""
    return np.array([names[row.cell] == name for row in study.rows], dtype=bool)


def quantity(study: Study, value: str) -> tuple[Array, str]:
    """Return a quantity of each trial, and its name with its unit.

    Parameters
    ----------
    study : Study
    value : str
        A numeric column; "error.NAME", a parameter's relative error [%]; "error.worst", the largest error.

    Raises
    ------
    InputError
        The quantity does not exist, or an error is requested without true values.
    """
    kind, _, name = value.partition(".")
    if kind != "error" or not name:
        column = study.column(value)
        if column.dtype.kind not in "fiu":
            raise InputError("a column of numbers is expected", argument="value", value=value)
        return column.astype(np.float64), _title(study, value)
    if name == "worst":
        worst = _worst_errors(study)
        if not np.isfinite(worst).any():
            raise _no_truth(value)
        return worst, "largest error [%]"
    found = study.column(name).astype(np.float64)
    truths = [study.truth_of(row.cell) for row in study.rows]
    if not all(name in truth for truth in truths):
        raise _no_truth(value, f"draw {name} itself")
    true = np.array([truth[name] for truth in truths])
    return 100.0 * np.abs(found / true - 1.0), f"error of {name} [%]"


def _worst_errors(study: Study) -> Array:
    """Return the largest relative error of each trial [%]; NaN without a truth."""
    worst = []
    for row in study.rows:
        errors = [
            abs(row.values[name] / true - 1.0)
            for name, true in study.truth_of(row.cell).items()
            if true and name in row.values
        ]
        worst.append(100.0 * max(errors, default=math.nan))
    return np.array(worst)


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
    if value.startswith("tracking_"):
        return f"tracking error {value.removeprefix('tracking_')} [rad]"
    unit = parameter_unit(value.removesuffix("_stderr"))
    return f"{value} [{unit}]" if unit else value


def statistic_of(statistic: str, values: Array) -> float:
    """Return a statistic of the trials that have a value; NaN without any."""
    known = values[np.isfinite(values)]
    return float(STATISTICS[statistic](known)) if len(known) else math.nan


def spans_decades(values: Array) -> bool:
    """Return whether values are positive and span more than a factor of 20."""
    known = values[np.isfinite(values)]
    return bool(known.size and 0.0 < known.min() * _WIDE_RANGE < known.max())
