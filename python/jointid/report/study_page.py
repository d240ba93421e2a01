"""The report of a study: how often the truth was found, or what moves most; then each cell."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.html import Html, element, page, table
from jointid.estimate.wording import percent
from jointid.report.answering import answer
from jointid.report.drawing.marks import Line, Mark, Panel, Points
from jointid.report.figure import captioned
from jointid.report.rows import NamedRow, rows_panel
from jointid.report.style import STYLE, WIDE
from jointid.study.study_result import Study
from jointid.study.summary import CellSummary, Summary, cell_name, html_summary

Array = NDArray[np.float64]

_DRAWN = 20  # cells as rows; the table has all
_LINES = ("fitted", "second", "third", "fourth", "fifth")
_WIDE_RANGE = 20.0  # of positive values, above which the axis is logarithmic
_SHOWN_SETTING = 300  # letters
_FOR_PROGRAMS = ("version", "fingerprint")
_DEFAULTS = ("None", "False", "Model", "")


def study_report(study: Study) -> str:
    """The report as one HTML page that needs no other file.

    Parameters
    ----------
    study : Study
    """
    summary = study.summary()
    title = f"jointid {study.title}"
    body: list[Html | str] = [element("h1", title), *_answer(study, summary)]
    for values, shown, caption in _quantities(study):
        body.append(_picture(study, values, shown, caption))
    body += [
        element("h2", "Each cell", id="cells"),
        element("div", html_summary(summary), class_="wide"),
        element("p", _meaning(summary)),
        element("h2", "Settings", id="settings"),
        table(_settings(study), class_="facts"),
        element(
            "footer",
            f"jointid {study.settings.get('version', '')}, seeds {study.seed} to "
            f"{study.seed + max(study.trials, 1) - 1}",
        ),
    ]
    return page(title, f"{STYLE}{WIDE}", *body)


def _answer(study: Study, summary: Summary) -> list[Html]:
    """How often the truth was found and where most and least often; without a truth, what moves most."""
    cells = [cell for cell in summary.cells if cell.trials]
    if not cells:
        return [answer("No trial is done.")]
    lines = []
    known = [cell for cell in cells if cell.success is not None]
    within = f"{100.0 * summary.within:g} %"
    if known:
        trials = sum(cell.trials for cell in known)
        share = sum((cell.success or 0.0) * cell.trials for cell in known) / trials
        lines.append(
            answer(
                f"Every parameter is within {within} of the truth in {percent(share)} of the trials."
            )
        )
        least = min(known, key=lambda cell: cell.success or 0.0)
        most = max(known, key=lambda cell: cell.success or 0.0)
        if len(known) > 1 and least.success != most.success:
            lines.append(
                element(
                    "p",
                    f"Most often with {cell_name(most.labels)} ({percent(most.success or 0.0)}), least often with "
                    f"{cell_name(least.labels)} ({percent(least.success or 0.0)}).",
                )
            )
    else:
        lines.append(answer(_moves_most(cells)))
        lines.append(element("p", "The true values are not known, so errors are not shown."))
    refused = sum(cell.refused for cell in cells)
    if refused:
        first = next(cell for cell in cells if cell.refused)
        lines.append(
            element("p", f"{_trials(refused)} refused, the first one because {first.reason}.")
        )
    if not study.complete:
        missing = len(study.cells) * study.trials - len(study.rows)
        lines.append(element("p", f"The study is not finished: {_trials(missing)} missing."))
    return lines


def _trials(count: int) -> str:
    return "1 trial is" if count == 1 else f"{count} trials are"


def _moves_most(cells: Sequence[CellSummary]) -> str:
    """Which parameter differs most between the cells, or between the trials of the only one."""
    moved: dict[str, float] = {}
    for name in {name: None for cell in cells for name in cell.mean}:
        means = [cell.mean[name] for cell in cells if name in cell.mean]
        scatter = max((cell.spread[name] for cell in cells if name in cell.spread), default=0.0)
        size = max(map(abs, means))
        if size > 0.0:
            between = max(means) - min(means)
            moved[name] = (between if len(cells) > 1 else scatter) / size
    moved = {name: share for name, share in moved.items() if math.isfinite(share)}
    if not moved:
        return "Nothing was identified."
    name = max(moved, key=lambda each: moved[each])
    where = "from cell to cell" if len(cells) > 1 else "from trial to trial"
    if moved[name] < 1e-12:
        return f"No value changes {where}."
    how = "differs most" if len(cells) > 1 else "scatters most"
    return f"{name} {how} {where}: by {percent(moved[name])} of its value."


def _quantities(study: Study) -> list[tuple[Array, str, str]]:
    """What is drawn: the largest error of each trial where the truth is known, else the penalty; tracking."""
    found = []
    worst = np.array([_worst_error(study, number) for number in range(len(study.rows))])
    if np.isfinite(worst).any():
        found.append((worst, "largest error [%]", "The largest relative error of all parameters"))
    else:
        penalty = np.array([row.penalty for row in study.rows])
        found.append((penalty, "penalty", "The penalty"))
    after = np.array([row.tracking.get("after", math.nan) for row in study.rows])
    if np.isfinite(after).any():
        caption = "The tracking error with the identified parameters"
        found.append((after, "tracking error [rad]", caption))
    return found


def _worst_error(study: Study, number: int) -> float:
    """Largest relative error of a trial [%]; NaN without a truth."""
    row = study.rows[number]
    errors = [
        abs(row.values[name] / true - 1.0)
        for name, true in study.truth_of(row.cell).items()
        if true and name in row.values
    ]
    return 100.0 * max(errors, default=math.nan)


def _picture(study: Study, values: Array, shown: str, caption: str) -> Html:
    """A line over the first setting where it is a number, else a row for each cell."""
    cells = np.array([row.cell for row in study.rows], dtype=np.int64)
    first = [cell[study.swept[0]] for cell in study.cells] if study.swept else []
    numeric = all(isinstance(each, int | float) and not isinstance(each, bool) for each in first)
    others = [cell_name({name: cell[name] for name in study.swept[1:]}) for cell in study.cells]
    lines = list(dict.fromkeys(others))
    several = numeric and len(set(first)) > 2 and len(lines) <= len(_LINES)
    said = f"{caption}; a grey point is one trial, the {'line' if several else 'stroke'} is the median."
    if several:
        places = np.array(first, dtype=np.float64)
        return captioned(said, _lines(study, values, shown, cells, places, others))
    rows = [
        NamedRow(
            name=cell_name(cell) or "all trials",
            value=_median(values[cells == number]),
            single=values[cells == number],
        )
        for number, cell in enumerate(study.cells[:_DRAWN])
    ]
    if len(study.cells) > _DRAWN:
        said += f" The first {_DRAWN} of {len(study.cells)} cells."
    return captioned(said, rows_panel(rows, shown, "cell", ("one trial", "median", "")))


def _lines(
    study: Study,
    values: Array,
    shown: str,
    cells: NDArray[np.int64],
    places: Array,
    others: list[str],
) -> Panel:
    marks: list[Mark] = [
        Points(look="measured", label="one trial", across=places[cells], up=values)
    ]
    for look, name in zip(_LINES, dict.fromkeys(others), strict=False):
        mine = [number for number, other in enumerate(others) if other == name]
        mine.sort(key=lambda number: places[number])
        medians = [_median(values[cells == number]) for number in mine]
        marks.append(Line(look=look, label=name or "median", across=places[mine], up=medians))
    known = values[np.isfinite(values)]
    wide = known.size > 0 and 0.0 < known.min() * _WIDE_RANGE < known.max()
    return Panel(across=study.swept[0], up=shown, marks=tuple(marks), logarithmic=bool(wide))


def _median(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else math.nan


def _meaning(summary: Summary) -> str:
    """What the table's numbers are."""
    if any(cell.bias for cell in summary.cells):
        return "Parameters: mean error ± standard deviation over the trials [% of the truth]."
    return "Parameters: mean ± standard deviation over the trials."


def _settings(study: Study) -> list[list[Html | str]]:
    """What all trials have in common; what was left at its default is not told."""
    rows: list[list[Html | str]] = []
    for name, value in study.settings.items():
        text = "" if name in _FOR_PROGRAMS else _setting(value)
        if text:
            cut = f"{text[:_SHOWN_SETTING]}…" if len(text) > _SHOWN_SETTING else text
            rows.append([name.replace("_", " "), cut])
    return rows


def _setting(value: object) -> str:
    if isinstance(value, Mapping):
        if set(value) == {"name", "fingerprint"}:
            return f"{value['name'] or 'recording'} ({value['fingerprint']})"
        told = {name: _setting(each) for name, each in value.items()}
        return ", ".join(f"{name.replace('_', ' ')} {each}" for name, each in told.items() if each)
    if isinstance(value, list | tuple):
        return "; ".join(filter(None, map(_setting, value)))
    text = "yes" if value in (True, "True") else str(value)
    # Of a joint and of a search, which are kept as Python writes them.
    text = text.partition(", parameters={")[0].strip("()").replace("'", "")
    return "" if text in _DEFAULTS else text
