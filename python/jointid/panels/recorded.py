"""Pictures of recorded signals, with unused parts shaded, and of the residual over position."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.window_views import fitted_signal, whole_windows
from jointid.panels.marks import Level, Line, Mark, Panel, Picture, Points, Shade
from jointid.panels.palette import LOOKS

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate
    from jointid.problem.window_table import WindowTable
    from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_SHOWN = ("position", "velocity", "torque", "motor_torque", "current", "sensor", "temperature")
_HALF = 0.5  # share of a window's time; a stretch counts as unused if less of it is used


def left_out(windows: WindowTable, number: int, time: Array) -> tuple[Array, Array]:
    """Return start and end [s] of the stretches of a recording that windows use less than half.

    Parameters
    ----------
    windows : WindowTable
    number : int
        Number of the recording.
    time : ndarray
        Times of the recording [s].
    """
    used = (windows.recording == number) & (
        windows.duration >= _HALF * (windows.stop - windows.start)
    )
    order = np.argsort(windows.start[used], kind="stable")
    start, stop = windows.start[used][order], windows.stop[used][order]
    reached = np.maximum.accumulate(np.concatenate([[time[0]], stop]))
    begins, ends = reached, np.concatenate([start, [time[-1]]])
    # A gap of one sample period is not a stretch.
    apart = ends - begins > 1.5 * float(time[-1] - time[0]) / max(len(time) - 1, 1)
    return begins[apart], ends[apart]


def signals(recording: Recording, begins: Array, ends: Array) -> Picture:
    """Return all signals of a recording over time, with unused parts shaded; see `left_out`."""
    names = [name for name in _SHOWN if getattr(recording, name) is not None]
    panels = []
    for row, name in enumerate(names):
        label = "left out" if row == 0 and len(begins) else ""
        unused = Shade(start=begins, stop=ends, label=label)
        panels.append(signal_panel({"": recording}, name, unused, height=110))
    derived = " The velocity is derived from the position." if recording.velocity_derived else ""
    return Picture(
        caption="Recorded signals. Shaded parts are not used: standstill, slow motion, gaps, and parts that the call "
        f"leaves out.{derived}",
        panels=tuple(panels),
    )


def signal_panel(
    runs: Mapping[str, Recording], name: str, *below: Mark, height: int = 220
) -> Panel:
    """Return one signal of one or several runs over time. All runs must have it.

    Parameters
    ----------
    runs : mapping of str to Recording
        Runs by name, for the legend.
    name : str
        Name of the signal.
    *below : Mark
        Marks drawn first.
    height : int
        Height of the panel. Default 220.
    """
    several = len(runs) > 1
    lines = (
        Line(
            look=LOOKS[number % len(LOOKS)] if several else "second",
            label=label,
            across=run.time,
            up=getattr(run, name),
            series=several,
        )
        for number, (label, run) in enumerate(runs.items())
    )
    unit = next(iter(runs.values())).unit(name)
    return Panel(
        across="time [s]",
        up=f"{name.replace('_', ' ')} [{'raw' if unit == '1' else unit}]",
        height=height,
        marks=(*below, *lines),
    )


def residual_over_position(estimate: Estimate, recordings: Sequence[Recording]) -> Picture:
    """Return the residual over position. It shows gear ripple, gravity and a varying inertia that the model lacks."""
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
    return Picture(
        caption="Residual over position. If the residual follows a curve, the model lacks gravity, gear ripple or a "
        "varying inertia.",
        panels=(panel,),
    )
