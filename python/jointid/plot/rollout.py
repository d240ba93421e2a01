"""Plots of a servo's rollouts: logged and simulated positions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.estimate.rollout import Rollout, RunRollout
from jointid.panels import rollout
from jointid.plot.appearance import axes_or_new
from jointid.plot.drawing import draw

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def rolled_out(
    result: Rollout, ax: Axes | None = None, *, run: str | int = 0, **style: Any
) -> Axes:
    """Draw the logged and the simulated position of a run, with the mean error in the legend.

    Parameters
    ----------
    result : Rollout
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    run : str or int
        Name or number of the run. Default: the first.
    **style
        Keywords of Matplotlib's `Axes.plot` for the simulated curve.

    Returns
    -------
    Axes
        Axes with time [s] and position [deg].

    Raises
    ------
    InputError
        The run does not exist.

    Examples
    --------
    >>> axes = jid.plot.rolled_out(jid.simulate(jid.identify(servo_runs, servo), recordings=servo_runs), run=3)
    """
    require_kind("result", result, Rollout)
    chosen = _run(result, run)
    picture = rollout.rolled_out(chosen)
    (panel,) = picture.panels
    axes = draw(axes_or_new(ax), panel, style, panel.marks[-1:])
    axes.set_title(picture.title)
    return axes


def _run(result: Rollout, run: str | int) -> RunRollout:
    names = [each.name for each in result.runs]
    if isinstance(run, str) and run in names:
        return result.runs[names.index(run)]
    if isinstance(run, int) and not isinstance(run, bool) and 0 <= run < len(names):
        return result.runs[run]
    raise InputError(
        f"there is no such run; the number of runs is {len(names)}", argument="run", value=run
    )
