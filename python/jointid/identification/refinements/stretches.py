"""Stretches of the recordings for the estimation of delays: uniformly sampled, without gaps, not too many."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.identification.refinements.smooth_windows import Stretch
from jointid.problem.own_balance import OwnSignal, own_signals
from jointid.problem.problem import Problem

Array = NDArray[np.float64]

_SHORTEST = 250  # samples
_PIECE = 12_000  # samples
_MOST = 60_000  # samples of all pieces; more do not improve the delay
_PART, _PARTS = 1200, 2  # length in samples, and number, of the parts for a first estimate
_UNEVEN = 1e-3  # largest deviation from an even grid, as a share of the sample period


@dataclass(frozen=True, kw_only=True)
class Piece:
    """Stretch of a recording with its signals.

    Attributes
    ----------
    stretch : Stretch
    angle : ndarray
        Position as an angle. For a prismatic axis, the travel is scaled to half a revolution.
    torque : ndarray
        Torque of the drive on the joint side, without known torques.
    sensor : ndarray or None
    held : bool
        Whether the torque is held between samples.
    own : tuple of OwnSignal
        Signals of the model's own terms.
    """

    stretch: Stretch
    angle: Array
    torque: Array
    sensor: Array | None
    held: bool
    own: tuple[OwnSignal, ...] = ()

    @cached_property
    def half(self) -> int:
        """Half the length of a window, in samples."""
        return self.stretch.half_length()

    @cached_property
    def circle(self) -> tuple[Array, Array]:
        """Cosine and sine of the angle."""
        cosine, sine = _core.circle(self.angle)
        return np.asarray(cosine), np.asarray(sine)


def pieces_of(problem: Problem) -> list[Piece]:
    """Return pieces of all recordings; if there are too many samples, only evenly chosen pieces."""
    spans = []
    for number, recording in enumerate(problem.recordings):
        edges = [0, *(gap.index + 1 for gap in recording.gaps), len(recording)]
        for first, last in itertools.pairwise(edges):
            parts = max(1, round((last - first) / _PIECE))
            length = (last - first) / parts
            cuts = [*(int(first + k * length) for k in range(parts)), last]
            spans += [(number, a, b) for a, b in itertools.pairwise(cuts) if b - a >= _SHORTEST]
    total = sum(last - first for _, first, last in spans)
    if total > _MOST:
        count = max(1, len(spans) * _MOST // total)
        spans = [spans[i] for i in np.linspace(0, len(spans) - 1, count).astype(int)]
    terms = problem.choice.model.resolved.terms
    own = {number: own_signals(terms, problem.recordings[number]) for number, _, _ in spans}
    return [_piece(problem, *span, own[span[0]]) for span in spans]


def few_of(stretches: Sequence[Stretch]) -> list[Stretch] | None:
    """Return short, evenly chosen parts of stretches for a first estimate; None if that saves too little."""
    cuts = [
        (stretch, first)
        for stretch in stretches
        for first in range(0, len(stretch.time) - _PART + 1, _PART)
    ]
    if len(cuts) < 2 * _PARTS:
        return None
    return [_part(*cuts[(len(cuts) - 1) * (2 * k + 1) // (2 * _PARTS)]) for k in range(_PARTS)]


def _part(whole: Stretch, first: int) -> Stretch:
    cut = slice(first, first + _PART)
    return Stretch(
        time=whole.time[cut],
        position=whole.position[cut],
        velocity=whole.velocity[cut],
        usable=whole.usable[cut],
        derived=whole.derived,
    )


def _piece(
    problem: Problem, number: int, first: int, last: int, own: tuple[OwnSignal, ...]
) -> Piece:
    recording = problem.recordings[number]
    usable = np.asarray(_core.usable_intervals(problem.in_core[number], True), dtype=bool)
    both = np.ones(len(recording), dtype=bool)
    both[:-1] &= usable
    both[1:] &= usable
    cut = slice(first, last)
    time = recording.time[cut]
    grid, apart = _core.even_grid(time)
    uneven = apart > _UNEVEN * recording.sample_period
    torque = problem.unexplained_torque(number)

    def even(signal: Array) -> Array:
        return np.interp(grid, time, signal[cut]) if uneven else signal[cut]

    position = even(recording.position)
    angle = position
    if recording.kind == "prismatic":
        angle = np.pi * (position - position.mean()) / max(float(np.ptp(position)), 1e-300)
    return Piece(
        stretch=Stretch(
            time=grid,
            position=position,
            velocity=even(recording.velocity),
            usable=even(both.astype(np.float64)) > 0.999 if uneven else both[cut],
            derived=recording.velocity_derived,
        ),
        angle=angle,
        torque=even(torque),
        sensor=None if recording.sensor is None else even(recording.sensor),
        held=problem.hold(number) == "zoh",
        own=tuple(replace(each, series=even(each.series)) for each in own),
    )
