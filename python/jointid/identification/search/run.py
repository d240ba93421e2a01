"""Search for the minimum of the penalty: genetic, random or separable; with checkpoints for long searches."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.estimate.statistics import Convergence
from jointid.identification.search.domain import SearchDomain
from jointid.identification.search.search import Search
from jointid.problem.inner_products import inner

Array = NDArray[np.float64]


# Largest error of the compressed penalty, as a share of the penalty and of the squared target.
_RELATIVE, _ABSOLUTE = 1e-9, 1e-13
_KEPT = 50_000  # largest number of windows for which the balance is kept

# Penalty, residuals, their derivatives, and columns.
Balance = tuple[float, Array, Array, Array]


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """Result of a search. Generations and evaluations do not include the polish.

    Attributes
    ----------
    balance : tuple or None
        Direct sum at `best`, if the search was verified by it and has few windows.
    """

    best: Array
    convergence: Convergence | None
    status: str
    message: str
    generations: int = 0
    evaluations: int = 0
    balance: Balance | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Engine:
    """Penalty that a search evaluates: compressed if that is exact, otherwise the direct sum.

    Attributes
    ----------
    direct : Penalty
        Sum over all samples, which verifies every result.
    form : PenaltyFunction
        Penalty that the search evaluates.
    reason : str
        Why compression failed; empty otherwise.
    threads : int
        0: all.
    """

    direct: _core.Penalty
    form: _core.PenaltyFunction
    reason: str
    threads: int = 0

    @classmethod
    def of(cls, penalty: _core.Penalty, domain: SearchDomain, threads: int) -> Engine:
        """Return an engine. It compresses the penalty if that saves time and is exact except for rounding.

        Parameters
        ----------
        penalty : Penalty
        domain : SearchDomain
        threads : int
            0: all.
        """
        compressed = _core.CompressedPenalty(penalty, domain.lower, domain.upper, threads=threads)
        if compressed.exact:
            return cls(direct=penalty, form=compressed, reason="", threads=threads)
        return cls(direct=penalty, form=penalty, reason=compressed.reason, threads=threads)

    def polished(self, domain: SearchDomain, start: Array) -> tuple[Array, int, bool]:
        """Return the optimum over the shapes' ranges and near a start, the number of steps, and whether it converged.

        With at most one free shape and the direct sum, it searches only near the start. With two shapes it uses
        projection, if the result is at least as good as the start.
        """
        shapes = free_shapes(self.direct, domain)
        if self.form is self.direct and shapes < 2:
            found = _core.polish(self.direct, domain.lower, domain.upper, start)
            return found.best, found.iterations, found.converged
        if shapes > 1:
            whole = _core.minimise_projected(
                self.direct, domain.lower, domain.upper, threads=self.threads
            ).found
            if whole is not None and whole.penalty <= self.form(start):
                return whole.best, whole.evaluations, True
        near = _core.refine_separable(
            self.form, domain.lower, domain.upper, start, threads=self.threads
        )
        if self.form is not self.direct:
            return near.best, near.evaluations, True
        last = _core.polish(self.direct, domain.lower, domain.upper, near.best)
        return last.best, near.evaluations + last.iterations, last.converged

    def verified(self, outcome: Outcome, domain: SearchDomain) -> Outcome:
        """Verify an outcome by the direct sum. If they disagree, return a polish by the direct sum."""
        if self.form is self.direct:
            because = f", by the direct sum because {self.reason}" if self.reason else ""
            return replace(outcome, message=outcome.message + because)
        best, direct = outcome.best, self.direct
        gain = 1.0
        if direct.residual == _core.Residual.sensor:
            gain = float(best[direct.names.index("sensor_gain")])
        # For hours of motion the arrays are not kept, to save memory.
        balance = direct.balance_at(best) if direct.window_count <= _KEPT else None
        expected = direct(best) if balance is None else balance[0]
        size = inner(direct.target, direct.target) / gain**2
        if abs(self.form(best) - expected) <= _RELATIVE * expected + _ABSOLUTE * size:
            return replace(outcome, balance=balance)
        found = _core.polish(direct, domain.lower, domain.upper, best)
        polished = (
            "the direct sum over all samples gave another penalty, so a polish of this sum followed"
        )
        message = f"{outcome.message}; {polished}"
        return replace(outcome, best=found.best, message=message)


def run_search(search: Search, penalty: _core.Penalty, domain: SearchDomain) -> Outcome:
    """Search for the minimum of a penalty in a domain.

    Parameters
    ----------
    search : Search
    penalty : Penalty
    domain : SearchDomain

    Raises
    ------
    InputError
        A checkpoint is unreadable or belongs to another search.
    KeyboardInterrupt
        Ctrl-C.
    """
    made = functools.partial(Engine.of, penalty, domain, search.threads)
    if search.chosen_method == "separable":
        return separable(search, penalty, domain, made)
    engine = made()
    run = _random if search.chosen_method == "random" else _genetic
    result = run(search, engine, domain)
    convergence = _convergence(result)
    outcome = concluded(search, engine, domain, result, int(convergence.generation[-1]))
    return replace(outcome, convergence=convergence)


def separable(
    search: Search, penalty: _core.Penalty, domain: SearchDomain, engine: Callable[[], Engine]
) -> Outcome:
    """Search by elimination of the linear parameters, and return the outcome.

    The projected search sums over the samples about twelve times and needs no engine. If it cannot guarantee the
    optimum, the engine's penalty is searched and the outcome is verified.
    """
    lower, upper = domain.lower, domain.upper
    projected = _core.minimise_projected(penalty, lower, upper, threads=search.threads)
    if projected.found is not None:
        return _found(projected.found, f"{_effort(projected.found)}, by projection")
    ready = engine()
    found = _core.minimise_separable(ready.form, lower, upper, threads=search.threads)
    message = "linear least squares, because the model has no free shape parameter"
    if free_shapes(penalty, domain):
        message = f"{_effort(found)}, not by projection: {projected.reason}"
    return ready.verified(_found(found, message), domain)


def _effort(found: _core.SeparableResult) -> str:
    return f"separable optimum after {found.evaluations} shapes"


def _found(found: _core.SeparableResult, message: str) -> Outcome:
    return Outcome(
        best=found.best,
        convergence=None,
        status="converged",
        message=message,
        evaluations=found.evaluations,
    )


def concluded(
    search: Search,
    engine: Engine,
    domain: SearchDomain,
    result: _core.GaResult | _core.TrialResult,
    generations: int,
) -> Outcome:
    """Return the verified outcome of a genetic or random search, polished if the settings require it."""
    best, status, message = _finished(search, engine, domain, result, generations)
    outcome = Outcome(
        best=best,
        convergence=None,
        status=status,
        message=message,
        generations=generations,
        evaluations=result.evaluations,
    )
    return engine.verified(outcome, domain)


def _random(search: Search, engine: Engine, domain: SearchDomain) -> _core.GaResult:
    return _core.minimise_random(
        engine.form,
        domain.lower,
        domain.upper,
        options=search.genetic,
        seed=search.seed,
        threads=search.threads,
        callback=search.callback,
    )


def _genetic(search: Search, engine: Engine, domain: SearchDomain) -> _core.GaResult:
    if search.checkpoint is not None and not Path(search.checkpoint).parent.is_dir():
        raise InputError(
            f"the folder {Path(search.checkpoint).parent} does not exist",
            argument="checkpoint",
            value=str(search.checkpoint),
            remedy="create it first",
        )
    state = None if search.resume is None else _read_state(Path(search.resume))
    try:
        result = _core.minimise_genetic(
            engine.form,
            domain.lower,
            domain.upper,
            options=search.genetic,
            seed=search.seed,
            threads=search.threads,
            callback=search.callback,
            resume=state,
            checkpoint=None
            if search.checkpoint is None
            else functools.partial(_write_state, search),
        )
    except InputError as error:
        if state is None or error.place == str(search.checkpoint):
            raise
        raise error.at(str(search.resume)) from error
    if search.checkpoint is not None and result.state is not None:
        _write_state(search, result.state)
    return result


def _write_state(search: Search, state: _core.GaState) -> None:
    if search.checkpoint is not None:
        from jointid.base.files import write_whole

        write_whole(Path(search.checkpoint), state.to_bytes())


def _finished(
    search: Search,
    engine: Engine,
    domain: SearchDomain,
    result: _core.GaResult | _core.TrialResult,
    generations: int,
) -> tuple[Array, str, str]:
    """Return best parameters, status and message after the polish, if there is one."""
    effort = f"{generations} generations, {result.evaluations} penalties"
    polish = search.genetic.polish and search.chosen_method == "ga"
    if result.stop == _core.Stop.observer:
        return result.best, "stopped", f"stopped by the callback after {effort}"
    if polish:
        best, steps, converged = engine.polished(domain, result.best)
        effort = f"{effort}, then {steps} polish steps"
        if not converged:
            return best, "stopped", f"the polish did not converge after {effort}"
        return best, "converged", effort
    if result.stop == _core.Stop.generations:
        return result.best, "stopped", f"the search reached its limit of {effort}, without a polish"
    return result.best, "converged", effort


def _convergence(result: _core.GaResult) -> Convergence:
    number, best, mean, diversity, crossover, mutation, evaluations = result.series.T
    return Convergence(
        generation=number.astype(np.int64),
        best=best,
        mean=mean,
        diversity=diversity,
        crossover_probability=crossover,
        mutation_probability=mutation,
        evaluations=evaluations.astype(np.int64),
    )


def _read_state(path: Path) -> _core.GaState:
    from jointid.base.schema import read_bytes

    try:
        state = _core.GaState.from_bytes(read_bytes(path))
    except OSError as error:
        raise InputError(
            f"the checkpoint cannot be read: {error.strerror}", argument="resume", place=str(path)
        ) from error
    except InputError as error:
        raise InputError(error.reason, argument="resume", place=str(path)) from error
    except ValueError as error:  # from the checks of the core, for example of bounds
        raise InputError(
            f"the checkpoint is damaged: {reason_of(error)}", argument="resume", place=str(path)
        ) from error
    if not (np.isfinite(state.best).all() and state.penalty > -np.inf):
        raise InputError(
            "the best parameters in the checkpoint are not finite",
            argument="resume",
            place=str(path),
        )
    return state


def free_shapes(penalty: _core.Penalty, domain: SearchDomain) -> int:
    """Return the number of shapes that are searched."""
    shapes = slice(penalty.coefficients, None)
    ranges = zip(domain.lower[shapes].tolist(), domain.upper[shapes].tolist(), strict=True)
    return sum(low < high for low, high in ranges)
