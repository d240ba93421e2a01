"""Balances that explain the torque and the sensor reading in smooth windows, for the estimation of delays."""

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

SMALL = 3e-4  # [s]; a shorter delay of torque or sensor is not corrected
SUSPECT = 0.6  # share of the shortest corrected delay, from which on the delay is refined
REACH = 0.006  # [s] longest delay in the search; at low sampling rates three samples
_CLEAR = 3  # samples between a window and a reversal


def reach(period: float) -> float:
    """Return the longest delay of the search [s]."""
    return max(REACH, 3.0 * period)


def margin(stretch: Stretch) -> int:
    """Return by how many samples the signals of a stretch may be shifted."""
    return int(2.0 * reach(stretch.period) / stretch.period) + 2


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Pieces of the recordings with the balances of torque and reading.

    Attributes
    ----------
    pieces : sequence of Piece
    """

    pieces: Sequence[Piece]

    @functools.cached_property
    def torque(self) -> Balance:
        """Balance of the torque: inertia, gravity and friction."""
        return self.torque_otherwise()

    @functools.cached_property
    def first_look(self) -> Shift | None:
        """Delay of the torque, not refined if it is clearly short."""
        return fit_shift(self.torque, least=SUSPECT * SMALL)

    @functools.cached_property
    def inertia(self) -> float:
        """Inertia of drive and link, estimated from the torque."""
        look = self.first_look
        known = None if look is None else look.leading
        return leading_coefficient(self.torque) if known is None else known

    def torque_otherwise(self, *, clear: bool = False, varying: bool = False) -> Balance:
        """Return the torque's balance without reversals, or with an inertia that varies with the angle.

        Parameters
        ----------
        clear : bool
            Whether to leave out windows near reversals. Default False.
        varying : bool
            Whether the inertia may vary with the angle. Default False.
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
        """Balance of the sensor reading: link inertia, gravity and a constant."""
        return self.reading_otherwise()

    def reading_otherwise(self, factor: int = 1, *, varying: bool = False) -> Balance:
        """Return the reading's balance over longer windows, or with an inertia that varies with the angle.

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
            # In a control cycle the sensor is read before the new command acts. If the torque jumps at a sample, the
            # reading shows the acceleration of the interval before it.
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
            conservative=1,  # the acceleration of a held torque, apart from gravity
            held=False,
        )

    def answer(self) -> float:
        """Return the change of the reading when the torque changes by 1: the link's share of the inertia."""
        return leading_coefficient(self.reading) / self.inertia if self.inertia else 0.0


def _series(own: Sequence[OwnSignal], *, friction: bool, taken: bool) -> list[Array]:
    """Return the integrals of own terms, either friction or not, with or without known torques.

    The drive's torque no longer contains the known torques.
    """
    return [each.series for each in own if each.friction == friction and (taken or not each.taken)]
