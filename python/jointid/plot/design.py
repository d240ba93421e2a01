"""Plot of a designed motion: its course within its limits, and the time spent at each velocity."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.panels.design import DesignedMotion, motion, sampled_velocities
from jointid.panels.marks import Line
from jointid.plot.appearance import style as our_style
from jointid.plot.drawing import draw, of_kind

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def designed_motion(
    design: DesignedMotion, ax: Sequence[Axes] | None = None, **style: Any
) -> tuple[Axes, Axes, Axes]:
    """Draw a design: position and velocity over time, and the time spent at each velocity.

    Parameters
    ----------
    design : Design
        A design from `design` or `load_design`.
    ax : sequence of three Axes, optional
        Axes to draw into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the reference, e.g. ``color="black"``.

    Returns
    -------
    tuple of Axes
        First two axes: position [rad] or [m] and velocity [rad/s] or [m/s] over time [s], with their limits and the
        range over all drawn joints. Third axes: share of the time [%] over velocity, with the nominal joint's
        friction [N·m] or [N] on the right.

    Raises
    ------
    InputError
        The number of axes is not three.

    Examples
    --------
    >>> design = jid.load_design("motion.toml")
    >>> jid.plot.designed_motion(design)
    """
    axes = _axes(ax)
    panels = (*motion(design).panels, *sampled_velocities(design).panels)
    for each, panel in zip(axes, panels, strict=True):
        above = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "ncols": 3}
        draw(each, panel, style, of_kind(panel, Line), **above)
    return axes


def _axes(axes: Sequence[Axes] | None) -> tuple[Axes, Axes, Axes]:
    """Return three axes. New axes are one above the other, and the first two share the time."""
    if axes is None:
        from matplotlib import pyplot

        with our_style():
            drawn = pyplot.subplots(3, 1, figsize=(7.0, 7.5))[1]
        drawn[1].sharex(drawn[0])
        return drawn[0], drawn[1], drawn[2]
    given = list(itertools.islice(axes, 4))
    if len(given) != 3:
        raise InputError("three axes are expected", argument="ax", value=len(given))
    return given[0], given[1], given[2]
