"""Pictures of runs over time: how far a joint misses its reference, its signals, what was asked of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from jointid.base.argument_checks import require_kind, require_mapping
from jointid.base.errors import InputError
from jointid.plot.appearance import given_or_new, line_style
from jointid.recording.recording import Recording
from jointid.simulation.simulated_recording import SimulatedRecording
from jointid.simulation.trajectory import FloatArray, Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Runs = Recording | Mapping[str, Recording]
# Unit of a rotating joint, and of a linear one.
_UNITS = {
    "position": ("rad", "m"),
    "velocity": ("rad/s", "m/s"),
    "acceleration": ("rad/s²", "m/s²"),
    "torque": ("N·m", "N"),
    "motor_torque": ("N·m", "N"),
    "current": ("A", "A"),
    "sensor": ("raw", "raw"),
    "reference": ("rad", "m"),
}


def tracking_error(runs: Runs, axes: Axes | None = None, *, settling: float | None = None) -> Axes:
    """Position less reference over time, with its root mean square in the legend.

    Parameters
    ----------
    runs : Recording or mapping of str to Recording
        One run, or several by name, e.g. ``{"before": a, "after": b}``. Of a simulated run the true
        position counts, not the encoder's.
    axes : Axes, optional
        Drawn into; default: new ones.
    settling : float, optional
        Time at the start that the root mean square leaves out [s]. Default: a sixth of each run.

    Raises
    ------
    InputError
        A run without a reference.
    """
    axes = given_or_new(axes)
    named = _named(runs)
    for number, (name, run) in enumerate(named.items()):
        error = 1e3 * _error(run, name)
        elapsed = run.time - run.time[0]
        later = elapsed >= (elapsed[-1] / 6.0 if settling is None else settling)
        size = float(np.sqrt(np.mean(error[later] ** 2)))
        told = f"rms {size:.3g} {_small(run)}"
        label = f"{name}: {told}" if name else told
        axes.plot(elapsed, error, label=label, **line_style(number, len(elapsed)))
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"position less reference [{_small(next(iter(named.values())))}]")
    _room_for_legend(axes)
    axes.legend(loc="upper right", frameon=False)
    return axes


def signal(runs: Runs, name: str, axes: Axes | None = None) -> Axes:
    """One signal over time, of a run or of several.

    Parameters
    ----------
    runs : Recording or mapping of str to Recording
    name : str
        "position", "velocity", "torque", "motor_torque", "current", "sensor" or "reference".
    axes : Axes, optional
        Drawn into; default: new ones.

    Raises
    ------
    InputError
        A signal that no recording has, or that this one lacks.
    """
    if name not in _UNITS:
        raise InputError(f"signal '{name}' is not known; known are {', '.join(_UNITS)}")
    axes = given_or_new(axes)
    named = _named(runs)
    for number, (label, run) in enumerate(named.items()):
        values = getattr(run, name, None)
        if values is None:
            raise InputError(f"the recording {label!r} has no {name}; it has {run.signals}")
        count = len(run.time) if len(named) > 1 else 0
        axes.plot(run.time, values, label=label, **line_style(number, count))
    unit = _UNITS[name][next(iter(named.values())).kind == "prismatic"]
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"{name.replace('_', ' ')} [{unit}]")
    if len(named) > 1:
        axes.legend(loc="best", frameon=False)
    return axes


def trajectory(
    wanted: Trajectory, what: str = "position", axes: Axes | None = None, *, label: str = ""
) -> Axes:
    """A desired motion over time.

    Parameters
    ----------
    wanted : Trajectory
    what : str
        "position" (default), "velocity" or "acceleration".
    axes : Axes, optional
        Drawn into; default: new ones. Several motions in one picture take turns in colour and dash.
    label : str
        For a legend.

    Raises
    ------
    InputError
        Another word for `what`.
    """
    derivatives = ("position", "velocity", "acceleration")
    if what not in derivatives:
        raise InputError(f"what is {what!r}; one of {', '.join(derivatives)} is expected")
    axes = given_or_new(axes)
    time = np.linspace(0.0, wanted.duration, 1201)
    values = wanted.sample(time)[derivatives.index(what)]
    axes.plot(time, values, label=label or None, **line_style(len(axes.lines)))
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"desired {what} [{_UNITS[what][0]}]")
    if label:
        _room_for_legend(axes)
        axes.legend(loc="upper right", frameon=False)
    return axes


def _room_for_legend(axes: Axes) -> None:
    """Room above the curves, of all axes that share the scale."""
    family = axes.get_shared_y_axes().get_siblings(axes)
    drawn = [other for other in family if other.lines]
    low = min(float(other.dataLim.ymin) for other in drawn)
    high = max(float(other.dataLim.ymax) for other in drawn)
    entries = max(len(other.lines) for other in drawn)
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
        raise InputError("there is no recording to draw; give one, or several by name")
    return named


def _error(run: Recording, name: str) -> FloatArray:
    if isinstance(run, SimulatedRecording):
        return run.tracking_error()
    if run.reference is None:
        raise InputError(f"the recording {name!r} has no reference, so there is no tracking error")
    return np.asarray(run.position - run.reference)


def _small(run: Recording) -> str:
    return "mm" if run.kind == "prismatic" else "mrad"
