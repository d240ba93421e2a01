"""Result of a comparison of models: a row for each model, the chosen model, and the reason."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from textwrap import wrap
from typing import TYPE_CHECKING, Any, Self

from jointid.base.advice import Action
from jointid.base.error_text import printable
from jointid.base.frames import data_frame
from jointid.base.json_layout import json_types
from jointid.base.result import KeptResult, Overview, Quantity, require_text
from jointid.base.values import dataclass
from jointid.comparison.row import ComparedModel
from jointid.estimate.answers import COLUMNS, findings, purposes
from jointid.estimate.estimate import Estimate
from jointid.estimate.settings import residual_text
from jointid.estimate.wording import percent_with_error

if TYPE_CHECKING:
    import pandas as pd

_PLAIN = (
    *("model", "parameters", "score", "stderr", "fold_scores", "penalty", "eligible", "reason"),
)
_SHOWN = 6  # largest number of models in an answer
HEAD = ("model", "parameters", "held-out residual", "± std. error", "penalty", "remark")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Comparison(KeptResult):
    """Comparison of friction models of a joint.

    Attributes
    ----------
    rows : tuple of ComparedModel
        One row for each compared model, in the order of the call.
    winner : str
        Text of the chosen model.
    reason : str
        Reason of the choice, in a sentence.
    estimate : Estimate
        Estimate of the chosen model from all data.
    settings : mapping
        Number of folds, held-out part ("held_out"), windows, method and residual. "left_out" contains the models
        that were not compared, with the reason for each model.

    Examples
    --------
    >>> comparison = jid.compare(recording, joint, models=["coulomb_viscous", "stribeck"], folds=3)
    >>> comparison.winner
    'stribeck'
    """

    rows: tuple[ComparedModel, ...]
    winner: str
    reason: str
    estimate: Estimate
    settings: Mapping[str, Any]

    _KIND = "comparison"

    @property
    def overview(self) -> Overview:
        """Summary for a report page."""
        from jointid.estimate.overview import made_by, settings_of

        left_out = self.settings["left_out"].items()
        return Overview(
            title=f"{self._title()}: {len(self.rows)} friction models compared",
            footer=made_by(self.estimate.settings),
            answer=(self._advice(), self.reason),
            level=self.estimate.verdict.level,
            parameters=tuple(
                Quantity(
                    name=row.model,
                    value=100.0 * row.score,
                    error=100.0 * row.stderr,
                    unit="%",
                    meaning="held-out residual",
                    remark=row.reason,
                )
                for row in self.rows
            ),
            facts=(
                ("held out", self.setting()),
                *((f"not compared: {model}", reason) for model, reason in left_out),
            ),
            findings=self.estimate.findings,
            settings=settings_of(self.settings, without=("left_out",)),
            inner={self.winner: self.estimate},
        )

    def __repr__(self) -> str:
        scores = ", ".join(f"{row.model} {100.0 * row.score:.3g} %" for row in self.rows)
        return f"Comparison({scores}; chosen {self.winner})"

    def report(
        self, action: Callable[[Action], str] = str, saved: str = "", *, verbose: bool = False
    ) -> str:
        """Return the comparison as text: chosen model, a line for each model, verdict and findings of the chosen model.

        Parameters
        ----------
        action : callable
            Function that returns the text of an action. Default: the text for a Python prompt.
        saved : str
            File of the chosen model's estimate. Default: none.
        verbose : bool
            Whether to return the complete report: penalties, folds, models that were not compared. Default False.
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
        return printable("\n".join([*lines, f"chosen: {self.winner}", self.reason, *self._said()]))

    def to_pandas(self) -> pd.DataFrame:
        """Return a row for each model, in the order of the call, as a data frame. It needs pandas.

        Returns
        -------
        DataFrame
            Data frame indexed by the model's text. Scores are relative to the measured signal, as in `rows`.

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

    def to_dict(self) -> dict[str, Any]:
        """Return the whole comparison in JSON's types; the estimate has the format of `Estimate.to_dict`."""
        from jointid.comparison.reading_back import KIND, SCHEMA

        return {
            "schema": SCHEMA,
            "kind": KIND,
            "winner": self.winner,
            "reason": self.reason,
            "rows": [_row(row) for row in self.rows],
            "settings": json_types(self.settings),
            "estimate": self.estimate.to_dict(),
        }

    def to_json(self) -> str:
        """Return `to_dict` as JSON text; `from_json` reads the text."""
        return json.dumps(self.to_dict(), indent=1, ensure_ascii=False, allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the comparison from a JSON text. The estimate's methods that need the recordings raise an error.

        Parameters
        ----------
        text : str
            JSON text from `to_json`.

        Raises
        ------
        InputError
            The text is not JSON or not a comparison, has another schema, or holds an invalid value. The message names
            the place in the text.
        """
        from jointid.comparison.reading_back import comparison_fields

        return cls(**comparison_fields(require_text(text), Estimate))

    def _advice(self) -> str:
        """Return the advice which model to use, as a sentence."""
        blocking = [each for each in self.estimate.findings if each.severity == "blocking"]
        return (
            f"Use none: {blocking[0].cause}."
            if blocking
            else f"Use {self.winner}: {self.estimate.verdict.level}."
        )

    def _said(self) -> list[str]:
        """Return the usability of the chosen model's values and its warnings, one line each."""
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
        """Return the setting of the comparison, in a sentence: held-out parts and compared residual."""
        settings = self.settings
        unit = "block of the recording" if settings["held_out"] == "block" else "recording"
        if settings["held_out"] == "recordings":
            unit = "group of recordings"
        return (
            f"{settings['folds']} folds, one {unit} held out in each; {residual_text(settings['residual'])}, "
            "relative to the measured signal"
        )

    def cells(self) -> list[tuple[str, ...]]:
        """Return the table of the models, one row for each, in the order of `HEAD`."""
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
    """Return a row in JSON types, with the model as its fields."""
    document = {name: getattr(row, name) for name in _PLAIN} | {"spec": row.spec.stated()}
    return dict(json_types(document))
