"""Section with the recorded signals, with unused parts shaded, and the residual over position."""

from __future__ import annotations

from typing import cast

from jointid.base.errors import InputError
from jointid.base.result import Result
from jointid.estimate.estimate import Estimate
from jointid.panels.recorded import left_out, residual_over_position, signals
from jointid.report.page.content import Block, Figure, Part, paragraph
from jointid.report.page.extras import Extras

_MOST = 4  # number of recordings with their own picture


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the pictures; empty without the recordings.

    Raises
    ------
    InputError
        The estimate was made from other recordings.
    """
    estimate, recordings = cast("Estimate", result), extras.recordings
    if not recordings:
        return []
    _require_those_of(estimate, extras)
    parts = [
        Part(
            (recording.name or f"recording {number + 1}") if len(recordings) > 1 else "",
            (Figure(signals(recording, *left_out(estimate.windows, number, recording.time))),),
        )
        for number, recording in enumerate(recordings[:_MOST])
    ]
    more = len(recordings) - _MOST
    blocks: tuple[Block, ...] = (paragraph(f"and {more} more recordings"),) if more > 0 else ()
    over_position = Figure(residual_over_position(estimate, recordings))
    parts.append(Part("Residual over position", (*blocks, over_position)))
    return [
        Part("Signals as recorded", (), f"{extras.prefix}signals", "folded", tuple(parts)),
    ]


def _require_those_of(estimate: Estimate, extras: Extras) -> None:
    shown = [recording.fingerprint for recording in extras.recordings]
    wanted = [run["fingerprint"] for run in estimate.settings["recordings"]]
    if shown != wanted:
        raise InputError(
            f"these have the fingerprints {', '.join(shown)}; the estimate was made from {', '.join(wanted)}",
            argument="recordings",
            remedy="give the recordings that identify() had, in the same order",
        )
