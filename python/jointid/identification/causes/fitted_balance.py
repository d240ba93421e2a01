"""Interface of a fitted balance for the attribution: of a joint, a robot's joint, or a servo.

The candidates use only this class. If a balance lacks something, it returns nothing, and the candidates that need it
are left out.
"""

from __future__ import annotations

import functools
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.base.values import dataclass
from jointid.identification.causes.samples import Run, Samples, span_of

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

FILTERED = "velocity, which is not the position's derivative"
LATE = ("torque", "sensor", "velocity", FILTERED)
"""Signals that may be late; a filtered velocity has no single delay."""


@dataclass(frozen=True, kw_only=True)
class FittedBalance(ABC):
    """Least-squares fit at its minimum, with one row per window in the order of time.

    Attributes
    ----------
    best : ndarray
        Parameters in the order of `names`.
    free : tuple of int
        Indices of the free parameters that are not on a bound.
    residual : ndarray, shape (windows,)
        Integrated torque that the model lacks [N·m·s].
    jacobian : ndarray, shape (windows, free)
        Derivatives of the residuals by the free parameters.
    start : ndarray, shape (free,)
        Steps of the free parameters that `residual` already contains.
    given : frozenset of str
        Names of the fixed parameters.
    group : int
        Number of windows of the original fit in one window here.
    """

    best: Array
    free: tuple[int, ...]
    residual: Array
    jacobian: Array
    start: Array
    given: frozenset[str] = frozenset()
    group: int = 1

    @property
    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """Names of all parameters."""

    @property
    @abstractmethod
    def terms(self) -> Sequence[_core.Term | None]:
        """Term of each coefficient in the core's table, in the order of `names`; None if it has no term."""

    @property
    @abstractmethod
    def columns(self) -> Array:
        """Integrals of the coefficients' terms, shape (windows, coefficients)."""

    @property
    @abstractmethod
    def duration(self) -> Array:
        """Integrated time of each window [s]."""

    @property
    @abstractmethod
    def run(self) -> Whole:
        """Index of each window's recording, ascending."""

    @property
    def neighbours(self) -> Whole:
        """Index of each window's group of neighbors: its recording, or its stretch of a recording."""
        return self.run

    @property
    @abstractmethod
    def spans(self) -> Array:
        """Start and end of each window on the clock of its recording [s], shape (windows, 2)."""

    @property
    @abstractmethod
    def window_duration(self) -> float:
        """Usual duration of a window of the fit [s]."""

    @property
    @abstractmethod
    def runs(self) -> Sequence[Run]:
        """Motion of the joint in each recording."""

    @property
    def duration_of_recording(self) -> float:
        """Duration of the longest recording [s]."""
        return max(map(span_of, self.runs))

    @property
    def run_names(self) -> Sequence[str]:
        """Names of the recordings."""
        return [f"recording {number}" for number in range(len(self.runs))]

    @property
    @abstractmethod
    def kind(self) -> Literal["revolute", "prismatic"]:
        """Kind of the joint."""

    @property
    @abstractmethod
    def gear_ratio(self) -> float:
        """Revolutions of the motor per revolution of the joint; 1 if unknown."""

    @property
    def knows_link(self) -> bool:
        """Whether inertia and gravity of the moved link are known, so that they are no candidates."""
        return False

    @property
    def has_torque(self) -> bool:
        """Whether torque was recorded; otherwise a known load over the angle gives the scale."""
        return True

    @property
    def load(self) -> Array | None:
        """Integrals of the torque through the gear; None if only motion and sensor can show it."""
        return None

    @property
    def further_signals(self) -> Mapping[str, Array]:
        """Signals of the only recording that the model does not use, one value per sample."""
        return {}

    @property
    def trusted(self) -> NDArray[np.bool_]:
        """Windows without saturated torque."""
        return np.ones(len(self.residual), dtype=bool)

    @property
    def sample_period(self) -> float:
        """Usual time between two samples [s]."""
        return float(np.median(np.diff(self.runs[0].time)))

    @property
    def torque_held(self) -> bool:
        """Whether the torque is known to be held between samples."""
        return False

    def late(self, signal: str) -> Array | None:  # noqa: ARG002
        """Return the change of the residual to first order if a signal is late by 1 s.

        Return None if the balance lacks the signal or knows that it is not late.
        """
        return None

    @abstractmethod
    def integral_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """Return the integral over each window of a signal, computed from blocks of samples.

        Each value of the signal depends on one sample only. The values have the shape (samples,) or (samples, m).
        """

    @abstractmethod
    def rise_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """Return the rise of such a signal over the integrated part of each window."""

    @abstractmethod
    def identified_with(self, **changes: Any) -> tuple[Action, ...]:
        """Return advice to identify with these fields of the model."""

    def with_offset(self) -> tuple[Action, ...]:
        """Return advice against a constant torque that the model lacks."""
        return (Action("call", {"torque_offset": True}, function="Joint"),)

    @abstractmethod
    def compared_with(self, **changes: Any) -> tuple[Action, ...]:
        """Return advice to compare with such a model, which the recordings may not determine."""

    @property
    @abstractmethod
    def model_name(self) -> str:
        """Name of the friction model."""

    @property
    def orders(self) -> Mapping[str, tuple[float, ...]]:
        """Orders of the model's torques over the joint angle, "harmonics", and over the motor angle, "ripple"."""
        return {}

    @property
    def is_asymmetric(self) -> bool:
        """Whether the model's friction differs between the directions."""
        return any(name.endswith("_positive") for name in self.names)

    @functools.cached_property
    def friction(self) -> list[int]:
        """Indices of the friction coefficients that do not depend on a load."""
        return [
            index
            for index, term in enumerate(self.terms)
            if term is not None and term.friction and not term.needs_load
        ]

    def value(self, name: str) -> float:
        """Return the value of a parameter; 0 if the model lacks it."""
        return float(self.best[self.names.index(name)]) if name in self.names else 0.0

    def is_faint(self, least: float) -> bool:
        """Return whether the residual is less than this share of the friction, which sampling alone may cause."""
        left = self.residual + self.jacobian @ (
            self.solve(self.jacobian, self.residual) - self.start
        )
        friction = np.zeros(len(left))
        for index in self.friction:
            friction += self.best[index] * self.columns[:, index]
        return float(np.sum(left**2)) < least**2 * float(np.sum(friction**2))

    def at_own_minimum(self) -> Self:
        """Return the fit at the minimum of these rows, so that the step from another minimum belongs to no cause."""
        step = self.solve(self.jacobian, self.residual)
        return replace(self, residual=self.residual + self.jacobian @ step)

    def solve(self, columns: Array, residual: Array) -> Array:
        """Return the least-squares steps of columns that reduce the residual; the first columns are parameters."""
        size = np.sqrt(np.einsum("ij,ij->j", columns, columns))
        size = np.where(size > 0.0, size, 1.0)
        scaled = columns / size
        square = np.einsum("ni,nj->ij", scaled, scaled) + 1e-12 * np.eye(len(size))
        found = np.linalg.solve(square, -np.einsum("ni,n->i", scaled, residual)) / size
        found[: len(self.start)] += self.start
        return np.asarray(found)
