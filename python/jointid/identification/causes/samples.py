"""Neighbouring samples of a recording: what depends on single samples alone is computed a part of it at a time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass

Array = NDArray[np.float64]

# Samples at a time: their arrays stay in the processor's cache, and Ctrl-C is answered between two parts.
AT_A_TIME = 1 << 15


class Run(Protocol):
    """The motion of one joint in a recording, in SI units; each signal has the shape (samples,)."""

    @property
    def time(self) -> Array:
        """[s]."""

    @property
    def position(self) -> Array:
        """[rad or m]."""

    @property
    def velocity(self) -> Array:
        """[rad/s or m/s]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """A run of which a fit holds nothing but the motion of one joint."""

    time: Array
    position: Array
    velocity: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Samples:
    """Samples of a run, in SI units.

    Attributes
    ----------
    cut : slice
        Which of the run's they are.
    time, position, velocity : ndarray, shape (samples,)
    begin : float
        First instant of the run [s].
    """

    cut: slice
    time: Array
    position: Array
    velocity: Array
    begin: float

    @classmethod
    def of(cls, run: Run, cut: slice) -> Samples:
        """Return some samples of a run."""
        return cls(
            cut=cut,
            time=run.time[cut],
            position=run.position[cut],
            velocity=run.velocity[cut],
            begin=float(run.time[0]),
        )


def all_samples(run: Run) -> Iterator[Samples]:
    """Yield all samples of a run, so many at a time."""
    count = len(run.time)
    for first in range(0, count, AT_A_TIME):
        yield Samples.of(run, slice(first, min(count, first + AT_A_TIME)))


def span_of(run: Run) -> float:
    """Return how long a run lasts [s]."""
    return float(run.time[-1] - run.time[0])


def window_blocks(bounds: NDArray[np.int64]) -> Iterator[tuple[slice, slice]]:
    """Yield neighbouring windows, and the samples that they need.

    Parameters
    ----------
    bounds : ndarray, shape (windows, 2)
        First and last sample of each window, both ascending.
    """
    begin = 0
    while begin < len(bounds):
        first = int(bounds[begin, 0])
        end = int(np.searchsorted(bounds[:, 1], first + AT_A_TIME, side="right"))
        end = max(end, begin + 1)  # one window may be longer
        yield slice(begin, end), slice(first, int(bounds[end - 1, 1]) + 1)
        begin = end


class WaySinceReversal:
    """Way since the last change of direction.

    A stop between two directions is a reversal, too, and so is one between two of the same. Of all of a long
    recording there is no array: what is asked for is summed up from where the last block before it ended.

    Parameters
    ----------
    run : Run
    """

    def __init__(self, run: Run) -> None:
        self._run = run
        # Of each block of samples: all of the way before it, and of that what was gone at the last reversal.
        self._before = [(0.0, 0.0)]

    def of(self, cut: slice) -> Array:
        """Return the way at each of these samples [rad or m]."""
        size = AT_A_TIME
        first = min(cut.start // size, len(self._before) - 1)
        found = []
        for block in range(first, -(-cut.stop // size)):
            begin = block * size
            end = min(len(self._run.time), begin + size)
            gone = self._block(block, slice(begin, end))
            found.append(gone[max(cut.start - begin, 0) : max(cut.stop - begin, 0)])
        return np.concatenate(found)

    def _block(self, block: int, cut: slice) -> Array:
        way, reached = self._before[block]
        first = max(cut.start - 1, 0)  # the sample before, for the step to the first one
        turned = np.sign(self._run.velocity[first : cut.stop])
        steps = np.abs(np.diff(self._run.position[first : cut.stop]))
        ways = np.cumsum(np.concatenate([[way], steps]))
        change = turned == 0.0
        change[1:] |= turned[1:] * turned[:-1] < 0.0
        change[0] |= cut.start == 0
        # Ways grow: the largest of those at a change is that of the last change.
        last = np.maximum.accumulate(np.where(change, ways, reached))
        if block + 1 == len(self._before):
            self._before.append((float(ways[-1]), float(last[-1])))
        return np.asarray((ways - last)[cut.start - first :])
