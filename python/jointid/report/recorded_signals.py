"""The signals as recorded, with what an estimate left out shaded, and what its residual does over the position."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.base.html import Html, element
from jointid.estimate.estimate import Estimate
from jointid.estimate.window_views import fitted_signal, whole_windows
from jointid.problem.window_table import WindowTable
from jointid.recording.recording import Recording
from jointid.report.drawing.marks import Level, Line, Panel, Points, Shade
from jointid.report.figure import captioned

Array = NDArray[np.float64]

_SHOWN = ("position", "velocity", "torque", "motor_torque", "current", "sensor", "temperature")
_MOST = 4  # recordings with a picture of their own
_HALF = 0.5  # of a window's time: what was left out of it is more than what was used


def recorded_sections(estimate: Estimate, recordings: Sequence[Recording]) -> list[Html]:
    """Return the signals of each recording, and the residual over the position, with their headings.

    Parameters
    ----------
    estimate : Estimate
    recordings : sequence of Recording
        Those that it was made from, in this order.

    Raises
    ------
    InputError
        They are others.
    """
    _require_those_of(estimate, recordings)
    parts: list[Html] = [element("h2", "Signals as recorded", id="signals")]
    for number, recording in enumerate(recordings[:_MOST]):
        if len(recordings) > 1:
            parts.append(element("h3", recording.name or f"recording {number + 1}"))
        parts.append(_signals(recording, *left_out(estimate.windows, number, recording.time)))
    if len(recordings) > _MOST:
        parts.append(element("p", f"and {len(recordings) - _MOST} more recordings"))
    return [*parts, _over_position(estimate, recordings)]


def left_out(windows: WindowTable, number: int, time: Array) -> tuple[Array, Array]:
    """Return where the stretches of a recording begin and end [s] that no window used, or less than half of it.

    Parameters
    ----------
    windows : WindowTable
    number : int
        Of the recording.
    time : ndarray
        The recording's, [s].
    """
    used = (windows.recording == number) & (
        windows.duration >= _HALF * (windows.stop - windows.start)
    )
    order = np.argsort(windows.start[used], kind="stable")
    start, stop = windows.start[used][order], windows.stop[used][order]
    reached = np.maximum.accumulate(np.concatenate([[time[0]], stop]))
    begins, ends = reached, np.concatenate([start, [time[-1]]])
    # What one sample period separates is no stretch.
    apart = ends - begins > 1.5 * float(time[-1] - time[0]) / max(len(time) - 1, 1)
    return begins[apart], ends[apart]


def _signals(recording: Recording, begins: Array, ends: Array) -> Html:
    names = [name for name in _SHOWN if getattr(recording, name) is not None]
    panels = [
        Panel(
            across="time [s]",
            up=f"{name.replace('_', ' ')} [{_unit(recording, name)}]",
            height=110,
            marks=(
                Shade(start=begins, stop=ends, label="" if row or not len(begins) else "left out"),
                Line(look="second", across=recording.time, up=getattr(recording, name)),
            ),
        )
        for row, name in enumerate(names)
    ]
    derived = " The velocity is derived from the position." if recording.velocity_derived else ""
    return captioned(
        "The signals as recorded. Shaded: what the estimate does not use: standstill, slow motion, gaps, and what "
        f"the call left out.{derived}",
        *panels,
    )


def _unit(recording: Recording, name: str) -> str:
    unit = recording.unit(name)
    return "raw" if unit == "1" else unit


def _over_position(estimate: Estimate, recordings: Sequence[Recording]) -> Html:
    """What is left over the position: ripple of the gear, gravity and a varying inertia show there."""
    windows = estimate.windows
    middle = 0.5 * (windows.start + windows.stop)
    position = np.empty_like(middle)
    for number, recording in enumerate(recordings):
        same = windows.recording == number
        position[same] = np.interp(middle[same], recording.time, recording.position)
    whole = whole_windows(windows)
    panel = Panel(
        across=f"position [{recordings[0].unit('position')}]",
        up=f"residual [{fitted_signal(estimate)[1]}]",
        height=110,
        marks=(
            Points(
                look="second",
                across=position[whole],
                up=(windows.residual / windows.duration)[whole],
            ),
            Level(look="measured", up=0.0),
        ),
    )
    return captioned(
        "The residual over the position: where it follows a curve, gravity, the gear's ripple or an inertia that "
        "varies is missing in the model.",
        panel,
    )


def _require_those_of(estimate: Estimate, recordings: Sequence[Recording]) -> None:
    given = [recording.fingerprint for recording in recordings]
    wanted = [run["fingerprint"] for run in estimate.settings["recordings"]]
    if given != wanted:
        raise InputError(
            f"{', '.join(given)}: the estimate was made from {', '.join(wanted)}",
            argument="recordings",
            remedy="give the recordings that identify() had, in the same order",
        )
