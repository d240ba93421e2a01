"""Neighbouring samples of a recording: what depends on single samples alone is computed a part of it at a time."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

# Samples at a time: their arrays stay in the processor's cache, and Ctrl-C is answered between two parts.
AT_A_TIME = 1 << 15


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Samples:
    """Samples of a recording, in SI units.

    Attributes
    ----------
    cut : slice
        Which of the recording's they are.
    position, velocity : ndarray, shape (samples,)
    sensor : ndarray, shape (samples,), or None
    """

    cut: slice
    position: Array
    velocity: Array
    sensor: Array | None

    @classmethod
    def of(cls, recording: Recording, cut: slice) -> Samples:
        """Return some samples of a recording."""
        return cls(
            cut=cut,
            position=recording.position[cut],
            velocity=recording.velocity[cut],
            sensor=None if recording.sensor is None else recording.sensor[cut],
        )


def all_samples(recording: Recording) -> Iterator[Samples]:
    """Yield all samples of a recording, so many at a time."""
    for first in range(0, len(recording), AT_A_TIME):
        yield Samples.of(recording, slice(first, min(len(recording), first + AT_A_TIME)))


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
    run : Recording
    """

    def __init__(self, run: Recording) -> None:
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
            end = min(len(self._run), begin + size)
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
