"""A recording's display in notebooks: its facts, and the range of each signal."""

from __future__ import annotations

import numpy as np

from jointid.base.html import Html, element, table
from jointid.recording.samples import Samples
from jointid.recording.signals import FloatArray


def html_facts(recording: Samples) -> Html:
    """Return the recording's facts and signals as two tables."""
    gaps = len(recording.gaps)
    facts: list[list[Html | str]] = [
        ["joint", recording.kind],
        ["samples", f"{len(recording):,}"],
        ["duration", f"{recording.duration:.6g} s"],
        ["period", f"{1e3 * recording.sample_period:.6g} ms"],
        ["gaps", str(gaps) if gaps else "none"],
    ]
    signals: list[list[Html | str]] = [
        _range(_shown(recording, name), recording.unit(name), getattr(recording, name))
        for name in recording.signals
    ]
    signals += [
        _range(f"{name} (extra)", recording.unit(name), values)
        for name, values in recording.extra.items()
    ]
    return element(
        "div",
        element("b", f"jointid recording{' — ' if recording.name else ''}{recording.name}"),
        table(facts),
        table(signals, head=["signal", "lowest", "highest", "rms", "unit"]),
    )


def _shown(recording: Samples, name: str) -> str:
    derived = name == "velocity" and recording.velocity_derived
    return f"{name.replace('_', ' ')}{' (derived)' if derived else ''}"


def _range(name: str, unit: str, values: FloatArray) -> list[Html | str]:
    # If a squared value overflows, the rms is infinite.
    with np.errstate(over="ignore"):
        size = float(np.sqrt(np.mean(values * values)))
    shown = (f"{number:.5g}" for number in (float(values.min()), float(values.max()), size))
    return [element("th", name), *shown, "raw" if unit == "1" else unit]
