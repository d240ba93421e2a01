"""The result of `compare_robot_models`: a row for each candidate, the winner, and each joint's model."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from html import escape
from typing import Any

from jointid.base.advice import Action
from jointid.base.error_text import printable
from jointid.base.text_table import aligned
from jointid.estimate.answers import cut, findings
from jointid.estimate.wording import rounded, two_digits
from jointid.robot.links.inertia_modes import Inertia
from jointid.robot.result.answers import FINDINGS, lines_of_joints
from jointid.robot.result.result import RobotEstimate

SCHEMA = 1
KIND = "jointid robot comparison"


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedRobotModel:
    """One row of a comparison.

    Attributes
    ----------
    inertia : str
        "urdf", "scaled" or "free".
    model : str
        Of all joints.
    parameters : int
        Free parameters of the fit to all recordings.
    score : float
        Relative residual of held-out torque: mean over joints and blocks.
    stderr : float
        Its standard error over the blocks.
    fold_scores : tuple of float
        Of the blocks, mean over the joints.
    joints : mapping of str to tuple of float
        Relative residual of each joint in each block; NaN where it does not move.
    reason : str
        Why it wins or does not win.
    """

    inertia: Inertia
    model: str
    parameters: int
    score: float
    stderr: float
    fold_scores: tuple[float, ...]
    joints: Mapping[str, tuple[float, ...]]
    reason: str = ""

    @property
    def name(self) -> str:
        """Inertia and model in one text."""
        return f"inertia {self.inertia}, {self.model}"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RobotComparison:
    """The result of `compare_robot_models`.

    Attributes
    ----------
    rows : tuple of ComparedRobotModel
        In the order of the call.
    winner : ComparedRobotModel
    models : mapping of str to str
        The model of each joint, by the same rule with the winner's inertia.
    reason : str
        Why the winner won, in a sentence.
    estimate : RobotEstimate
        Of all recordings, with the winner's inertia and each joint's model.
    settings : mapping
        Folds, what each held out ("block", "recording" or "recordings"), duration of the windows, and candidates that
        could not be fitted with the reason for each ("left_out").
    """

    rows: tuple[ComparedRobotModel, ...]
    winner: ComparedRobotModel
    models: Mapping[str, str]
    reason: str
    estimate: RobotEstimate
    settings: Mapping[str, Any]

    def report(self, verbose: bool = False) -> str:
        """Return the winner, a line for each joint, and the first finding, as text.

        Parameters
        ----------
        verbose : bool
            Whether to return everything: a line for each candidate, and each joint's residual. Default False.
        """
        if not verbose:
            return answer_of_comparison(self)
        title = f"jointid comparison — {self.estimate.robot.name or 'robot'}"
        lines = [title, "", *aligned([_HEAD, *self.cells()]), "", self.setting()]
        lines += ["", "held-out residual of each joint"]
        lines += aligned([["", *self.models], *self.joint_cells()])
        lines += ["", *(f"not compared: {name}: {why}" for name, why in self._left_out.items())]
        return printable("\n".join([*lines, f"winner: {self.winner.name}", self.reason]))

    def _repr_html_(self) -> str:
        tables = [([*_HEAD], self.cells()), (["", *self.models], self.joint_cells())]
        shown = "".join(_html(head, cells) for head, cells in tables)
        return (
            f"<div><b>jointid comparison</b>{shown}<p>{escape(self.setting())}</p>"
            f"<p>{escape(self.reason)}</p></div>"
        )

    def document(self) -> dict[str, Any]:
        """Return everything in JSON types; the winner's estimate as in `RobotEstimate.document`."""
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
            "rows": rows,
            "settings": dict(self.settings),
            "estimate": self.estimate.document(),
        }

    def to_json(self) -> str:
        """Return `document` as JSON text."""
        return json.dumps(self.document(), indent=1, ensure_ascii=False, allow_nan=False)

    def cells(self) -> list[list[str]]:
        """The table of the candidates, without its head."""
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
        """Each joint's held-out residual, a row a candidate, and its model."""
        found = [
            [row.name, *(f"{100.0 * mean_of(scores):.2f} %" for scores in row.joints.values())]
            for row in self.rows
        ]
        return [*found, ["chosen", *self.models.values()]]

    def setting(self) -> str:
        """How it was compared, in a sentence."""
        unit = {
            "block": "block of the recording",
            "recording": "recording",
            "recordings": "group of recordings",
        }[self.settings["held_out"]]
        return (
            f"{self.settings['folds']} folds, one {unit} held out in each; residual of the torque over windows of "
            f"{1e3 * self.settings['window_duration']:.4g} ms, relative to the measured torque, mean of the joints"
        )

    @property
    def _left_out(self) -> dict[str, str]:
        return dict(self.settings["left_out"])

    def __str__(self) -> str:
        return self.report()

    def __repr__(self) -> str:
        scores = ", ".join(f"{row.name} {100.0 * row.score:.3g} %" for row in self.rows)
        return f"RobotComparison({scores}; winner {self.winner.name})"


_HEAD = ["inertia", "model", "parameters", "held-out residual", "± std. error", "remark"]


def mean_of(scores: tuple[float, ...]) -> float:
    """Mean of the blocks in which a joint moves."""
    moving = [each for each in scores if each == each]
    return sum(moving) / len(moving) if moving else float("nan")


def _html(head: list[str], rows: list[list[str]]) -> str:
    top = "".join(f"<th>{escape(cell)}</th>" for cell in head)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table class='jointid'><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"


def answer_of_comparison(
    found: RobotComparison, action: Callable[[Action], str] = str, saved: str = ""
) -> str:
    """Return the winner with each joint's model and values, in at most 7 lines and one for each joint."""
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
