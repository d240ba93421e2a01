"""Plot of a designed motion: where it goes within its limits, and where friction is sampled."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from jointid.base.errors import InputError
from jointid.joint.joint import Joint
from jointid.joint.units import velocity_label
from jointid.plot.appearance import FITTED, MEASURED, SECOND, look, style
from jointid.plot.friction import friction_curves
from jointid.simulation.peaks import Peaks
from jointid.simulation.trajectory import FloatArray, Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class _Limits(Protocol):
    """What is drawn of a design's limits."""

    @property
    def position(self) -> tuple[float, float]: ...
    @property
    def velocity(self) -> float: ...


class _Design(Protocol):
    """What is drawn of a design: whoever makes one uses this room, not the other way round."""

    @property
    def trajectory(self) -> Trajectory: ...
    @property
    def duration(self) -> float: ...
    @property
    def joint(self) -> Joint: ...
    @property
    def limits(self) -> _Limits: ...
    @property
    def peaks(self) -> Peaks: ...


_SAMPLES = 6001
_BINS = 60


def designed_motion(
    design: _Design, ax: Sequence[Axes] | None = None, **style: Any
) -> tuple[Axes, Axes, Axes]:
    """Draw a design: position and velocity over time, and how long it moves at each velocity.

    Parameters
    ----------
    design : Design
        Of `design_excitation`, or read by `load_design`.
    ax : sequence of three Axes, optional
        Drawn into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the reference, e.g. ``color="black"``.

    Returns
    -------
    tuple of Axes
        Position [rad] or [m] over time [s] and velocity [rad/s] or [m/s] over time, each with its limits
        and with what the joints reach; share of the time [%] over velocity, with the nominal joint's
        friction [N·m] or [N] behind it.

    Raises
    ------
    InputError
        Another number of axes than three.

    Examples
    --------
    >>> design = jid.load_design("motion.toml")
    >>> jid.plot.designed_motion(design)
    """
    over_time, speeds, sampled = _axes(ax)
    time = np.linspace(0.0, design.duration, _SAMPLES)
    position, velocity, _ = design.trajectory.sample(time)
    slides = design.joint.kind == "prismatic"
    largest, peaks = design.limits.velocity, design.peaks
    for drawn, values, allowed, reached, title in (
        (
            over_time,
            position,
            design.limits.position,
            peaks.position,
            f"position [{'m' if slides else 'rad'}]",
        ),
        (
            speeds,
            velocity,
            (-largest, largest),
            (-peaks.velocity, peaks.velocity),
            velocity_label(design.joint.kind),
        ),
    ):
        drawn.axhspan(*reached, color=MEASURED, alpha=0.25, linewidth=0.0, label="joints reach")
        drawn.plot(time, values, **look(style, color=SECOND, label="reference"))
        for number, limit in enumerate(allowed):
            drawn.axhline(
                limit,
                color=FITTED,
                linestyle="--",
                linewidth=1.0,
                label=None if number else "limit",
            )
        drawn.set_xlabel("time [s]")
        drawn.set_ylabel(title)
    over_time.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False)
    _where_friction_is_sampled(sampled, design, velocity)
    return over_time, speeds, sampled


def _where_friction_is_sampled(axes: Axes, design: _Design, velocity: FloatArray) -> None:
    """Draw the share of the time at each velocity, and behind it what friction is there."""
    largest = float(np.abs(velocity).max())
    if largest > 0.0:
        weights = np.full(velocity.shape, 100.0 / len(velocity))
        edges = np.linspace(-largest, largest, _BINS + 1)
        axes.hist(velocity, bins=edges.tolist(), weights=weights, color=SECOND, alpha=0.5)
        with style():
            beside = axes.twinx()
        with suppress(InputError):  # a joint without friction has no curve
            friction_curves({"friction": design.joint}, beside, peak=largest)
            for line in beside.lines:
                line.set_color(FITTED)
            beside.get_legend().remove()  # type: ignore[union-attr]
            beside.spines["right"].set_visible(True)
            beside.grid(visible=False)
            beside.yaxis.label.set_color(FITTED)
    axes.set_xlabel(velocity_label(design.joint.kind))
    axes.set_ylabel("share of the time [%]")


def _axes(axes: Sequence[Axes] | None) -> tuple[Axes, Axes, Axes]:
    """Three axes; new ones one above the other, the first two with one time."""
    if axes is None:
        from matplotlib import pyplot

        with style():
            drawn = pyplot.subplots(3, 1, figsize=(7.0, 7.5))[1]
        drawn[1].sharex(drawn[0])
        return drawn[0], drawn[1], drawn[2]
    given = list(itertools.islice(axes, 4))
    if len(given) != 3:
        raise InputError("three axes are expected", argument="ax", value=len(given))
    return given[0], given[1], given[2]
