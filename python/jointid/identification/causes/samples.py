"""Blocks of neighboring samples of a recording, for signals that depend on single samples."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass

Array = NDArray[np.float64]

# Samples per block. Their arrays fit in the processor's cache, and Ctrl-C takes effect between two blocks.
AT_A_TIME = 1 << 15


class Run(Protocol):
    """Motion of one joint in a recording, in SI units; each signal has the shape (samples,)."""

    @property
    def time(self) -> Array:
        """Time [s]."""

    @property
    def position(self) -> Array:
        """Position [rad or m]."""

    @property
    def velocity(self) -> Array:
        """Velocity [rad/s or m/s]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """Run that consists only of the motion of one joint."""

    time: Array
    position: Array
    velocity: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Samples:
    """Samples of a run, in SI units.

    Attributes
    ----------
    cut : slice
        Place of the samples in the run.
    time, position, velocity : ndarray, shape (samples,)
    begin : float
        Start time of the run [s].
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
    """Yield all samples of a run in blocks."""
    count = len(run.time)
    for first in range(0, count, AT_A_TIME):
        yield Samples.of(run, slice(first, min(count, first + AT_A_TIME)))


def span_of(run: Run) -> float:
    """Return the duration of a run [s]."""
    return float(run.time[-1] - run.time[0])


def window_blocks(bounds: NDArray[np.int64]) -> Iterator[tuple[slice, slice]]:
    """Yield blocks of neighboring windows, and the samples that they need.

    Parameters
    ----------
    bounds : ndarray, shape (windows, 2)
        First and last sample of each window, both ascending.
    """
    begin = 0
    while begin < len(bounds):
        first = int(bounds[begin, 0])
        end = int(np.searchsorted(bounds[:, 1], first + AT_A_TIME, side="right"))
        end = max(end, begin + 1)  # a single window may be longer than a block
        yield slice(begin, end), slice(first, int(bounds[end - 1, 1]) + 1)
        begin = end


class WaySinceReversal:
    """Distance since the last reversal.

    Each stop also counts as a reversal. For a long recording there is no array of all samples: a request sums from the
    end of the last known block.

    Parameters
    ----------
    run : Run
    """

    def __init__(self, run: Run) -> None:
        self._run = run
        # For each block of samples: the total distance before it, and the distance at the last reversal.
        self._before = [(0.0, 0.0)]

    def of(self, cut: slice) -> Array:
        """Return the distance since the last reversal at each of these samples [rad or m]."""
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
        first = max(cut.start - 1, 0)  # the previous sample gives the step to the first one
        turned = np.sign(self._run.velocity[first : cut.stop])
        steps = np.abs(np.diff(self._run.position[first : cut.stop]))
        ways = np.cumsum(np.concatenate([[way], steps]))
        change = turned == 0.0
        change[1:] |= turned[1:] * turned[:-1] < 0.0
        change[0] |= cut.start == 0
        # The distance never decreases, so its largest value at a reversal is that at the last reversal.
        last = np.maximum.accumulate(np.where(change, ways, reached))
        if block + 1 == len(self._before):
            self._before.append((float(ways[-1]), float(last[-1])))
        return np.asarray((ways - last)[cut.start - first :])
