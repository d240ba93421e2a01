"""Plots over time: the tracking error of runs, their signals, and a desired trajectory."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from jointid.base.argument_checks import require_kind, require_mapping
from jointid.base.error_text import alternatives
from jointid.base.errors import InputError
from jointid.panels.marks import Line, Panel
from jointid.panels.palette import LOOKS
from jointid.panels.recorded import signal_panel
from jointid.panels.session import TrackingError, tracking_panel
from jointid.plot.appearance import axes_or_new
from jointid.plot.drawing import draw, of_kind
from jointid.recording.recording import Recording
from jointid.simulation.simulated_recording import SimulatedRecording
from jointid.simulation.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Runs = Recording | Mapping[str, Recording]
_DERIVATIVES = {"position": "rad", "velocity": "rad/s", "acceleration": "rad/s²"}
_SIGNALS = (*("position", "velocity", "torque", "motor_torque", "current", "sensor", "reference"),)


def tracking_error(
    runs: Runs, ax: Axes | None = None, *, settling: float | None = None, **style: Any
) -> Axes:
    """Draw the tracking error (position minus reference) over time, with its RMS in the legend.

    Parameters
    ----------
    runs : Recording or mapping of str to Recording
        One run, or several by name, e.g. ``{"before": a, "after": b}``. For a simulated run, the true position is
        drawn instead of the encoder's position.
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    settling : float, optional
        Time at the start of each run that the RMS excludes [s]. Default: a sixth of each run.
    **style
        Keywords of Matplotlib's `Axes.plot` for the curves, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Axes with time from the start of each run [s] and tracking error [mrad] or [mm].

    Raises
    ------
    InputError
        There is no run, or a run has no reference.

    Examples
    --------
    >>> jid.plot.tracking_error({"first guess": before, "identified": after})
    """
    named = _named(runs)
    errors = [_error(run, name, settling) for name, run in named.items()]
    slides = next(iter(named.values())).kind == "prismatic"
    panel = tracking_panel(errors, slides)
    axes = axes_or_new(ax)
    draw(axes, panel, style, of_kind(panel, Line), loc="upper right")
    _room_for_legend(axes)
    return axes


def signal(runs: Runs, name: str, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw one signal of one or several runs over time.

    Parameters
    ----------
    runs : Recording or mapping of str to Recording
        One run, or several by name.
    name : str
        Signal: "position", "velocity", "torque", "motor_torque", "current", "sensor" or "reference".
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the curves, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Axes with time [s] and the signal in SI units, or the sensor's raw reading.

    Raises
    ------
    InputError
        There is no run, the signal is unknown, or a run does not have the signal.
    """
    if name not in _SIGNALS:
        raise InputError(f"{alternatives(_SIGNALS)} is expected", argument="name", value=name)
    named = _named(runs)
    for label, run in named.items():
        if getattr(run, name) is None:
            raise InputError(
                f"the recording has no {name}; it has {', '.join(run.signals)}",
                argument=_argument(label),
            )
    panel = signal_panel(named, name)
    return draw(axes_or_new(ax), panel, style, of_kind(panel, Line))


def trajectory(
    wanted: Trajectory,
    what: str = "position",
    ax: Axes | None = None,
    *,
    label: str = "",
    **style: Any,
) -> Axes:
    """Draw a desired motion over time.

    Parameters
    ----------
    wanted : Trajectory
        Motion of a revolute joint.
    what : {"position", "velocity", "acceleration"}
        The drawn quantity. Default "position".
    ax : Axes, optional
        Axes to draw into. Several motions in the same axes differ in colour and dash. Default: new axes.
    label : str
        Entry in the legend. Default: no legend.
    **style
        Keywords of Matplotlib's `Axes.plot` for the curve, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Axes with time [s] and position [rad], velocity [rad/s] or acceleration [rad/s²].

    Raises
    ------
    InputError
        `what` has an unknown value.
    """
    if what not in _DERIVATIVES:
        expected = alternatives(tuple(_DERIVATIVES))
        raise InputError(f"{expected} is expected", argument="what", value=what)
    axes = axes_or_new(ax)
    time = np.linspace(0.0, wanted.duration, 1201)
    line = Line(
        look=LOOKS[len(axes.lines) % len(LOOKS)],
        label=label,
        across=time,
        up=wanted.sample(time)[tuple(_DERIVATIVES).index(what)],
        series=True,
    )
    panel = Panel(across="time [s]", up=f"desired {what} [{_DERIVATIVES[what]}]", marks=(line,))
    draw(axes, panel, style, (line,), loc="upper right")
    if label:
        _room_for_legend(axes)
    return axes


def _room_for_legend(axes: Axes) -> None:
    """Make room for a legend above the curves, in all axes that share the scale."""
    family = axes.get_shared_y_axes().get_siblings(axes)
    drawn = [other for other in family if other.lines]
    low = min(float(other.dataLim.ymin) for other in drawn)
    high = max(float(other.dataLim.ymax) for other in drawn)
    labels = (other.get_legend_handles_labels()[1] for other in drawn)
    entries = max(map(len, labels))
    size = high - low or 1.0
    axes.set_ylim(low - 0.05 * size, high + (0.05 + 0.13 * entries) * size)


def _named(runs: Runs) -> Mapping[str, Recording]:
    named = (
        {"": runs}
        if isinstance(runs, Recording)
        else require_mapping("runs", runs, "{'before': recording}")
    )
    for run in named.values():
        require_kind("runs", run, Recording)
    if not named:
        raise InputError(
            "there is no recording to draw; give one recording, or several by name",
            argument="runs",
            value=runs,
        )
    return named


def _error(run: Recording, name: str, settling: float | None) -> TrackingError:
    if isinstance(run, SimulatedRecording):
        error = run.tracking_error()
    elif run.reference is None:
        raise InputError(
            "the recording has no reference, so there is no tracking error",
            argument=_argument(name),
        )
    else:
        error = np.asarray(run.position - run.reference)
    elapsed = run.time - run.time[0]
    later = elapsed >= (elapsed[-1] / 6.0 if settling is None else settling)
    size = float(np.sqrt(np.mean(error[later] ** 2)))
    return TrackingError(name=name, time=elapsed, error=error, size=size)


def _argument(name: str) -> str:
    return f"runs.{name}" if name else "runs"
