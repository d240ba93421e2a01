"""Summary of a study for a report page: share of successes, or the parameter that differs most."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from jointid.base.result import Overview, Quantity
from jointid.estimate.wording import percent
from jointid.study.summary import SHOWN, CellSummary, Summary, cell_name, error_of, varying

_LONGEST = 300  # characters of a setting
_FOR_PROGRAMS = ("version", "fingerprint")
_DEFAULTS = ("None", "False", "Model", "")


def overview_of(
    title: str, summary: Summary, settings: Mapping[str, Any], seeds: range, missing: int
) -> Overview:
    """Return the content of a study's report, from its title, its summary and the number of missing trials."""
    shown = summary.best(SHOWN).cells
    names = varying(shown)
    unfinished = f"The study is not finished: {_trials(missing)} missing."
    return Overview(
        title=title,
        footer=f"jointid {settings.get('version', '')}, seeds {seeds[0]} to {seeds[-1]}",
        answer=(*_answer(summary), *([unfinished] if missing > 0 else [])),
        parameters=tuple(
            _quantity(cell, name) for cell in shown for name in names if name in cell.mean
        ),
        settings=_settings(settings),
    )


def _quantity(cell: CellSummary, name: str) -> Quantity:
    bias = cell.bias.get(name, math.nan)
    return Quantity(
        name=f"{cell_name(cell.labels)}: {name}" if cell.labels else name,
        value=cell.mean[name],
        error=error_of(cell, name),
        meaning="mean over the trials",
        remark="" if math.isnan(bias) else f"{100.0 * bias:+.2f} % of the truth",
    )


def _answer(summary: Summary) -> list[str]:
    """Return the share of successes, the best and the worst cell; without a truth, the most variable parameter."""
    cells = [cell for cell in summary.cells if cell.trials]
    if not cells:
        return ["No trial has finished."]
    known = [(cell.success, cell) for cell in cells if cell.success is not None]
    lines = []
    if known:
        trials = sum(cell.trials for _, cell in known)
        share = sum(success * cell.trials for success, cell in known) / trials
        within = f"{100.0 * summary.within:g} %"
        lines.append(
            f"Every parameter is within {within} of the truth in {percent(share)} of the trials."
        )
        least, most = (choose(known, key=lambda each: each[0]) for choose in (min, max))
        if least[0] != most[0]:
            lines.append(
                f"This share is largest with {cell_name(most[1].labels)} ({percent(most[0])}), and smallest with "
                f"{cell_name(least[1].labels)} ({percent(least[0])})."
            )
    else:
        lines += [_moves_most(cells), "The true values are not known, so errors are not shown."]
    refused = sum(cell.refused for cell in cells)
    if refused:
        first = next(cell for cell in cells if cell.refused)
        lines.append(f"{_trials(refused)} refused, the first because {first.reason}.")
    return lines


def _trials(count: int) -> str:
    return "1 trial is" if count == 1 else f"{count} trials are"


def _moves_most(cells: Sequence[CellSummary]) -> str:
    """Return the parameter that differs most between the cells, or between the trials of a single cell."""
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


def _settings(settings: Mapping[str, object]) -> tuple[tuple[str, str], ...]:
    """Return the common settings of all trials, without defaults."""
    rows = []
    for name, value in settings.items():
        text = "" if name in _FOR_PROGRAMS else _setting(value)
        if text:
            cut = f"{text[:_LONGEST]}…" if len(text) > _LONGEST else text
            rows.append((name.replace("_", " "), cut))
    return tuple(rows)


def _setting(value: object) -> str:
    if isinstance(value, Mapping):
        if set(value) == {"name", "fingerprint"}:
            return f"{value['name'] or 'recording'} ({value['fingerprint']})"
        inner = {name: _setting(each) for name, each in value.items()}
        return ", ".join(f"{name.replace('_', ' ')} {each}" for name, each in inner.items() if each)
    if isinstance(value, list | tuple):
        return "; ".join(filter(None, map(_setting, value)))
    text = "yes" if value in (True, "True") else str(value)
    # A joint and a search are stored as their Python representation.
    text = text.partition(", parameters={")[0].strip("()").replace("'", "")
    return "" if text in _DEFAULTS else text
