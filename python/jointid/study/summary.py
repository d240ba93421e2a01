"""Summary of a study: a table of mean, spread, bias and success, one line per cell."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from jointid.base.error_text import printable
from jointid.base.errors import InputError
from jointid.base.frames import data_frame
from jointid.base.html import Html, element, table
from jointid.estimate.wording import rounded, two_digits
from jointid.study.row import REFUSED, Row

if TYPE_CHECKING:
    import pandas as pd


SHOWN = 10  # cells in a text
_ALIKE = 1e-4  # relative difference of searches that found the same minimum


@dataclass(frozen=True, slots=True, kw_only=True)
class CellSummary:
    """Statistics of a cell's trials.

    Attributes
    ----------
    labels : dict
        Labels of the swept settings.
    trials, refused : int
        Number of finished trials, and number of refused trials among them.
    reason : str
        Reason for the first refusal; empty without one.
    converged : float
        Share of the trials with the status "converged".
    penalty : float
        Median penalty of the trials.
    mean, spread : dict of str to float
        Mean and standard deviation of each parameter over the trials [SI].
    stderr : dict of str to float
        Median standard error of each parameter [SI]; empty if not computed.
    bias, scatter : dict of str to float
        Mean error and spread, relative to the truth; empty if the truth is unknown.
    success : float or None
        Share of all trials, including refused ones, with every parameter within the relative error of the
        truth. None if the truth is unknown.
    tracking : dict of str to float
        Medians of the tracking errors [rad].
    """

    labels: dict[str, Any]
    trials: int
    refused: int
    reason: str
    converged: float
    penalty: float
    mean: dict[str, float]
    spread: dict[str, float]
    stderr: dict[str, float]
    bias: dict[str, float]
    scatter: dict[str, float]
    success: float | None
    tracking: dict[str, float]

    @property
    def differ(self) -> bool:
        """Whether the trials differ by more than converged searches do."""
        return any(self.spread[name] > _ALIKE * abs(mean) for name, mean in self.mean.items())


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """Statistics of a study's cells; `print` shows a table.

    Attributes
    ----------
    cells : tuple of CellSummary
    within : float
        Largest relative error of a successful trial.
    """

    cells: tuple[CellSummary, ...]
    within: float

    def asdict(self) -> dict[str, Any]:
        """Return the summary for JSON: None for values that are not finite or unknown."""
        cells = [{n: _known(v) for n, v in _record(cell).items()} for cell in self.cells]
        return {"within": self.within, "cells": cells}

    def to_pandas(self) -> pd.DataFrame:
        """Return one row per cell; columns `NAME_mean`, `NAME_spread`, `NAME_bias`, `NAME_scatter` per parameter.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        return data_frame([_record(cell) for cell in self.cells])

    def __str__(self) -> str:
        return self.text(SHOWN)

    def text(self, most: int) -> str:
        """Return the table with at most this number of cells, the best ones, as text."""
        header, body = summary_texts(self.best(most))
        widths = [max(len(line[i]) for line in [header, *body]) for i in range(len(header))]
        lines = [
            "  ".join(text.rjust(width) for text, width in zip(line, widths, strict=True))
            for line in [header, *body]
        ]
        if len(self.cells) > most:
            lines.append(
                f"the best {most} of {len(self.cells)} cells; to_pandas() and --table have all cells"
            )
        lines += summary_notes(self)
        return printable("\n".join(line.rstrip() for line in lines))

    def best(self, count: int) -> Summary:
        """Return the cells with the most successes or, if the truth is unknown, with the smallest penalties."""
        if len(self.cells) <= count:
            return self
        ordered = sorted(self.cells, key=lambda each: (-(each.success or 0.0), each.penalty))
        return replace(self, cells=tuple(ordered[:count]))

    def to_html(self) -> str:
        """Return the printed table as HTML for a notebook."""
        return str(html_summary(self))


def html_summary(summary: Summary) -> Html:
    """Return the table of the cells with its notes."""
    header, body = summary_texts(summary)
    notes = (element("p", each) for each in summary_notes(summary))
    return element(
        "div", table([list(line) for line in body], head=header, class_="joints"), *notes
    )


def summarise(
    cells: Sequence[dict[str, Any]],
    truths: Sequence[Mapping[str, float]],
    rows: Sequence[Row],
    within: float,
) -> Summary:
    """Summarise each cell, with the true parameters in it; see `Study.summary`.

    Raises
    ------
    InputError
        `within` is not positive.
    """
    if isinstance(within, bool) or not isinstance(within, int | float) or not within > 0.0:
        raise InputError(
            "a share above 0, such as 0.05, is expected", argument="within", value=within
        )
    mine: list[list[Row]] = [[] for _ in cells]
    for row in rows:
        mine[row.cell].append(row)
    each = zip(cells, truths, mine, strict=True)
    return Summary(cells=tuple(_cell(*one, within) for one in each), within=float(within))


def _cell(
    labels: dict[str, Any], truth: Mapping[str, float], rows: Sequence[Row], within: float
) -> CellSummary:
    done = [row for row in rows if row.status != REFUSED]
    values = {
        name: np.array([row.values[name] for row in done])
        for name in (done[0].values if done else ())
    }
    true = {n: v for n, v in truth.items() if n in values and v != 0.0}
    ratios = {name: values[name] / value - 1.0 for name, value in true.items()}
    near = [np.abs(ratio) <= within for ratio in ratios.values()]
    tracking = {
        name: float(np.median([row.tracking[name] for row in done]))
        for name in (done[0].tracking if done else ())
    }
    return CellSummary(
        labels=labels,
        trials=len(rows),
        refused=len(rows) - len(done),
        reason=next((row.message for row in rows if row.status == REFUSED), ""),
        converged=_share([row.status == "converged" for row in rows]),
        penalty=float(np.median([row.penalty for row in done])) if done else math.nan,
        mean={name: _mean(v) for name, v in values.items()},
        spread={name: _deviation(v) for name, v in values.items()},
        stderr={
            name: float(np.median([row.stderr[name] for row in done if name in row.stderr]))
            for name in values
            if any(name in row.stderr for row in done)
        },
        bias={name: _mean(r) for name, r in ratios.items()},
        scatter={name: _deviation(r) for name, r in ratios.items()},
        success=float(np.all(near, axis=0).sum()) / len(rows) if near else None,
        tracking=tracking,
    )


