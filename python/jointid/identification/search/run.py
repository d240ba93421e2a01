"""Run a search for the minimum of the penalty: genetic, random or separable; checkpoints of long searches."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.estimate.statistics import Convergence
from jointid.identification.search.domain import SearchDomain
from jointid.identification.search.engine import Engine, Outcome, free_shapes
from jointid.identification.search.search import Search

Array = NDArray[np.float64]


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
        A checkpoint that cannot be read, or of another search.
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

    The projected search sums over the samples a dozen times and needs no engine. Where it cannot be sure of the
    optimum, the engine's penalty is searched, and the outcome is verified.
    """
    lower, upper = domain.lower, domain.upper
    projected = _core.minimise_projected(penalty, lower, upper, threads=search.threads)
    if projected.found is not None:
        return _found(projected.found, f"{_effort(projected.found)}, by projection")
    ready = engine()
    found = _core.minimise_separable(ready.form, lower, upper, threads=search.threads)
    message = "least squares, as no shape is searched"
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
    """Return the verified outcome of a genetic or random search, polished if the settings ask for it."""
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
        return result.best, "stopped", f"reached its limit of {effort} without a polish"
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
    except ValueError as error:  # of what the core checks whenever it is made, e.g. bounds
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
