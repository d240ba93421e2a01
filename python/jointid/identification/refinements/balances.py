"""The balances that a torque and a sensor's reading are held against, window by window."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.identification.refinements.shift_fit import (
    Balance,
    Shift,
    fit_shift,
    leading_coefficient,
)
from jointid.identification.refinements.smooth_windows import Stretch
from jointid.identification.refinements.stretches import Piece
from jointid.problem.own_balance import OwnSignal

Array = NDArray[np.float64]

SMALL = 3e-4  # [s]; a shorter delay of torque or sensor is left alone
SUSPECT = 0.6  # of what would be long enough: look closer
REACH = 0.006  # [s] of the search for the least misfit; at slow rates three samples
_CLEAR = 3  # samples from a reversal, beside half a window


def reach(period: float) -> float:
    """The longest delay that is looked for [s]."""
    return max(REACH, 3.0 * period)


def margin(stretch: Stretch) -> int:
    """Samples that its signals may be shifted by."""
    return int(2.0 * reach(stretch.period) / stretch.period) + 2


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Pieces of the recordings, and what their signals are sums of.

    Attributes
    ----------
    pieces : sequence of Piece
    """

    pieces: Sequence[Piece]

    @functools.cached_property
    def torque(self) -> Balance:
        """The torque by inertia, gravity and friction."""
        return self.torque_otherwise()

    @functools.cached_property
    def first_look(self) -> Shift | None:
        """The torque's delay, not refined where it is clearly short."""
        return fit_shift(self.torque, least=SUSPECT * SMALL)

    @functools.cached_property
    def inertia(self) -> float:
        """Of drive and link, as the torque says."""
        look = self.first_look
        known = None if look is None else look.leading
        return leading_coefficient(self.torque) if known is None else known

    def torque_otherwise(self, *, clear: bool = False, varying: bool = False) -> Balance:
        """The torque's balance without the reversals, or with an inertia that varies with the angle.

        Parameters
        ----------
        clear, varying : bool
            Default False.
        """
        windows, columns, count = [], [], 0
        for piece in self.pieces:
            half, spare = piece.half, margin(piece.stretch)
            each = piece.stretch.windows(half, margin=spare, clear=half + spare if clear else 0)
            own = _series(piece.own, friction=False, taken=False)
            windows.append(each)
            columns.append(
                each.columns(
                    *piece.circle,
                    varying=varying,
                    friction=True,
                    own=own,
                    own_friction=_series(piece.own, friction=True, taken=False),
                )
            )
            count = (8 if varying else 4) + len(own)
        return Balance(
            windows=windows,
            signals=[piece.torque for piece in self.pieces],
            columns=columns,
            conservative=count,
            held=self.pieces[0].held,
        )

    @functools.cached_property
    def reading(self) -> Balance:
        """The sensor's reading by the link's inertia, gravity and a constant."""
        return self.reading_otherwise()

    def reading_otherwise(self, factor: int = 1, *, varying: bool = False) -> Balance:
        """The reading's balance over longer windows, or with an inertia that varies with the angle.

        Parameters
        ----------
        factor : int
            Factor on the windows' length. Default 1.
        varying : bool
            Whether the inertia may vary with the angle. Default False.
        """
        windows, columns = [], []
        for piece in self.pieces:
            half = factor * piece.half
            each = piece.stretch.windows(
                half, margin=margin(piece.stretch), clear=half + _CLEAR, usable_only=False
            )
            # Of a control cycle: the reading is taken before the new command acts. Where the torque jumps, the
            # acceleration is then that of the interval before the sample.
            jumps = piece.held and self.inertia > 0.0
            windows.append(each)
            columns.append(
                each.columns(
                    *piece.circle,
                    varying=varying,
                    friction=False,
                    own=_series(piece.own, friction=False, taken=True),
                    jumping=piece.torque if jumps else None,
                    answer=0.5 / self.inertia if jumps else 0.0,
                )
            )
        return Balance(
            windows=windows,
            signals=[piece.sensor for piece in self.pieces if piece.sensor is not None],
            columns=columns,
            conservative=1,  # apart: a held torque's acceleration, and gravity
            held=False,
        )

    def answer(self) -> float:
        """What the reading changes by where the torque changes by 1: the link's share of the inertia."""
        return leading_coefficient(self.reading) / self.inertia if self.inertia else 0.0


def _series(own: Sequence[OwnSignal], *, friction: bool, taken: bool) -> list[Array]:
    """Integrals of own terms, whose rates are columns: friction or what is none, with known torques or without.

    The drive's torque lacks the known torques already.
    """
    return [each.series for each in own if each.friction == friction and (taken or not each.taken)]
