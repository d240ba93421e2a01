"""Torque balance in smooth windows, for the estimation of delays.

A window with edges uses the velocity at its edges, and noise there makes short windows useless. A smooth window has a
weight that is zero at both ends (a modulating function). The mean acceleration is then a sum of the velocity, or of the
position, with the weight's derivatives. Noise averages out, and neighboring windows overlap by half.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Stretch:
    """Stretch of a recording without a gap.

    Attributes
    ----------
    time, position, velocity : ndarray, shape (n,)
    usable : ndarray of bool, shape (n,)
        Whether friction is defined at the sample: the joint neither sticks nor stands.
    derived : bool
        Whether the velocity was derived from the position.
    """

    time: Array
    position: Array
    velocity: Array
    usable: NDArray[np.bool_]
    derived: bool

    @cached_property
    def period(self) -> float:
        """Mean time between samples [s]."""
        return float(self.time[-1] - self.time[0]) / (len(self.time) - 1)

    def windows(
        self, half: int, *, margin: int, clear: int = 0, usable_only: bool = True
    ) -> _core.SmoothWindows:
        """Return smooth windows over the stretch, half a window apart.

        Parameters
        ----------
        half : int
            Half the length of a window, in samples.
        margin : int
            Number of samples by which a signal may be shifted.
        clear : int
            Smallest distance of a window's middle from a reversal, in samples. Default 0: no limit.
        usable_only : bool
            Whether windows with an unusable sample are left out. Default True.
        """
        return _core.SmoothWindows(
            self.time,
            self.position,
            self.velocity,
            self.usable,
            derived=self.derived,
            half=half,
            margin=margin,
            clear=clear,
            usable_only=usable_only,
        )

    def half_length(self, *, by_position: bool = False) -> int:
        """Return the shortest half length that averages the acceleration's noise to 1e-4 of its variance.

        Parameters
        ----------
        by_position : bool
            Whether to take the acceleration from the position, as for a derived velocity. Default False.
        """
        position = by_position or self.derived
        signal = self.position if position else self.velocity
        return _core.half_length(signal, self.period, position=position)
