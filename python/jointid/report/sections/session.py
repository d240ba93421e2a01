"""Section with the course of a session: limits, stops, timing, the drive."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, cast

from jointid.base.result import Result
from jointid.report.page.content import Block, Part, pairs, paragraph, table_of
from jointid.report.page.extras import Extras
from jointid.report.sections.limit_margins import margin_rows

if TYPE_CHECKING:
    from jointid.commissioning.result import Commissioning


def content(result: Result, extras: Extras) -> list[Part]:
    """Return limits and stops, and if known timing and drive, folded."""
    from jointid.commissioning.result import TIMING, timing_rows

    session = cast("Commissioning", result)
    prefix = extras.prefix
    margins = table_of(margin_rows([run.recording for run in session.runs]))
    reached = paragraph("The largest recorded value of all runs, and its share of the limit.", True)
    parts = [
        Part("Limits", (margins, reached), f"{prefix}limits", "half"),
        Part("Stops", _stops(session), f"{prefix}stops", "half"),
    ]
    timing = timing_rows(session)
    if len(timing) > 1:
        blocks = (table_of(timing), paragraph(TIMING))
        parts.append(Part("Timing", blocks, f"{prefix}timing", "folded"))
    drive = session.runs[0].recording.metadata.get("drive")
    if isinstance(drive, dict):
        parts.append(Part("Drive", (pairs(_drive(drive)),), f"{prefix}drive", "folded"))
    return parts


def _stops(session: Commissioning) -> tuple[Block, ...]:
    """Return whether a run ended early, and whether the motor is off."""
    blocks: list[Block] = [
        paragraph(f"{run.name}: {reason}.")
        for run in session.runs
        if (reason := run.recording.metadata.get("stop"))
    ]
    blocks = blocks or [paragraph("No run was stopped by a limit.")]
    off = session.runs[-1].recording.metadata.get("motor_off")
    if off is not None:
        words = "The drive confirmed that the motor is off." if off else "The motor may be on."
        blocks.append(paragraph(words))
    return tuple(blocks)


def _drive(drive: Mapping[str, Any]) -> list[tuple[str, str]]:
    return [
        (
            str(name),
            ", ".join(f"{key} {each}" for key, each in value.items())
            if isinstance(value, dict)
            else str(value),
        )
        for name, value in drive.items()
    ]
