"""The torque balance under smooth windows: the rows from which delays are estimated.

A window with edges takes the velocity at its edges, whose noise spoils short windows. Under a smooth weight
that is zero at both ends (a modulating function) the acceleration is the velocity, or the position itself,
summed with the weight's derivatives: noise averages out, and neighbouring windows overlap by half.
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
    """A stretch of a recording without a gap.

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
        """Smooth windows over the stretch, half a window from one to the next.

        Parameters
        ----------
        half : int
            Half the length of a window, in samples.
        margin : int
            Samples that a signal may be shifted by.
        clear : int
            No window has its middle nearer than this to a change of direction, in samples; 0: no such rule.
        usable_only : bool
            Whether windows that touch an unusable sample are left out.
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
            Whether the acceleration is taken from the position, as that of a derived velocity is.
        """
        position = by_position or self.derived
        signal = self.position if position else self.velocity
        return _core.half_length(signal, self.period, position=position)
