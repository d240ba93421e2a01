"""A servo's closed loop as logged and as simulated, the run with the largest error first."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import cast

from jointid.base.result import Result, kind_of
from jointid.panels.rollout import rolled_out
from jointid.report.page.content import Block, Figure, Multiples, Part, Table, paragraph
from jointid.report.page.extras import Extras
from jointid.servo.rolling_out import Rollout

_MOST = 16  # runs with a picture


def content(result: Result, extras: Extras) -> list[Part]:
    """The worst run next to the values, then the others and the table; nothing for a servo without a rollout."""
    rollout = cast("Rollout", result) if kind_of(result) == "rollout" else extras.rollout
    if rollout is None:
        return []
    runs = sorted(rollout.runs, key=lambda run: -run.error)
    pictures = tuple(
        replace(rolled_out(run), title=f"{run.name}: {math.degrees(run.error):.2f}° mean error")
        for run in runs[:_MOST]
    )
    what = paragraph(
        f"Median over {len(runs)} runs: {math.degrees(rollout.median):.2f}°. Each run starts from its logged initial "
        "state; only the wanted position, the supply, and when the motor is driven come from the log."
    )
    more = len(runs) - len(pictures)
    others: list[Block] = [Multiples(pictures[1:])] if pictures[1:] else []
    if more > 0:
        others.append(paragraph(f"Without a picture: {more} runs with smaller errors."))
    table = Table(
        tuple(
            (
                run.name,
                f"{math.degrees(run.error):.2f}",
                f"{math.degrees(run.spread):.2f}",
                run.remark,
            )
            for run in runs
        ),
        ("run", "mean error [deg]", "moved by 1 % of torque [deg]", "remark"),
        numbers=True,
    )
    prefix = extras.prefix
    worst = Part("Closed loop, simulated", (Figure(pictures[0]), what), f"{prefix}rollouts", "half")
    parts = [worst, Part("Other runs", tuple(others), f"{prefix}others")] if others else [worst]
    return [*parts, Part("Errors of all runs", (table,), f"{prefix}runs", "folded")]
