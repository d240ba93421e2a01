"""Section with a servo's runs or a robot's joints, logged and simulated, largest error first."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

from jointid.base.result import Result, kind_of
from jointid.estimate.rollout import Rollout
from jointid.panels.rollout import rolled_out
from jointid.report.page.content import Block, Figure, Multiples, Part, Table, paragraph
from jointid.report.page.extras import Extras

_MOST = 16  # number of runs with a picture
_SERVO = (
    'Each run starts from its logged initial state. Only reference position, supply voltage and the signal "driven" '
    "come from the log."
)
_ROBOT = "The logged torques move the arm."
_DRIVEN = "The position loop moves the arm; only the reference positions and the initial state come from the log."


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the runs of a servo, the worst one next to the values, or a robot's joints; empty without a rollout."""
    rollout = cast("Rollout", result) if kind_of(result) == "rollout" else extras.rollout
    if rollout is None:
        return []
    runs = sorted(rollout.runs, key=lambda run: -run.error)
    pictures = tuple(
        replace(
            rolled_out(run), title=f"{run.name}: {run.shown(run.error):.2f} {run.unit} mean error"
        )
        for run in runs[:_MOST]
    )
    more = len(runs) - len(pictures)
    rest = [paragraph(f"Without a picture: {more} runs with smaller errors.")] if more > 0 else []
    head, rows = replace(rollout, runs=tuple(runs)).table()
    table = Table(tuple(map(tuple, rows)), tuple(head), numbers=True)
    title, prefix = "Simulated along the log", extras.prefix
    errors = Part("Errors of all runs", (table,), f"{prefix}runs", "folded")
    if any(run.before is not None for run in runs):
        moved = _DRIVEN if all(run.closed for run in runs) else _ROBOT
        what = paragraph(f"{rollout.sentence} {moved}")
        return [Part(title, (what, Multiples(pictures), *rest), f"{prefix}rollouts"), errors]
    what = paragraph(f"{rollout.sentence} {_SERVO}")
    worst = Part(title, (Figure(pictures[0]), what), f"{prefix}rollouts", "half")
    others: list[Block] = [Multiples(pictures[1:]), *rest] if pictures[1:] else [*rest]
    return [
        worst,
        *([Part("Other runs", tuple(others), f"{prefix}others")] if others else []),
        errors,
    ]
