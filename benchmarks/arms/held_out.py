"""Prediction of a held-out part of a motion: integrals of torque over windows."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arms.classical import Array, Mask


def folds(time: Array, begin: float, end: float, number: int) -> Iterator[Mask]:
    """Return masks of held-out samples: `number` blocks one after the other."""
    edges = np.linspace(begin, end, number + 1)
    for low, high in itertools.pairwise(edges):
        yield (time >= low) & (time < high)


@dataclass(frozen=True)
class Windows:
    """Windows of even length inside a block: first and last sample of each."""

    first: NDArray[np.intp]
    last: NDArray[np.intp]

    @staticmethod
    def of(time: Array, block: Mask, length: float) -> Windows:
        """Return adjacent windows; the rest at the block's end is not used."""
        inside = np.flatnonzero(block)
        edges = np.arange(time[inside[0]], time[inside[-1]] + 1e-12, length)
        at = np.searchsorted(time, edges - 1e-12)
        return Windows(at[:-1], at[1:])

    def integrals(self, time: Array, values: Array) -> Array:
        """Return integrals over the windows by the trapezoidal rule, (windows, joints)."""
        steps = 0.5 * (values[1:] + values[:-1]) * np.diff(time)[:, None]
        total = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(steps, axis=0)])
        return np.asarray(total[self.last] - total[self.first])


@dataclass(frozen=True)
class Share:
    """Sums of squares of the windows' residuals and torques per joint, gathered over blocks."""

    residual: Array
    size: Array

    @staticmethod
    def gathered(measured: list[Array], predicted: list[Array]) -> Share:
        """Return the share of windows of several blocks."""
        real, told = np.concatenate(measured), np.concatenate(predicted)
        return Share(
            np.sqrt(((real - told) ** 2).sum(axis=0)),
            np.sqrt((real**2).sum(axis=0)),
        )

    @property
    def joints(self) -> Array:
        """Return the relative residual of each joint."""
        return np.asarray(self.residual / self.size)

    @property
    def total(self) -> float:
        """Return the relative residual of all joints together [of N·m·s]."""
        return float(np.linalg.norm(self.residual) / np.linalg.norm(self.size))
