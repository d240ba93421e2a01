"""Section with the next step after a session."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, cast

from jointid.base.advice import Action
from jointid.base.result import Result
from jointid.report.page.content import Part, paragraph
from jointid.report.page.extras import Extras

if TYPE_CHECKING:
    from jointid.commissioning.result import Commissioning

_SMALL = 1.2  # smallest ratio of tracking errors that counts as an improvement


def content(result: Result, extras: Extras) -> list[Part]:
    """Return one sentence; empty if there is no next step."""
    said = next_step(cast("Commissioning", result), extras.action)
    return [Part("", (paragraph(said),))] if said else []


def next_step(result: Commissioning, action: Callable[[Action], str] = str) -> str:
    """Return the next step, in a sentence."""
    if any(run.recording.metadata.get("stop") for run in result.runs):
        return "Next: before the joint moves again, find out why the limit was reached."
    if not result.estimates:
        return "Next: identify the joint from the recordings."
    warned = [found for found in result.estimates[-1].warnings if found.advice]
    if result.blocked is None and result.improvement < _SMALL:
        return "Next: do not use these values; they do not reduce the tracking error."
    if warned:
        return f"Next: {action(warned[0].advice[0])} (finding {warned[0].code})."
    if result.blocked is not None:
        return ""
    return "Next: save these values to the joint file; no finding advises against this."
