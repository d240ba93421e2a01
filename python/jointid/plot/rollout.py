"""Plots of a servo's rollouts: logged and simulated positions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.plot.appearance import FITTED, MEASURED, axes_or_new, look
from jointid.servo.rolling_out import Rollout, RunRollout

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def rolled_out(
    result: Rollout, ax: Axes | None = None, *, run: str | int = 0, **style: Any
) -> Axes:
    """Draw a run's position as logged and as its closed loop is simulated, with the mean error in the legend.

    Parameters
    ----------
    result : Rollout
    ax : Axes, optional
        Drawn into. Default: new axes.
    run : str or int
        Name or number of the run. Default: the first.
    **style
        Keywords of Matplotlib's `Axes.plot` for the simulated curve.

    Returns
    -------
    Axes
        Time [s], position [deg].

    Raises
    ------
    InputError
        No such run.

    Examples
    --------
    >>> axes = jid.plot.rolled_out(jid.rollout(jid.identify_servo(servo_runs, servo), servo_runs), run=3)
    """
    require_kind("result", result, Rollout)
    chosen = _run(result, run)
    axes = axes_or_new(ax)
    time = chosen.time - chosen.time[0]
    axes.plot(time, np.degrees(chosen.measured), color=MEASURED, label="logged")
    label = f"simulated, {np.degrees(chosen.error):.2f}° mean error"
    if chosen.bistable:
        label += ", bistable"
    axes.plot(time, np.degrees(chosen.position), **look(style, color=FITTED, label=label))
    axes.set_xlabel("time [s]")
    axes.set_ylabel("position [deg]")
    axes.set_title(chosen.name)
    axes.legend()
    return axes


def _run(result: Rollout, run: str | int) -> RunRollout:
    names = [each.name for each in result.runs]
    if isinstance(run, str) and run in names:
        return result.runs[names.index(run)]
    if isinstance(run, int) and not isinstance(run, bool) and 0 <= run < len(names):
        return result.runs[run]
    raise InputError(f"there is no such run; there are {len(names)}", argument="run", value=run)
