"""Sessions' .csv files: their opening and closing lines, and files that end early (truncated)."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from jointid.base.errors import InputError
from jointid.recording.saved import CSV_MARK
from jointid.recording.signals import FloatArray

OPENING, CLOSING = "# jointid run ", "# jointid session "


def session_text(text: str) -> tuple[str, Mapping[str, Any] | None]:
    """Remove the lines of a session's text that are not rows: a truncated line, the opening and the closing line.

    Parameters
    ----------
    text : str
        Text of a file with `CSV_MARK` at its beginning.

    Returns
    -------
    str
        Text without these lines; unchanged if it is not a session's.
    dict or None
        Metadata of the opening and closing line, with ``"truncated": True`` if there is no closing line
        (the session was killed, or the power failed). None if it is not a session's text.
    """
    # Do not decide by `metadata`: it stays when the complete recording is saved again.
    end = text.find("\n")
    if not _is_session(_json_object(text[len(CSV_MARK) : max(end, 0)])):
        return text, None
    whole = text[: text.rfind("\n") + 1]  # a truncated number looks like another number
    last = whole.rfind("\n", 0, len(whole) - 1) + 1
    metadata: dict[str, Any] = {"truncated": True}
    if whole.startswith(CLOSING, last):
        closing = _json_object(whole[last + len(CLOSING) :])
        if closing is None:
            return text, None
        whole, metadata = whole[:last], closing
    first = whole.find("\n", end + 1) + 1
    if first and whole.startswith(OPENING, first):
        behind = whole.find("\n", first)
        opening = _json_object(whole[first + len(OPENING) : behind])
        if opening is None:
            return text, None
        whole, metadata = whole[:first] + whole[behind:], opening | metadata  # keep line numbers
    return whole, metadata


def _is_session(attributes: Mapping[str, Any] | None) -> bool:
    return (
        attributes is not None
        and attributes.get("grown") is True
        and isinstance(attributes.get("metadata"), dict)
    )


def with_metadata(saved: Mapping[str, Any], metadata: Mapping[str, Any]) -> dict[str, Any]:
    """Return the attributes of a saved recording with more metadata."""
    return {**saved, "metadata": {**saved["metadata"], **metadata}}


def no_sample(metadata: Mapping[str, Any]) -> str:
    """Return the reason why a session's file has no samples."""
    reason = metadata.get("stop")
    if reason:
        return f"the session ended before its first sample: {reason}"
    killed = "; the program was killed, or the power failed" if metadata.get("truncated") else ""
    return f"the session ended before its first sample{killed}"


def unrecorded(saved: Mapping[str, Any], values: Mapping[str, FloatArray]) -> list[str]:
    """Return the signals with a column but without values in a session's file.

    These are a current with missing numbers, a sensor that is exactly 0 throughout, and `late` in a run
    without delays.
    """
    metadata = saved.get("metadata")
    if not (isinstance(metadata, Mapping) and metadata.get("session") is True):
        return []
    found = []
    if "current" in values and np.isnan(values["current"]).any():
        found.append("current")
    if "sensor" in values and not values["sensor"].any():
        found.append("sensor")
    if "late" in values and not values["late"].any():
        found.append("late")
    return found


def _json_object(text: str) -> dict[str, Any] | None:
    from jointid.base.schema import Json, read_json

    try:
        value = Json(finite=False).read(read_json(text), "")
    except InputError:
        return None
    return value if isinstance(value, dict) else None
