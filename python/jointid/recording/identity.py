"""Identity of a recording: comparison by bytes, fingerprint, one line of text."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np

from jointid.recording.extra import PREFIX
from jointid.recording.samples import Samples


def same_fields(mine: dict[str, Any], theirs: dict[str, Any]) -> bool:
    """Whether two recordings' arguments are equal. Arrays are compared by bytes: -0.0 differs from 0.0."""
    return list(mine) == list(theirs) and all(
        _same(value, theirs[name]) for name, value in mine.items()
    )


def _same(value: Any, other: Any) -> bool:
    if isinstance(value, np.ndarray) and isinstance(other, np.ndarray):
        return value.tobytes() == other.tobytes()
    if isinstance(value, np.ndarray) or isinstance(other, np.ndarray):
        return False
    if isinstance(value, dict) and any(isinstance(each, np.ndarray) for each in value.values()):
        return isinstance(other, dict) and same_fields(value, other)
    return bool(value == other)


def fingerprint_of(recording: Samples) -> str:
    """Return the first 16 digits of the hash of names and bytes; see `Recording.fingerprint`."""
    digest = hashlib.sha256()
    signals = {name: getattr(recording, name) for name in recording.signals}
    extra = {PREFIX + name: values for name, values in recording.extra.items()}
    for name, values in (signals | extra).items():
        digest.update(f"{name}:{len(recording)};".encode())
        digest.update(np.ascontiguousarray(values, dtype="<f8").data)
    return digest.hexdigest()[:16]


def line_of(recording: Samples) -> str:
    """Return one line about a recording; see `repr`."""
    named = f" {recording.name!r}" if recording.name else ""
    derived = "velocity (derived)" if recording.velocity_derived else "velocity"
    shown = [derived if name == "velocity" else name for name in recording.signals]
    shown += [f"extra {name}" for name in recording.extra]
    count = len(recording.gaps)
    gaps = f", {count} gap{'s' * (count > 1)}" if count else ""
    return (
        f"<Recording{named}: {recording.kind}, {len(recording)} samples over {recording.duration:.6g} s, "
        f"period {recording.sample_period:.6g} s{gaps}; {', '.join(shown)}>"
    )
