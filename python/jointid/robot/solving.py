"""The linear parameters of all joints at once, each joint weighted by its own residual."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid.identification.inference.covariance import Covariance, parameter_covariance
from jointid.identification.inference.segments import Segments, usual_length

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_ROUNDS = 6  # of weights and values; they settle within three
_SETTLED = 1e-4


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Solution:
    """Values of a bounded, weighted least-squares problem.

    Attributes
    ----------
    values : ndarray, shape (parameters,)
    at_bound : ndarray of bool, shape (parameters,)
    residual : ndarray, shape (rows,)
        Unweighted.
    scatter : ndarray, shape (joints,)
        Root mean square of each joint's residuals.
    """

    values: Array
    at_bound: NDArray[np.bool_]
    residual: Array
    scatter: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Known:
    """What is known of the parameters beforehand: rows of unit variance beside those of the recording.

    Attributes
    ----------
    matrix : ndarray, shape (rows, parameters)
    wanted : ndarray, shape (rows,)
    """

    matrix: Array
    wanted: Array

    @classmethod
    def nothing(cls, count: int) -> Self:
        """Nothing is known of so many parameters."""
        return cls(matrix=np.zeros((0, count)), wanted=np.zeros(0))

    def padded(self, count: int) -> Known:
        """The same, with further parameters of which nothing is known."""
        more = np.zeros((len(self.wanted), count))
        return Known(matrix=np.hstack([self.matrix, more]), wanted=self.wanted)

    def tightened(self, factor: float) -> Known:
        """The same, as many times as certain."""
        return Known(matrix=factor * self.matrix, wanted=factor * self.wanted)

    def misfit(self, values: Array) -> float:
        """Squared distance of values from what is known."""
        return float(np.sum((self.wanted - self.matrix @ values) ** 2))


def solved(
    matrix: Array,
    wanted: Array,
    joint: Whole,
    joints: int,
    least: Array,
    known: Known | None = None,
) -> Solution:
    """Return the values that fit best, with the weight of each joint from its own residuals.

    Parameters
    ----------
    matrix : ndarray, shape (rows, parameters)
    wanted : ndarray, shape (rows,)
    joint : ndarray of int, shape (rows,)
    joints : int
    least : ndarray, shape (parameters,)
        Lower bounds.
    known : Known, optional
        Default: nothing.
    """
    scatter = scatter_of(wanted, joint, joints)
    values, at_bound = np.zeros(len(least)), np.zeros(len(least), dtype=bool)
    residual = wanted
    for _ in range(_ROUNDS):
        weight = 1.0 / scatter[joint]
        values, at_bound = bounded(matrix * weight[:, None], wanted * weight, least, known)
        residual = wanted - matrix @ values
        before, scatter = scatter, scatter_of(residual, joint, joints)
        if np.all(np.abs(scatter - before) <= _SETTLED * before):
            break
    return Solution(values=values, at_bound=at_bound, residual=residual, scatter=scatter)


def bounded(
    matrix: Array, wanted: Array, least: Array, known: Known | None = None
) -> tuple[Array, NDArray[np.bool_]]:
    """Return the least-squares values above lower bounds, and which are at them."""
    from scipy.linalg import qr
    from scipy.optimize import lsq_linear

    if known is not None and known.wanted.size:
        matrix = np.concatenate([matrix, known.matrix])
        wanted = np.append(wanted, known.wanted)
    count = matrix.shape[1]
    norms = np.linalg.norm(matrix, axis=0)
    present = np.flatnonzero(norms > 0.0)
    values, at_bound = np.zeros(count), np.zeros(count, dtype=bool)
    if not present.size:
        return values, at_bound
    scaled = np.column_stack([matrix[:, present] / norms[present], wanted])
    (triangle,) = qr(scaled, mode="r", overwrite_a=True)
    triangle = triangle[: present.size + 1]
    left, right = triangle[: present.size, :-1], triangle[: present.size, -1]
    free = np.linalg.lstsq(left, right, rcond=None)[0]
    lower = least[present] * norms[present]
    if np.any(free < lower):
        found = lsq_linear(left, right, bounds=(lower, np.inf), method="bvls")
        free = found.x
        at_bound[present] = found.active_mask < 0
        free = np.where(found.active_mask < 0, lower, free)
    values[present] = free / norms[present]
    return values, at_bound


def covariance_of(
    jacobian: Array, solution: Solution, joint: Whole, segments: Segments
) -> Covariance:
    """Return the covariance of the values whose derivatives these are, clustered over segments of motion."""
    weight = 1.0 / solution.scatter[joint]
    return parameter_covariance(
        jacobian * weight[:, None], solution.residual * weight, None, segments=segments
    )


def time_segments(start: Array, stop: Array, recording: Whole) -> Segments:
    """Return segments of equal duration over rows in the order of time: all joints of a stretch are one.

    What one joint's model misses acts on its neighbours in the same stretch.
    """
    first = np.flatnonzero(np.diff(recording, prepend=-1))
    spans = [
        float(stop[low:high].max() - start[low])
        for low, high in zip(first, [*first[1:], len(start)], strict=True)
    ]
    length = usual_length(sum(spans))
    cuts, between = [0], [0]
    for low, high, span in zip(first, [*first[1:], len(start)], spans, strict=True):
        count = max(1, round(span / length))
        for shift, found in ((0.0, cuts), (0.5, between)):
            ends = start[low] + span * (np.arange(1, count) - shift) / count
            found += [int(low + each) for each in np.searchsorted(start[low:high], ends)]
            found.append(int(high))
    return Segments(length=length, cuts=(np.unique(cuts), np.unique(between)))


def scatter_of(residual: Array, joint: Whole, joints: int) -> Array:
    """Root mean square by joint; of nothing 1."""
    power = np.bincount(joint, residual * residual, joints)
    count = np.bincount(joint, minlength=joints)
    rms = np.sqrt(power / np.maximum(count, 1))
    return np.where(rms > 0.0, rms, 1.0)
