"""What is special in a session's .csv: it may be torn, and its last line says how it ended."""

import json
from collections.abc import Mapping
from typing import Any

from jointid.recording.saving import CSV_MARK

CLOSING = "# jointid session "


def session_text(text: str) -> tuple[str, Mapping[str, Any] | None]:
    """Leave out of a session's text what is no row: a line cut off, and the closing line.

    Parameters
    ----------
    text : str
        Of a file that begins with `CSV_MARK`.

    Returns
    -------
    str
        The same text where no session wrote it.
    dict or None
        What the closing line says; ``{"torn": True}`` without one: the session was killed, or the power
        failed. None where no session wrote the text.
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
    if whole.startswith(CLOSING, last):
        try:
            notes = json.loads(whole[last + len(CLOSING) :])
        except (ValueError, RecursionError):
            return text, None
        if isinstance(notes, dict):
            return whole[:last], notes
    return whole, {"torn": True}


def with_notes(saved: Mapping[str, Any], notes: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a recording says of itself, with what is known of its end."""
    return {**saved, "metadata": {**saved["metadata"], **notes}}
