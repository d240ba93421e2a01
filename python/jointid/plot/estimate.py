"""Plots of an estimate: friction map, window means, residuals, convergence of the search."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.panels import friction, search, windows
from jointid.panels.marks import Line, Points
from jointid.plot.appearance import axes_or_new
from jointid.plot.drawing import draw, of_kind
from jointid.recording.recording import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def friction_map(
    recording: Recording | None, estimate: Estimate, ax: Axes | None = None, **style: Any
) -> Axes:
    """Draw friction over velocity: one point per window, and the identified curve with its 95 % band.

    Parameters
    ----------
    recording : Recording or None
        Recording from which the points are computed. None: the windows of the estimate's fit.
    estimate : Estimate
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the identified curve, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Axes with velocity [rad/s] or [m/s] and friction [N·m] or [N].

    Raises
    ------
    InputError
        An argument has the wrong type, or the estimate cannot predict the recording.

    Examples
    --------
    >>> jid.plot.friction_map(recording, estimate).figure.savefig("friction.png")
    """
    if recording is not None:
        require_kind("recording", recording, Recording)
    require_kind("estimate", estimate, Estimate)
    shown = None if recording is None else estimate.predict(recording).windows
    (panel,) = friction.friction_map(estimate, shown).panels
    return draw(axes_or_new(ax), panel, style, of_kind(panel, Line), loc="upper left")


def window_means(estimate: Estimate, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the measured and the fitted mean of each window over time.

    Parameters
    ----------
    estimate : Estimate
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the fitted line, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Axes with time [s] and sensor's reading, torque [N·m] or force [N].

    Raises
    ------
    InputError
        The argument is not an estimate.
    """
    require_kind("estimate", estimate, Estimate)
    means, _ = windows.window_means(estimate).panels
    return draw(axes_or_new(ax), means, style, of_kind(means, Line))


def residuals(estimate: Estimate, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the mean residual (measured minus fitted) of each window over time.

    Parameters
    ----------
    estimate : Estimate
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the points, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Axes with time [s] and sensor's reading, torque [N·m] or force [N].

    Raises
    ------
    InputError
        The argument is not an estimate.
    """
    require_kind("estimate", estimate, Estimate)
    _, below = windows.window_means(estimate).panels
    return draw(axes_or_new(ax), below, style, of_kind(below, Points))


def convergence(estimate: Estimate, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the penalty over generations: best value so far, mean of the population, and final result.

    Parameters
    ----------
    estimate : Estimate
        Estimate from a genetic search.
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the curves of the penalty, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Axes with generation and penalty [(N·m·s)²], [(N·s)²] or [(sensor units·s)²], logarithmic.

    Raises
    ------
    InputError
        The identification used no genetic search.
    """
    require_kind("estimate", estimate, Estimate)
    if estimate.convergence is None:
        raise InputError(
            "this estimate was made without a genetic search, so it has no convergence to draw",
            argument="estimate",
        )
    (panel,) = search.convergence(estimate).panels
    return draw(axes_or_new(ax), panel, style, of_kind(panel, Line))
