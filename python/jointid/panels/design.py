"""Pictures of a designed motion: its course within its limits, and the time spent at each velocity."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from jointid.joint.units import torque_unit, velocity_label
from jointid.panels.curves import friction_line, friction_terms, known_values
from jointid.panels.marks import Bars, Level, Line, Panel, Picture, Range

if TYPE_CHECKING:
    from jointid.joint.joint import Joint
    from jointid.simulation.peaks import Peaks
    from jointid.simulation.trajectory import Trajectory

Array = NDArray[np.float64]

_SAMPLES = 6001
_BINS = 40


class _Limits(Protocol):
    """Limits of a design that are drawn."""

    @property
    def position(self) -> tuple[float, float]:
        """Lowest and highest position."""

    @property
    def velocity(self) -> float:
        """Largest magnitude of the velocity."""


class DesignedMotion(Protocol):
    """Parts of a design that are drawn. It is a protocol, because designs import panels and not the reverse."""

    @property
    def trajectory(self) -> Trajectory:
        """The desired motion."""

    @property
    def duration(self) -> float:
        """Duration of the motion [s]."""

    @property
    def joint(self) -> Joint:
        """The nominal joint."""

    @property
    def limits(self) -> _Limits:
        """The limits of the motion."""

    @property
    def peaks(self) -> Peaks:
        """The largest values that joints reach."""


def motion(design: DesignedMotion) -> Picture:
    """Return position and velocity of the reference over time, with their limits."""
    time = np.linspace(0.0, design.duration, _SAMPLES)
    position, velocity, _ = design.trajectory.sample(time)
    slides = design.joint.kind == "prismatic"
    limits, peaks = design.limits, design.peaks
    panels = (
        _within(
            time,
            position,
            f"position [{'m' if slides else 'rad'}]",
            limits.position,
            peaks.position,
        ),
        _within(
            time,
            velocity,
            velocity_label(design.joint.kind),
            (-limits.velocity, limits.velocity),
            (-peaks.velocity, peaks.velocity),
            labelled=False,
        ),
    )
    return Picture(
        caption="Position and velocity of the reference, with their limits. Shaded: range of the "
        "simulated joints.",
        panels=panels,
    )


def _within(
    time: Array,
    values: Array,
    what: str,
    limits: tuple[float, float],
    reached: tuple[float, float],
    labelled: bool = True,
) -> Panel:
    """Return a signal of the reference with its limits and the joints' range."""
    names = ("joints reach", "reference", "limit") if labelled else ("", "", "")
    return Panel(
        across="time [s]",
        up=what,
        height=150,
        marks=(
            Range(label=names[0], low=reached[0], high=reached[1]),
            Line(look="second", label=names[1], across=time, up=values),
            Level(label=names[2], up=limits[0]),
            Level(up=limits[1]),
        ),
    )


def sampled_velocities(design: DesignedMotion) -> Picture:
    """Return the time that the joint spends at each velocity, and its friction there; empty if it does not move."""
    time = np.linspace(0.0, design.duration, _SAMPLES)
    velocity = design.trajectory.sample(time)[1]
    peak = float(np.abs(velocity).max())
    counts, edges = np.histogram(velocity, bins=np.linspace(-peak, peak, _BINS + 1))
    kind, values = design.joint.kind, known_values(design.joint)
    moves = peak > 0.0
    curves = [friction_line(values, peak, label="friction")] if friction_terms(values) else []
    panel = Panel(
        across=velocity_label(kind),
        up="share of the time [%]",
        height=130,
        marks=(Bars(look="second", edges=edges, up=100.0 * counts / len(velocity)),) * moves,
        right=tuple(curves * moves),
        right_up=f"friction [{torque_unit(kind)}]",
    )
    friction = ", and the nominal joint's friction" if panel.right else ""
    return Picture(
        caption=f"Time spent at each velocity{friction}.",
        panels=(panel,),
    )