def _known(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _share(flags: Sequence[bool]) -> float:
    return sum(flags) / len(flags) if flags else math.nan


def _mean(values: np.ndarray[Any, np.dtype[np.float64]]) -> float:
    """Return the mean. For equal values, return exactly that value, because a mean may round it."""
    return float(values[0] if np.ptp(values) == 0.0 else values.mean())


def _deviation(values: np.ndarray[Any, np.dtype[np.float64]]) -> float:
    if len(values) < 2:
        return math.nan
    return 0.0 if np.ptp(values) == 0.0 else float(values.std(ddof=1))


def _record(cell: CellSummary) -> dict[str, Any]:
    record: dict[str, Any] = dict(cell.labels)
    for name in ("trials", "refused", "converged", "penalty", "success"):
        record[name] = getattr(cell, name)
    for kind in ("mean", "spread", "stderr", "bias", "scatter"):
        record |= {f"{name}_{kind}": value for name, value in getattr(cell, kind).items()}
    return record | {f"tracking_{name}": value for name, value in cell.tracking.items()}


def summary_texts(summary: Summary) -> tuple[list[str], list[list[str]]]:
    """Return header and lines. A parameter is bias ± scatter [%] with a known truth, otherwise value ± error."""
    cells = summary.cells
    swept = list(cells[0].labels) if cells else []
    names = varying(cells)
    success = any(cell.success is not None for cell in cells)
    tracking = list(dict.fromkeys(name for cell in cells for name in cell.tracking))
    header = [*swept, "trials", "converged", "penalty"]
    header += [f"within {100.0 * summary.within:g} %"] if success else []
    header += [f"{name} [%]" if any(name in c.bias for c in cells) else name for name in names]
    header += [f"tracking {name} [rad]" for name in tracking]
    body = []
    for cell in cells:
        line = [str(label) for label in cell.labels.values()]
        line += [str(cell.trials), _percent(cell.converged), f"{cell.penalty:.4g}"]
        line += [_percent(cell.success)] if success else []
        line += [_parameter(cell, name) for name in names]
        line += [f"{cell.tracking.get(name, math.nan):.3g}" for name in tracking]
        body.append(line)
    return header, body


def _names(cells: Sequence[CellSummary]) -> list[str]:
    return list(dict.fromkeys(name for cell in cells for name in cell.mean))


def varying(cells: Sequence[CellSummary]) -> list[str]:
    """Return the parameters that the table shows: all, if none varies."""
    names = _names(cells)
    return [name for name in names if not _fixed(cells, name)] or names


def summary_notes(summary: Summary) -> list[str]:
    """Return notes about refused trials in each cell, and about parameters that the table does not show."""
    lines = [
        f"{cell_name(cell.labels) or 'all'}: {cell.refused} refused: {cell.reason}"
        for cell in summary.cells
        if cell.refused
    ]
    return [*lines, *([left] if (left := _left_out(summary)) else [])]


def cell_name(labels: Mapping[str, Any]) -> str:
    """Return the swept settings of a cell as text."""
    return ", ".join(f"{name} {label}" for name, label in labels.items())


def _left_out(summary: Summary) -> str:
    """Return a line with the parameters that the table does not show."""
    shown = varying(summary.cells)
    left_out = [name for name in _names(summary.cells) if name not in shown]
    return f"not shown: {', '.join(left_out)} (same in all cells)" if left_out else ""


def _fixed(cells: Sequence[CellSummary], name: str) -> bool:
    """Return whether a parameter has the same value in all cells, except for rounding."""
    means = [cell.mean[name] for cell in cells if name in cell.mean]
    alike = max(means) - min(means) <= 1e-12 * abs(means[0])
    return alike and not any(cell.spread.get(name, 0.0) > 0.0 for cell in cells)


def _parameter(cell: CellSummary, name: str) -> str:
    if name in cell.bias:
        return f"{100.0 * cell.bias[name]:+.2f}" + _after(100.0 * cell.scatter[name], ".2f")
    if name not in cell.mean:
        return ""
    error = error_of(cell, name)
    if error is None:
        return f"{cell.mean[name]:.4g}"
    return f"{rounded(cell.mean[name], error)} ± {two_digits(error)}"


def error_of(cell: CellSummary, name: str) -> float | None:
    """Return the error of a parameter's mean; None without one."""
    # The spread of trials with the same minimum is rounding, not an error.
    error = max(cell.stderr.get(name, 0.0), cell.spread.get(name, 0.0) if cell.differ else 0.0)
    return error if 0.0 < error < math.inf else None


def _after(spread: float, form: str) -> str:
    """Return the spread after a value. It is empty if unknown, with a single trial, or if it rounds to zero."""
    text = f"{spread:{form}}"
    return f" ± {text}" if float(text) > 0.0 else ""


def _percent(share: float | None) -> str:
    return "" if share is None or math.isnan(share) else f"{100.0 * share:.0f} %"
