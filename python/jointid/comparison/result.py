"""The result of a comparison of models: a row for each model, the winner, and the reason."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from textwrap import wrap
from typing import TYPE_CHECKING, Any

from jointid.base.advice import Action
from jointid.base.error_text import printable
from jointid.base.frames import data_frame
from jointid.base.values import dataclass
from jointid.estimate.answers import COLUMNS, findings, purposes
from jointid.estimate.estimate import Estimate
from jointid.estimate.settings import residual_text
from jointid.estimate.wording import percent_with_error
from jointid.joint.model import Model

if TYPE_CHECKING:
    import pandas as pd

SCHEMA = 1
"""Increased when a reader of the earlier format would misread the new one."""

_PLAIN = (
    *("model", "parameters", "score", "stderr", "fold_scores", "penalty", "eligible", "reason"),
)
_SHOWN = 6  # models in an answer
HEAD = ("model", "parameters", "held-out residual", "± std. error", "penalty", "remark")


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedModel:
    """One row of a comparison.

    Attributes
    ----------
    model : str
        The model's text, e.g. "coulomb_viscous:asymmetric".
    spec : Model
    parameters : int
        Free parameters, shape parameters included.
    score : float
        Relative residual of held-out windows, mean over the folds.
    stderr : float
        Its standard error over the folds.
    fold_scores : tuple of float
    penalty : float
        Of the fit to all data [unit of a window integral, squared].
    eligible : bool
        Whether the data support the model; otherwise it cannot win.
    reason : str
        Why it wins or does not win.
    """

    model: str
    spec: Model
    parameters: int
    score: float
    stderr: float
    fold_scores: tuple[float, ...]
    penalty: float
    eligible: bool
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Comparison:
    """The result of `compare_models`.

    Attributes
    ----------
    rows : tuple of ComparedModel
        In the order of the call.
    winner : str
        Text of the winning model.
    reason : str
        Why it won, in a sentence.
    estimate : Estimate
        The winner fitted to all data.
    settings : mapping
        Folds, what each held out ("held_out"), windows, method, residual, and the models that were not
        compared with the reason for each ("left_out").

    Examples
    --------
    >>> comparison = jid.compare_models(recording, joint, models=["coulomb_viscous", "stribeck"], folds=3)
    >>> comparison.winner
    'stribeck'
    """

    rows: tuple[ComparedModel, ...]
    winner: str
    reason: str
    estimate: Estimate
    settings: Mapping[str, Any]

    def __repr__(self) -> str:
        scores = ", ".join(f"{row.model} {100.0 * row.score:.3g} %" for row in self.rows)
        return f"Comparison({scores}; winner {self.winner})"

    def report(
        self, action: Callable[[Action], str] = str, saved: str = "", *, verbose: bool = False
    ) -> str:
        """Return the comparison as text: the winner, a line for each model, the winner's verdict and findings.

        Parameters
        ----------
        action : callable
            Words an action. Default: as at a Python prompt.
        saved : str
            The file that has the winner's estimate. Default: there is none.
        verbose : bool
            Everything: penalties, folds, what was not compared. Default False.
        """
        if verbose:
            return self._whole()
        first = f"{self._title()}: {self.winner} predicts held-out motion best"
        lines = [first if len(first) <= COLUMNS else f"{self.winner} predicts held-out motion best"]
        shown = sorted(self.rows, key=lambda each: each.score)[:_SHOWN]
        scores = [percent_with_error(row.score, row.stderr) for row in shown]
        names, size = max(len(row.model) for row in shown), max(map(len, scores))
        for row, score in zip(shown, scores, strict=True):
            line = f"  {row.model.ljust(names)}  {score.rjust(size)}  {row.reason}"
            lines += wrap(line, COLUMNS, subsequent_indent="      ")
        if len(self.rows) > _SHOWN:
            lines.append(f"  and {len(self.rows) - _SHOWN} more models")
        verdict = self.estimate.verdict
        lines += [f"{self.winner}: {verdict.level}", *purposes(verdict)]
        lines += findings(self.estimate.findings, action, most=1, saved=saved)
        return printable("\n".join(lines))

    def _whole(self) -> str:
        table = [HEAD, *self.cells()]
        widths = [max(len(row[column]) for row in table) for column in range(len(HEAD))]
        lines = [f"jointid comparison — {self._title()}", ""]
        for index, row in enumerate(table):
            cells = [
                cell.rjust(width) if 0 < column < 5 and index else cell.ljust(width)
                for column, (cell, width) in enumerate(zip(row, widths, strict=True))
            ]
            lines.append("  ".join(cells).rstrip())
            if index == 0:
                lines.append("  ".join("-" * width for width in widths))
        lines += ["", self.setting()]
        lines += [
            f"not compared: {model}: {reason}"
            for model, reason in self.settings["left_out"].items()
        ]
        return printable("\n".join([*lines, f"winner: {self.winner}", self.reason, *self._said()]))

    def _repr_html_(self) -> str:
        from html import escape

        head = "".join(f"<th>{escape(cell)}</th>" for cell in HEAD)
        body = ""
        for row, cells in zip(self.rows, self.cells(), strict=True):
            tag = "th" if row.model == self.winner else "td"
            body += f"<tr><{tag}>{escape(cells[0])}</{tag}>"
            body += "".join(f"<td>{escape(cell)}</td>" for cell in cells[1:]) + "</tr>"
        table = (
            f"<table class='jointid'><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
        )
        said = (self.setting(), self.reason, *self._said())
        text = "".join(f"<p>{escape(each)}</p>" for each in said)
        return f"<div><b>jointid comparison — {escape(self._title())}</b>{table}{text}</div>"

    def to_pandas(self) -> pd.DataFrame:
        """Return a row for each model, in the order of the call, as a data frame; needs pandas.

        Returns
        -------
        DataFrame
            Indexed by the model's text; scores relative to the measured signal, as in `rows`.

        Raises
        ------
        InputError
            pandas is not installed.

        Examples
        --------
        >>> comparison.to_pandas()["score"].idxmin()  # doctest: +SKIP
        'stribeck'
        """
        rows = [{name: getattr(row, name) for name in _PLAIN} for row in self.rows]
        return data_frame(rows, index="model")

    def to_json(self) -> str:
        """Return everything as JSON with a schema version; the winner's estimate as in `Estimate.to_json`."""
        document = {
            "schema": SCHEMA,
            "kind": "jointid comparison",
            "winner": self.winner,
            "reason": self.reason,
            "rows": [_row(row) for row in self.rows],
            "settings": dict(self.settings),
            "estimate": json.loads(self.estimate.to_json()),
        }
        return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False)

    def _said(self) -> list[str]:
        """What to know of the winner's values, a line each: whether they are usable, and its warnings."""
        return [
            *self.estimate.verdict.lines(),
            *(
                f"{'not usable' if found.severity == 'blocking' else found.severity} ({found.code}): {found.cause}"
                for found in self.estimate.warnings
            ),
        ]

    def _title(self) -> str:
        return self.estimate.joint.name or "joint"

    def setting(self) -> str:
        """Return what was held out, and what is compared, in a sentence."""
        settings = self.settings
        unit = "block of the recording" if settings["held_out"] == "block" else "recording"
        if settings["held_out"] == "recordings":
            unit = "group of recordings"
        return (
            f"{settings['folds']} folds, one {unit} held out in each; {residual_text(settings['residual'])}, "
            "relative to the measured signal"
        )

    def cells(self) -> list[tuple[str, ...]]:
        """Return the table of the models, a row each, in the order of `HEAD`."""
        return [
            (
                row.model,
                str(row.parameters),
                f"{100.0 * row.score:.3f} %",
                f"{100.0 * row.stderr:.3f} %",
                f"{row.penalty:.5g}",
                row.reason,
            )
            for row in self.rows
        ]


def _row(row: ComparedModel) -> dict[str, Any]:
    """Return a row in JSON types; the model as its fields."""
    return {name: getattr(row, name) for name in _PLAIN} | {"spec": row.spec.stated()}
