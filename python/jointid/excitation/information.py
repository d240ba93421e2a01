"""Information about parameters from earlier recordings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Known:
    """Information about parameters from existing recordings.

    Attributes
    ----------
    names : tuple of str
        Known parameters. Nothing is known about other parameters.
    information : ndarray, shape (p, p)
        Inverse of the covariance [1 / product of the two units]; singular if a combination is not determined.

    Examples
    --------
    >>> before = jid.Known(names=("coulomb", "viscous"), information=np.diag([4.0, 25.0]))
    >>> before.stderr()["viscous"]
    0.2
    """

    names: tuple[str, ...]
    information: Array

    def __post_init__(self) -> None:
        count = len(self.names)
        matrix = np.asarray(self.information, dtype=np.float64)
        if matrix.shape != (count, count) or not np.isfinite(matrix).all():
            raise InputError(
                f"a finite matrix of {count} x {count} is expected, one row for each name",
                argument="known.information",
            )
        object.__setattr__(self, "information", 0.5 * (matrix + matrix.T))

    def stderr(self) -> dict[str, float]:
        """Return the standard error of each parameter by name; infinite if the information does not determine it."""
        scale = np.sqrt(np.diag(self.information))
        seen = scale > 0.0
        errors = dict.fromkeys(self.names, float("inf"))
        if not seen.any():
            return errors
        scale = scale[seen]
        values, vectors = np.linalg.eigh(
            self.information[np.ix_(seen, seen)] / np.outer(scale, scale)
        )
        weak = values <= 1e-10 * values[-1]
        lost = np.abs(vectors[:, weak]).max(axis=1, initial=0.0) > 1e-3
        inverse = np.where(weak, 0.0, 1.0 / np.where(weak, 1.0, values))
        found = np.sqrt((vectors**2) @ inverse) / scale
        names = [name for name, each in zip(self.names, seen, strict=True) if each]
        for name, error, unknown in zip(names, found, lost, strict=True):
            errors[name] = float("inf") if unknown else float(error)
        return errors
