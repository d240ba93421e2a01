"""What is special in a session's .csv: it may be torn; its first and last lines say how it began and ended."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from jointid.recording.saving import CSV_MARK
from jointid.recording.signals import FloatArray

OPENING, CLOSING = "# jointid run ", "# jointid session "


def session_text(text: str) -> tuple[str, Mapping[str, Any] | None]:
    """Leave out of a session's text what is no row: a line cut off, the opening and the closing line.

    Parameters
    ----------
    text : str
        Of a file that begins with `CSV_MARK`.

    Returns
    -------
    str
        The same text where no session wrote it.
    dict or None
        What the two lines say; with ``"torn": True`` where there is no closing line: the session was
        killed, or the power failed. None where no session wrote the text.
    """
    # Not by `metadata`: that stays when the recording is saved anew, whole.
    end = text.find("\n")
    try:
        said = json.loads(text[len(CSV_MARK) : max(end, 0)])
        session = said["grown"] is True and isinstance(said["metadata"], dict)
    except (ValueError, TypeError, KeyError, RecursionError):
        return text, None
    if not session:
        return text, None
    whole = text[: text.rfind("\n") + 1]  # a number cut off looks like another number
    last = whole.rfind("\n", 0, len(whole) - 1) + 1
    notes: dict[str, Any] = {"torn": True}
    if whole.startswith(CLOSING, last):
        closing = _said(whole[last + len(CLOSING) :])
        if closing is None:
            return text, None
        whole, notes = whole[:last], closing
    first = whole.find("\n", end + 1) + 1
    if first and whole.startswith(OPENING, first):
        behind = whole.find("\n", first)
        opening = _said(whole[first + len(OPENING) : behind])
        if opening is None:
            return text, None
        whole, notes = whole[:first] + whole[behind:], opening | notes  # lines keep their numbers
    return whole, notes


def with_notes(saved: Mapping[str, Any], notes: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a recording says of itself, with what is known of its end."""
    return {**saved, "metadata": {**saved["metadata"], **notes}}


def ended_before(notes: Mapping[str, Any]) -> str:
    """Return the sentence on a session of which there is no sample."""
    why = notes.get("stop")
    if why:
        return f"the session ended before its first sample: {why}"
    killed = "; it was killed, or the power failed" if notes.get("torn") else ""
    return f"the session ended before its first sample{killed}"


def untold(saved: Mapping[str, Any], values: Mapping[str, FloatArray]) -> list[str]:
    """Signals that a session's file has a column for, though nobody told them.

    A current of which not all numbers are there, and a sensor that reads exactly 0 throughout: there is none.
    """
    metadata = saved.get("metadata")
    if not (isinstance(metadata, Mapping) and metadata.get("session") is True):
        return []
    found = []
    if "current" in values and np.isnan(values["current"]).any():
        found.append("current")
    if "sensor" in values and not values["sensor"].any():
        found.append("sensor")
    return found


def _said(text: str) -> dict[str, Any] | None:
    try:
        notes = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return notes if isinstance(notes, dict) else None
