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
