"""Pictures of the prediction of held-out motion by each compared model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from jointid.panels.marks import Picture
from jointid.panels.rows import NamedRow, rows_panel

if TYPE_CHECKING:
    from jointid.comparison.result import Comparison
    from jointid.comparison.row import ComparedModel
    from jointid.robot.result.comparison_result import RobotComparison
    from jointid.robot.result.comparison_row import ComparedRobotModel
    from jointid.servo.comparison_result import ServoComparison

_DRAWN = 20  # number of drawn rows; the table has all
_PARTS = "A grey point is one held-out part; the stroke is the mean with its standard error."


def held_out(comparison: Comparison) -> Picture:
    """Return the relative residual of each model on held-out motion."""
    rows = [_row(row.model, row, row.model == comparison.winner) for row in comparison.rows]
    caption = (
        f"Relative residual on motion that was not used for the fit: smaller is better. {_PARTS}"
    )
    return _picture(rows, caption, "model", "mean of the chosen model")


def held_out_robot(comparison: RobotComparison) -> Picture:
    """Return the relative residual of each candidate on held-out torque, as a mean over the robot's joints."""
    rows = [_row(row.name, row, row == comparison.winner) for row in comparison.rows]
    caption = (
        "Relative residual on torque that was not used for the fit, mean over joints: smaller is better. "
        f"{_PARTS}"
    )
    return _picture(rows, caption, "candidate", "mean of the chosen model")


def held_out_servo(comparison: ServoComparison) -> Picture:
    """Return the error of each model's closed loop on held-out runs of a servo."""
    rows = [
        NamedRow(name=name, value=median, single=errors, chosen=name == comparison.best)
        for name, median, errors in zip(
            comparison.models,
            np.degrees(comparison.medians).tolist(),
            np.degrees(comparison.errors),
            strict=True,
        )
    ]
    panel = rows_panel(
        rows[:_DRAWN],
        "mean error of the position [deg]",
        "model",
        ("one run", "median", "median of the best model"),
    )
    caption = (
        "Error of the closed loop, simulated with values that were fitted to other runs: smaller is better. "
        "A grey point is one run; the stroke is the median."
    )
    return Picture(caption=caption + _first_of(rows, "model"), panels=(panel,))


def _row(name: str, row: ComparedModel | ComparedRobotModel, chosen: bool) -> NamedRow:
    return NamedRow(
        name=name,
        value=100.0 * row.score,
        error=100.0 * row.stderr,
        single=[100.0 * score for score in row.fold_scores],
        chosen=chosen,
    )


def _picture(rows: Sequence[NamedRow], caption: str, what: str, chosen: str) -> Picture:
    labels = ("one part", "mean", chosen)
    panel = rows_panel(rows[:_DRAWN], "held-out residual [%]", what, labels)
    return Picture(caption=caption + _first_of(rows, what), panels=(panel,))


def _first_of(rows: Sequence[NamedRow], what: str) -> str:
    """Return the caption's note if not all rows are drawn."""
    return f" The first {_DRAWN} of {len(rows)} {what}s." if len(rows) > _DRAWN else ""
