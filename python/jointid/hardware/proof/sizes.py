"""Angles of a first motion for an encoder: as small as its counts allow."""

from __future__ import annotations

import math
from dataclasses import dataclass

from jointid.base.errors import InputError
from jointid.hardware.bench.bench import Bench
from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.session.drive import Drive

# Each one is an angle, or a number of counts if that is more.
_SPAN, _SPAN_COUNTS = math.radians(0.4), 40.0
_MOVE, _MOVE_COUNTS = math.radians(0.3), 20.0  # largest controlled motion
_FEW, _MORE = 5, 10  # counts of a fine encoder
_SEEN = math.radians(0.1)  # upper limit of both for a coarse encoder
_FEWEST = 2  # one count is jitter


@dataclass(frozen=True, slots=True, kw_only=True)
class Sizes:
    """Angles of a first motion [rad], by the joint file's gear ratio.

    Attributes
    ----------
    resolution : float
        Output angle of an encoder count.
    few, more : float
        Angle that counts as a motion; angle that must follow while the torque is held.
    span : float
        Default travel. The pushes are shares of it.
    travel : float
        Largest distance from the start.
    moves : tuple of float
        Amplitudes of the controlled motions.
    """

    resolution: float
    few: float
    more: float
    span: float
    travel: float
    moves: tuple[float, ...]

    @property
    def least(self) -> float:
        """Smallest angle of a push; one count may be jitter."""
        return _FEWEST * self.resolution

    def __str__(self) -> str:
        return (
            f"up to {math.degrees(self.travel):.2f}° ({self.travel:.4f} rad), with an encoder of "
            f"{math.degrees(self.resolution):.2g}° per count"
        )


def resolution_of(bench: Bench, drive: Drive) -> float:
    """Return the output angle of an encoder count [rad].

    Raises
    ------
    InputError
        Neither the bench nor the drive gives it.
    """
    resolution = bench.options.resolution or getattr(drive, "resolution", None)
    if resolution is None:
        raise InputError(
            "missing; this drive does not report the resolution of the encoder",
            argument="resolution",
        )
    return float(resolution)


def sizes_of(options: FirstMotionOptions, resolution: float) -> Sizes:
    """Return the angles of a first motion for an encoder count [rad]. Values in the options have priority.

    Raises
    ------
    InputError
        An amplitude is larger than the travel.
    """
    fitting = math.floor(_SEEN / (_FEW + _MORE) * _FEW / resolution)
    few = options.counts or max(_FEWEST, min(_FEW, fitting))
    more = options.more_counts or max(_FEWEST, min(_MORE, 2 * fitting))
    span = max(_SPAN, _SPAN_COUNTS * resolution)
    travel = options.travel or span
    largest = min(max(_MOVE, _MOVE_COUNTS * resolution), _MOVE / _SPAN * travel)
    moves = tuple(largest * share / 3.0 for share in (1.0, 2.0, 3.0))
    if options.moves is not None:
        moves = options.moves
    if max(moves, default=0.0) > travel:
        raise InputError(
            f"amplitudes of at most {travel:.4g} rad (the travel) are expected",
            argument="moves",
            value=moves,
        )
    return Sizes(
        resolution=resolution,
        few=few * resolution,
        more=more * resolution,
        span=span,
        travel=travel,
        moves=moves,
    )
