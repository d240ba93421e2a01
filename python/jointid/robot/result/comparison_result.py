"""Result of `compare` for a robot: a row for each candidate, the chosen candidate, and each joint's model."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, Self

from jointid.base.advice import Action
from jointid.base.error_text import printable
from jointid.base.json_layout import json_types
from jointid.base.result import KeptResult, Overview, Quantity, require_text
from jointid.base.text_table import aligned
from jointid.estimate.answers import cut, findings
from jointid.estimate.wording import rounded, two_digits
from jointid.robot.result.answers import FINDINGS, lines_of_joints
from jointid.robot.result.comparison_row import ComparedRobotModel
from jointid.robot.result.result import RobotEstimate

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RobotComparison(KeptResult):
    """Comparison of inertias and friction models of a robot.

    Attributes
    ----------
    rows : tuple of ComparedRobotModel
        One row for each candidate, in the order of the call.
    winner : ComparedRobotModel
        The chosen candidate.
    models : mapping of str to str
        Model of each joint, chosen by the same rule with the chosen inertia.
    reason : str
        Reason of the choice, in a sentence.
    estimate : RobotEstimate
        Estimate from all recordings, with the chosen inertia and each joint's model.
    settings : mapping
        Number of folds, held-out part ("block", "recording" or "recordings") and duration of the windows.
        "left_out" contains the candidates without a fit, with the reason for each candidate.
    """

    rows: tuple[ComparedRobotModel, ...]
    winner: ComparedRobotModel
    models: Mapping[str, str]
    reason: str
    estimate: RobotEstimate
    settings: Mapping[str, Any]

    _KIND = "robot comparison"

    @property
    def overview(self) -> Overview:
        """Summary for a report page."""
        from jointid.robot.result.overview import made_by

        left_out = self._left_out.items()
        return Overview(
            title=f"{self.estimate.robot.name or 'robot'}: {len(self.rows)} models compared",
            footer=made_by(self.estimate),
            answer=(f"Use {self.winner.name}: {self.estimate.verdict.level}.", self.reason),
            level=self.estimate.verdict.level,
            parameters=tuple(
                Quantity(
                    name=row.name,
                    value=100.0 * row.score,
                    error=100.0 * row.stderr,
                    unit="%",
                    meaning="residual of held-out torque",
                    remark=row.reason,
                )
                for row in self.rows
            ),
            facts=(
                ("held out", self.setting()),
                *((f"model of {joint}", model) for joint, model in self.models.items()),
                *((f"not compared: {name}", why) for name, why in left_out),
            ),
            findings=self.estimate.findings,
            inner={self.winner.name: self.estimate},
        )

    def report(self, verbose: bool = False) -> str:
        """Return the chosen candidate, a line for each joint, and the first finding, as text.

        Parameters
        ----------
        verbose : bool
            Whether to return the complete report: a line for each candidate, and each joint's residual. Default
            False.
        """
        if not verbose:
            return answer_of_comparison(self)
        title = f"jointid comparison — {self.estimate.robot.name or 'robot'}"
        lines = [title, "", *aligned([_HEAD, *self.cells()]), "", self.setting()]
        lines += ["", "held-out residual of each joint"]
        lines += aligned([["", *self.models], *self.joint_cells()])
        lines += ["", *(f"not compared: {name}: {why}" for name, why in self._left_out.items())]
        return printable("\n".join([*lines, f"chosen: {self.winner.name}", self.reason]))

    def to_dict(self) -> dict[str, Any]:
        """Return the whole comparison in JSON's types; the estimate has the format of `RobotEstimate.to_dict`."""
        from jointid.robot.result.comparison_reading import KIND, SCHEMA

        rows = [asdict(row) for row in self.rows]
        for row in rows:
            row["joints"] = {
                name: [None if each != each else each for each in scores]
                for name, scores in row["joints"].items()
            }
        return {
            "schema": SCHEMA,
            "kind": KIND,
            "winner": {"inertia": self.winner.inertia, "model": self.winner.model},
            "models": dict(self.models),
            "reason": self.reason,
            "rows": json_types(rows),
            "settings": json_types(self.settings),
            "estimate": self.estimate.to_dict(),
        }

    document = to_dict

    def to_json(self) -> str:
        """Return `to_dict` as JSON text; `from_json` reads the text."""
        return json.dumps(self.to_dict(), indent=1, ensure_ascii=False, allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the comparison from a JSON text; `bootstrap` of its estimate raises an error.

        Parameters
        ----------
        text : str
            JSON text from `to_json`.

        Raises
        ------
        InputError
            The text is not JSON or not a robot's comparison, has another schema, or holds an invalid value. The message
            names the place in the text.
        """
        from jointid.robot.result.comparison_reading import comparison_fields

        return cls(**comparison_fields(require_text(text), RobotEstimate))

    def to_pandas(self) -> pd.DataFrame:
        """Return a row for each candidate, in the order of the call, as a data frame.

        Returns
        -------
        DataFrame
            Data frame indexed by inertia and model. Scores are relative to the measured torque, as in `rows`.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        from jointid.base.frames import data_frame

        rows = [{name: getattr(row, name) for name in _PLAIN} for row in self.rows]
        return data_frame(rows, index=["inertia", "model"])

    def cells(self) -> list[list[str]]:
        """Return the table of the candidates, without the header row."""
        return [
            [
                row.inertia,
                row.model,
                str(row.parameters),
                f"{100.0 * row.score:.3f} %",
                f"{100.0 * row.stderr:.3f} %",
                row.reason,
            ]
            for row in self.rows
        ]

    def joint_cells(self) -> list[list[str]]:
        """Return the table of each joint's held-out residual, one row per candidate; last row: chosen models."""
        found = [
            [row.name, *(f"{100.0 * row.mean_of(joint):.2f} %" for joint in row.joints)]
            for row in self.rows
        ]
        return [*found, ["chosen", *self.models.values()]]

    def setting(self) -> str:
        """Return the setting of the comparison in a sentence: folds, held-out parts, windows and residual."""
        unit = {
            "block": "block of the recording",
            "recording": "recording",
            "recordings": "group of recordings",
        }[self.settings["held_out"]]
        return (
            f"{self.settings['folds']} folds, one {unit} held out in each; torque residual over windows of "
            f"{1e3 * self.settings['window_duration']:.4g} ms, relative to the measured torque, averaged over the "
            "joints"
        )

    @property
    def _left_out(self) -> dict[str, str]:
        return dict(self.settings["left_out"])

    def __str__(self) -> str:
        return self.report()

    def __repr__(self) -> str:
        scores = ", ".join(f"{row.name} {100.0 * row.score:.3g} %" for row in self.rows)
        return f"RobotComparison({scores}; chosen {self.winner.name})"


_PLAIN = ("inertia", "model", "parameters", "score", "stderr", "fold_scores", "reason")
_HEAD = ["inertia", "model", "parameters", "held-out residual", "± std. error", "remark"]


def answer_of_comparison(
    found: RobotComparison, action: Callable[[Action], str] = str, saved: str = ""
) -> str:
    """Return the chosen candidate with each joint's model and values, in at most 7 lines plus one for each joint."""
    estimate, winner = found.estimate, found.winner
    others = sorted((row for row in found.rows if row != winner), key=lambda row: row.score)
    runner_up = f", next {others[0].name} {_score(others[0])}" if others else ""
    lines = [
        f"{estimate.robot.name or 'robot'}: {winner.name} of {len(found.rows)} candidates, {estimate.verdict.level}",
        cut(f"  held-out residual {_score(winner)}{runner_up}"),
        *lines_of_joints(estimate, found.models),
        *findings(estimate.findings, action, FINDINGS, saved),
    ]
    return printable("\n".join(lines))


def _score(row: ComparedRobotModel) -> str:
    value, error = 100.0 * row.score, 100.0 * row.stderr
    return f"{rounded(value, error) if error > 0.0 else f'{value:.3g}'} ± {two_digits(error)} %"
