"""What to say where degrees were taken for radians: to name a unit nobody named, never to overrule a named one."""

from __future__ import annotations

from collections.abc import Sequence

from jointid.recording.recording import Recording

_DEGREES = {"position": "deg", "velocity": "deg/s"}


def degrees_advice(recording: Recording, signals: Sequence[str]) -> str:
    """How to read signals that seem to be in degrees."""
    assumed = recording.metadata.get("assumed_units")
    unnamed = [name for name in signals if isinstance(assumed, list | tuple) and name in assumed]
    if unnamed:
        units = ", ".join(f"'{name}': '{_DEGREES[name]}'" for name in unnamed)
        return f"load with units={{{units}}}"
    return "a header, or who made the recording, says radians: correct that, or convert the values"
