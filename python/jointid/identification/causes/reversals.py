"""The way that a joint has gone since it last turned, for any samples of a recording."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.identification.causes import samples
from jointid.recording.recording import Recording

Array = NDArray[np.float64]


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
        size = samples.AT_A_TIME
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
