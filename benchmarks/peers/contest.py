"""The common problem of every peer: one penalty in two forms, one box, and an objective that ends the run."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from recordings import WELL_EXCITED

import jointid as jid
from jointid import _core
from jointid.identification.search.domain import domain_for
from jointid.problem.problem import Problem
from jointid.problem.terms import Request, choose_terms
from peers.numpy_penalty import NumpyPenalty

Array = NDArray[np.float64]
WINDOWS = 200
CLOSE = 1e-3  # of the optimal penalty
SAME = 1e-9  # between the two forms of the penalty


class Reached(BaseException):  # a library's `except Exception` must not catch it
    """The target is met."""


class Expired(BaseException):
    """The run's time is over."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Contest:
    """The problem, made once; arrays are over the six free parameters unless stated otherwise."""

    recording: jid.Recording
    joint: jid.Joint
    direct: _core.Penalty
    numpy: NumpyPenalty
    usable: NDArray[np.bool_]
    full_lower: Array
    full_upper: Array
    best: Array
    best_penalty: float

    @property
    def lower(self) -> Array:
        """Lower bounds."""
        return self.full_lower[1:]

    @property
    def upper(self) -> Array:
        """Upper bounds."""
        return self.full_upper[1:]

    @property
    def target(self) -> float:
        """Penalty at which the optimum counts as found."""
        return self.best_penalty * (1.0 + CLOSE)

    def sums(
        self,
    ) -> tuple[list[jid.Recording], list[NDArray[np.bool_]], NDArray[np.int64], list[int]]:
        """Return the arguments of `numpy_decay`."""
        windows = self.direct.windows
        return [self.recording], [self.usable], windows, [0] * len(windows)

    def full(self, free: Array) -> Array:
        """Return the parameters with the fixed inertia in front."""
        return np.concatenate([self.full_lower[:1], free])


def make_contest(recording: jid.Recording | None = None) -> Contest:
    """Both forms of the penalty, proved equal, and the optimum by the separable search.

    Raises
    ------
    AssertionError
        The two forms differ.
    """
    joint = jid.thesis_joint()
    if recording is None:
        recording = jid.load(WELL_EXCITED)
    problem, direct = problem_of(recording, joint, WINDOWS)
    domain = domain_for(direct, joint, None, problem.peak_speed)
    assert direct.names[0] == "inertia"
    usable = np.asarray(_core.usable_intervals(problem.in_core[0]), dtype=np.bool_)
    inertia = float(domain.lower[0])
    assert inertia == domain.upper[0]
    numpy = NumpyPenalty(recording, inertia, usable, direct.windows, direct.names[1:])
    compressed = _core.CompressedPenalty(direct, domain.lower, domain.upper)
    found = _core.minimise_separable(compressed, domain.lower, domain.upper).best
    best = _core.polish(direct, domain.lower, domain.upper, found).best
    contest = Contest(
        recording=recording,
        joint=joint,
        direct=direct,
        numpy=numpy,
        usable=usable,
        full_lower=domain.lower,
        full_upper=domain.upper,
        best=best[1:],
        best_penalty=direct(best),
    )
    prove_same(contest)
    return contest


def problem_of(
    recording: jid.Recording, joint: jid.Joint, windows: int | None
) -> tuple[Problem, _core.Penalty]:
    """Return the problem and its direct penalty as `identify` makes them for the residual of the thesis."""
    choice = choose_terms((recording,), joint, Request(residual="sensor"))
    problem = Problem(recordings=(recording,), joint=joint, choice=choice)
    return problem, problem.penalty(windows)


def prove_same(contest: Contest) -> None:
    """Check random candidates and the optimum: NumPy, one and many, against the compiled direct sum."""
    rng = np.random.default_rng(0)
    free = rng.uniform(contest.lower, contest.upper, (50, contest.lower.size))
    free = np.vstack([free, contest.best])
    compiled = contest.direct.evaluate(np.array([contest.full(x) for x in free]).T)
    single = np.array([contest.numpy(x) for x in free])
    worst = max(
        np.max(np.abs(form / compiled - 1.0)) for form in (single, contest.numpy.many(free))
    )
    assert worst < SAME, f"the NumPy penalty differs from the compiled one by {worst:g} (relative)"


class Objective:
    """The objective of a peer. Raises `Reached` at the very candidate that meets the target.

    Calling takes one candidate, `many` rows of them; `unit` and `many_unit` take the unit box.
    """

    def __init__(self, contest: Contest, *, compiled: bool, limit: float) -> None:
        self.contest, self.compiled = contest, compiled
        self.lower, self.upper = contest.lower, contest.upper
        self.width = self.upper - self.lower
        self.size = self.lower.size
        self.best = np.inf
        self.evaluations = 0
        self.starts = 0
        self._target = contest.target
        self._full = contest.full(contest.lower)
        self._free = self._full[1:]  # a view
        self._one: Callable[[Array], float] = contest.direct if compiled else contest.numpy
        self._ends = time.perf_counter() + limit

    def _settle(self, value: float, count: int) -> None:
        self.evaluations += count
        if value < self.best:
            self.best = value
            if value <= self._target:
                raise Reached
        if time.perf_counter() > self._ends:
            raise Expired

    def settled(self, value: float) -> float:
        """Take the value of a candidate that the peer evaluated without the objective."""
        self._settle(value, 1)
        return value

    def __call__(self, free: Array) -> float:
        """Return the penalty of one candidate."""
        if self.compiled:
            self._free[:] = free
            free = self._full
        value = self._one(free)
        self._settle(value, 1)
        return value

    def many(self, rows: Array) -> Array:
        """Return the penalties of many candidates, one per row."""
        rows = np.asarray(rows, dtype=np.float64)
        if self.compiled:
            full = np.empty((self.size + 1, len(rows)), order="F")
            full[0] = self._full[0]
            full[1:] = rows.T
            values = self.contest.direct.evaluate(full)
        else:
            values = self.contest.numpy.many(rows)
        self._settle(float(np.min(values)), len(rows))
        return values

    def unit(self, x: Array) -> float:
        """Return the penalty of one point of the unit box."""
        return self(self.lower + self.width * np.asarray(x))

    def many_unit(self, rows: Array) -> Array:
        """Return the penalties of points of the unit box, one per row."""
        return self.many(self.lower + self.width * np.asarray(rows))

    def residuals(self, free: Array) -> Array:
        """Return the residuals, one per window, for least squares."""
        if self.compiled:
            self._free[:] = free
            values = self.contest.direct.residuals(self._full)
        else:
            values = self.contest.numpy.residuals(free)
        self._settle(float(values @ values), 1)
        return values

    def jacobian(self, free: Array) -> Array:
        """Return the derivatives of the residuals, by the compiled penalty."""
        self._free[:] = free
        return self.contest.direct.jacobian(self._full)[:, 1:]
