"""What recordings tell about a joint already: information, and joints that are still possible."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError

Array = NDArray[np.float64]

_FACTOR = 3.0  # between a value and the farthest joint that is drawn, where nothing else bounds it
_WIDEST = 0.5  # of the value: a standard deviation beyond it is drawn as this


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Known:
    """Information about parameters, from recordings that are there.

    Attributes
    ----------
    names : tuple of str
        Of parameters; of others nothing is known.
    information : ndarray, shape (p, p)
        Inverse of the covariance [1 / product of the two units]; singular where a direction is not determined.
    """

    names: tuple[str, ...]
    information: Array

    def __post_init__(self) -> None:
        count = len(self.names)
        matrix = np.asarray(self.information, dtype=np.float64)
        if matrix.shape != (count, count) or not np.isfinite(matrix).all():
            raise InputError(
                f"a finite matrix of {count} x {count} is expected, as many as names",
                argument="known.information",
            )
        object.__setattr__(self, "information", 0.5 * (matrix + matrix.T))

    def stderr(self) -> dict[str, float]:
        """The standard errors that this information alone leaves, by name; infinite where it does not determine."""
        scale = np.sqrt(np.diag(self.information))
        told = scale > 0.0
        errors = dict.fromkeys(self.names, float("inf"))
        if not told.any():
            return errors
        scale = scale[told]
        values, vectors = np.linalg.eigh(
            self.information[np.ix_(told, told)] / np.outer(scale, scale)
        )
        weak = values <= 1e-10 * values[-1]
        lost = np.abs(vectors[:, weak]).max(axis=1, initial=0.0) > 1e-3
        inverse = np.where(weak, 0.0, 1.0 / np.where(weak, 1.0, values))
        found = np.sqrt((vectors**2) @ inverse) / scale
        names = [name for name, each in zip(self.names, told, strict=True) if each]
        for name, error, unknown in zip(names, found, lost, strict=True):
            errors[name] = float("inf") if unknown else float(error)
        return errors


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Told:
    """What an estimate tells of a joint's parameters.

    Attributes
    ----------
    known : Known
        Information as wide as the intervals are.
    values : ndarray, shape (p,)
    bounds : mapping of str to (float, float)
        That the user states, by name; None where there is none.
    scale : mapping of str to float
        What a parameter of either sign is held against, e.g. an offset against the torque.
    """

    known: Known
    values: Array
    bounds: Mapping[str, tuple[float | None, float | None]] = field(default_factory=dict)
    scale: Mapping[str, float] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """The free parameters."""
        return self.known.names

    def joints(self, count: int, seed: int = 0) -> tuple[dict[str, float], ...]:
        """Values of joints that the recordings leave possible; the first are the estimate's.

        A joint is drawn from the distribution of all parameters together: what the recordings tell only of a sum
        of two stays as it is while the two change. Where a joint would leave a bound, it is drawn nearer to the
        estimate.

        Parameters
        ----------
        count : int
            How many, 1 or more.
        seed : int
            The same seed gives the same joints. Default 0.
        """
        width, lower, upper = self._box()
        told, vectors = np.linalg.eigh(self.known.information * np.outer(width, width))
        # Not determined at all is drawn as badly determined: a joint ten times the estimate is another joint.
        lengths = 1.0 / np.sqrt(np.maximum(told, 1.0))
        drawn = np.random.default_rng(seed).standard_normal((max(count - 1, 0), len(self.names)))
        found = [dict(zip(self.names, self.values.tolist(), strict=True))]
        for each in drawn:
            step = width * (vectors @ (lengths * each))
            room = np.where(step > 0.0, upper - self.values, self.values - lower)
            share = float(np.min(np.where(step == 0.0, 1.0, room / np.maximum(abs(step), 1e-300))))
            inside = np.clip(self.values + min(share, 1.0) * step, lower, upper)
            found.append(dict(zip(self.names, inside.tolist(), strict=True)))
        return tuple(found)

    def _box(self) -> tuple[Array, Array, Array]:
        """The widest standard deviation that is drawn, and the bounds of what is drawn."""
        scale = np.array([self.scale.get(name, 0.0) for name in self.names])
        size = np.maximum(np.abs(self.values), scale)
        size = np.where(size > 0.0, size, 1.0)
        lower = np.where(scale > 0.0, self.values - _FACTOR * size, self.values / _FACTOR)
        upper = np.where(scale > 0.0, self.values + _FACTOR * size, self.values * _FACTOR)
        lower, upper = np.minimum(lower, upper), np.maximum(lower, upper)
        for i, name in enumerate(self.names):
            low, high = self.bounds.get(name, (None, None))
            if low is not None:
                lower[i] = min(max(lower[i], low), self.values[i])
            if high is not None:
                upper[i] = max(min(upper[i], high), self.values[i])
        return _WIDEST * size, lower, upper
