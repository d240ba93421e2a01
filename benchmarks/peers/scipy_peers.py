"""SciPy: differential evolution, one candidate at a time and vectorised, and least squares from many starts."""

from __future__ import annotations

import numpy as np
from scipy.optimize import Bounds, differential_evolution, least_squares

from peers.contest import Objective
from peers.peer import Peer
from peers.starts import near_optimum

TIGHT = 1e-12  # the penalty is of the order of 1e-4, so the default tolerances would stop too early


def evolution(objective: Objective, seed: int) -> None:
    """The documentation's call; tol and the final L-BFGS-B polish are the defaults."""
    bounds = Bounds(objective.lower, objective.upper)
    differential_evolution(objective, bounds, rng=np.random.default_rng(seed))


def vectorised(objective: Objective, seed: int) -> None:
    """Evolve as the documentation advises for a vectorised function: one population per call, deferred updating."""

    def many(columns: np.ndarray) -> np.ndarray:
        if columns.ndim == 1:  # the polish passes a single candidate
            return np.asarray(objective(columns))
        return objective.many(columns.T)

    differential_evolution(
        many,  # type: ignore[arg-type]  # the stubs do not know `vectorized`
        Bounds(objective.lower, objective.upper),
        rng=np.random.default_rng(seed),
        vectorized=True,
        updating="deferred",
    )


def _least_squares(objective: Objective, start: np.ndarray) -> None:
    least_squares(
        objective.residuals,
        start,
        jac=objective.jacobian if objective.compiled else "2-point",
        bounds=(objective.lower, objective.upper),
        x_scale=objective.width,
        ftol=TIGHT,
        xtol=TIGHT,
        gtol=TIGHT,
    )


def multi_start(objective: Objective, seed: int) -> None:
    """Trust region reflective from one random start; the contest starts it again until it succeeds."""
    rng = np.random.default_rng(seed)
    _least_squares(objective, rng.uniform(objective.lower, objective.upper))


def good_start(objective: Objective, seed: int) -> None:
    """The same from near the optimum."""
    _least_squares(objective, near_optimum(objective, seed))


def peers() -> list[Peer]:
    """Each with both forms of the penalty."""
    rows = {
        "SciPy differential_evolution": evolution,
        "SciPy differential_evolution, vectorized": vectorised,
        "SciPy least_squares, random starts": multi_start,
        "SciPy least_squares, start within 20 %": good_start,
    }

    def given(name: str, form: str) -> str:
        if "least_squares" not in name:
            return "values"
        return "residuals" if form == "NumPy" else "residuals, Jacobian"

    return [
        Peer(name=name, form=form, solve=solve, given=given(name, form))
        for name, solve in rows.items()
        for form in ("NumPy", "compiled")
    ]
