"""A fitted balance as the attribution sees it: of one joint, of a robot's joint, or of a servo.

The candidates ask this class only. What a balance does not have, it answers with nothing, and the candidates that need
it are then left out.
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
"""Signals that may be late; a velocity behind a filter is late by no one time."""


@dataclass(frozen=True, kw_only=True)
class FittedBalance(ABC):
    """Least squares at their minimum, with a row for each window, in the order of time.

    Attributes
    ----------
    best : ndarray
        Parameters, in the order of `names`.
    free : tuple of int
        Those that vary and that no bound holds.
    residual : ndarray, shape (windows,)
        Torque that the model lacks, integrated [N·m·s].
    jacobian : ndarray, shape (windows, free)
        Derivatives of the residuals by the free parameters.
    start : ndarray, shape (free,)
        What has been added to the parameters in `residual`.
    given : frozenset of str
        Parameters that were not searched for.
    group : int
        Windows of the fit that one window here is the sum of.
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
        """Term in the core's table of each of the first parameters, the coefficients; None of one that has none."""

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
        """Number of each window's row of neighbours: of its recording, or of a stretch of one."""
        return self.run

    @property
    @abstractmethod
    def spans(self) -> Array:
        """First and last instant of each window, in the time of its recording [s], shape (windows, 2)."""

    @property
    @abstractmethod
    def window_duration(self) -> float:
        """Usual duration of a window of the fit [s]."""

    @property
    @abstractmethod
    def runs(self) -> Sequence[Run]:
        """The joint's motion in each recording."""

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
        """How the joint moves."""

    @property
    @abstractmethod
    def gear_ratio(self) -> float:
        """Turns of the motor per turn of the joint; 1 where it is not known."""

    @property
    def knows_link(self) -> bool:
        """Whether inertia and gravity of what the joint moves are described, so that they are not looked for."""
        return False

    @property
    def has_torque(self) -> bool:
        """Whether torque was recorded; otherwise its scale is that of a known load over the angle."""
        return True

    @property
    def load(self) -> Array | None:
        """Integrals of the torque through the gear; None where motion and sensor have to tell it."""
        return None

    @property
    def further_signals(self) -> Mapping[str, Array]:
        """Signals of the only recording besides those of the model, one value a sample."""
        return {}

    @property
    def trusted(self) -> NDArray[np.bool_]:
        """Windows in which the torque does not rest on a limit."""
        return np.ones(len(self.residual), dtype=bool)

    @property
    def sample_period(self) -> float:
        """Usual time between two samples [s]."""
        return float(np.median(np.diff(self.runs[0].time)))

    @property
    def torque_held(self) -> bool:
        """Whether the torque is known to hold from its sample to the next one."""
        return False

    def late(self, signal: str) -> Array | None:  # noqa: ARG002
        """Return by how much a signal that is 1 s late changes the residual, to first order.

        None where the balance does not have the signal, or knows that it is not late.
        """
        return None

    @abstractmethod
    def integral_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """Integral over each window of a signal that depends on each sample alone: of some samples at a time.

        Its values have the shape (samples,) or (samples, m).
        """

    @abstractmethod
    def rise_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """How far such a signal rises over the integrated part of each window."""

    @abstractmethod
    def identified_with(self, **changes: Any) -> tuple[Action, ...]:
        """Advice to identify with these fields of the model."""

    def with_offset(self) -> tuple[Action, ...]:
        """Advice against a constant torque that the model lacks."""
        return (Action("call", {"torque_offset": True}, function="Joint"),)

    @abstractmethod
    def compared_with(self, **changes: Any) -> tuple[Action, ...]:
        """Advice to compare with such a model, which the recordings may not determine."""

    @property
    @abstractmethod
    def model_name(self) -> str:
        """Name of the friction model."""

    @property
    def orders(self) -> Mapping[str, tuple[float, ...]]:
        """Orders of the model's torques over the joint's angle, "harmonics", and the motor's, "ripple"."""
        return {}

    @property
    def is_asymmetric(self) -> bool:
        """Whether the model's friction differs between the directions."""
        return any(name.endswith("_positive") for name in self.names)

    @functools.cached_property
    def friction(self) -> list[int]:
        """Places of the coefficients of friction that does not depend on a load."""
        return [
            index
            for index, term in enumerate(self.terms)
            if term is not None and term.friction and not term.needs_load
        ]

    def value(self, name: str) -> float:
        """Value of a parameter; 0 without it."""
        return float(self.best[self.names.index(name)]) if name in self.names else 0.0

    def is_faint(self, least: float) -> bool:
        """Whether the misfit is less than a part of the friction: sampling alone leaves as much."""
        left = self.residual + self.jacobian @ (
            self.solve(self.jacobian, self.residual) - self.start
        )
        friction = np.zeros(len(left))
        for index in self.friction:
            friction += self.best[index] * self.columns[:, index]
        return float(np.sum(left**2)) < least**2 * float(np.sum(friction**2))

    def at_own_minimum(self) -> Self:
        """Return the fit at the minimum of these rows alone: the step to it from that of more rows is no cause's."""
        step = self.solve(self.jacobian, self.residual)
        return replace(self, residual=self.residual + self.jacobian @ step)

    def solve(self, columns: Array, residual: Array) -> Array:
        """Return the least-squares steps along columns that take the residual away; the first are parameters."""
        size = np.sqrt(np.einsum("ij,ij->j", columns, columns))
        size = np.where(size > 0.0, size, 1.0)
        scaled = columns / size
        square = np.einsum("ni,nj->ij", scaled, scaled) + 1e-12 * np.eye(len(size))
        found = np.linalg.solve(square, -np.einsum("ni,n->i", scaled, residual)) / size
        found[: len(self.start)] += self.start
        return np.asarray(found)
