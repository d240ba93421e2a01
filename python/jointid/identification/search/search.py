"""Running a search over the penalty: genetic, random or separable; checkpoints of a long one."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.files import write_whole
from jointid.estimate.statistics import Convergence
from jointid.identification.search.domain import SearchDomain
from jointid.identification.search.engine import Engine, Outcome

Array = NDArray[np.float64]
Callback = Callable[[_core.Generation], bool | None]
StatePath = str | os.PathLike[str]

METHODS = ("ga", "separable", "random")


@dataclass(frozen=True, slots=True, kw_only=True)
class Search:
    """How to search.

    Attributes
    ----------
    method : str
        "ga", "separable" or "random".
    options : GaOptions
    seed, threads : int
    callback : callable or None
    checkpoint : path or None
        The state of the search is written here every 50 generations and at its end, whole or not at all.
    resume : path or None
        A checkpoint to go on from, to the same bits as an uninterrupted search.
    """

    method: str
    options: _core.GaOptions
    seed: int
    threads: int
    callback: Callback | None
    checkpoint: StatePath | None = None
    resume: StatePath | None = None

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise InputError(f"method {self.method!r} is not known; known are {', '.join(METHODS)}")
        if not isinstance(self.options, _core.GaOptions):
            raise InputError(
                f"ga must be GaOptions, got {self.options!r}; use jointid.GaOptions(population=...)"
            )
        for name in ("checkpoint", "resume"):
            if getattr(self, name) is not None:
                require_path(name, getattr(self, name))
        if self.callback is not None and not callable(self.callback):
            raise InputError(f"callback must be callable, got {self.callback!r}")
        if self.method != "ga" and (self.checkpoint is not None or self.resume is not None):
            raise InputError(f"checkpoint and resume go with method='ga', not '{self.method}'")

    def run(self, penalty: _core.Penalty, domain: SearchDomain) -> Outcome:
        """Search.

        Raises
        ------
        InputError
            A checkpoint that does not fit.
        KeyboardInterrupt
            Ctrl-C.
        """
        engine = Engine.of(penalty, domain, self.threads, self.method)
        if self.method == "separable":
            return self.separable(engine, domain)
        result = (self._random if self.method == "random" else self._genetic)(engine, domain)
        convergence = _convergence(result)
        outcome = self.concluded(engine, domain, result, int(convergence.generation[-1]))
        return replace(outcome, convergence=convergence)

    def separable(self, engine: Engine, domain: SearchDomain) -> Outcome:
        """The outcome of the search by elimination."""
        found = _core.minimise_separable(
            engine.form, domain.lower, domain.upper, threads=self.threads
        )
        told = f"separable optimum after {found.evaluations} shapes"
        outcome = Outcome(
            best=found.best,
            convergence=None,
            status="converged",
            message=told,
            evaluations=found.evaluations,
        )
        return engine.verified(outcome, domain)

    def concluded(
        self,
        engine: Engine,
        domain: SearchDomain,
        result: _core.GaResult | _core.TrialResult,
        generations: int,
    ) -> Outcome:
        """Where a search by populations ended: polished if it is to be, and verified."""
        best, status, told = self._finished(engine, domain, result, generations)
        outcome = Outcome(
            best=best,
            convergence=None,
            status=status,
            message=told,
            generations=generations,
            evaluations=result.evaluations,
        )
        return engine.verified(outcome, domain)

    def _random(self, engine: Engine, domain: SearchDomain) -> _core.GaResult:
        return _core.minimise_random(
            engine.form,
            domain.lower,
            domain.upper,
            options=self.options,
            seed=self.seed,
            threads=self.threads,
            callback=self.callback,
        )

    def _genetic(self, engine: Engine, domain: SearchDomain) -> _core.GaResult:
        state = None if self.resume is None else _read_state(Path(self.resume))
        try:
            result = _core.minimise_genetic(
                engine.form,
                domain.lower,
                domain.upper,
                options=self.options,
                seed=self.seed,
                threads=self.threads,
                callback=self.callback,
                resume=state,
                checkpoint=None if self.checkpoint is None else self._write_state,
            )
        except ValueError as error:
            raise InputError(str(error)) from error
        if self.checkpoint is not None and result.state is not None:
            self._write_state(result.state)
        return result

    def _write_state(self, state: _core.GaState) -> None:
        if self.checkpoint is not None:
            write_whole(Path(self.checkpoint), state.to_bytes())

    def _finished(
        self,
        engine: Engine,
        domain: SearchDomain,
        result: _core.GaResult | _core.TrialResult,
        generations: int,
    ) -> tuple[Array, str, str]:
        """Best parameters, status and message after the polish, if there is one."""
        told = f"{generations} generations, {result.evaluations} penalties"
        polish = self.options.polish and self.method == "ga"
        if result.stop == _core.Stop.observer:
            return result.best, "stopped", f"stopped by the callback after {told}"
        if polish:
            best, steps, settled = engine.polished(domain, result.best)
            told = f"{told}, then {steps} polish steps"
            if not settled:
                return best, "stopped", f"the polish did not settle after {told}"
            return best, "converged", told
        if result.stop == _core.Stop.generations:
            return result.best, "stopped", f"used up its {told} without a polish"
        return result.best, "converged", told


def _convergence(result: _core.GaResult) -> Convergence:
    def series(name: str) -> Array:
        return np.array([getattr(g, name) for g in result.history], dtype=np.float64)

    return Convergence(
        generation=np.array([g.number for g in result.history], dtype=np.int64),
        best=series("best"),
        mean=series("mean"),
        diversity=series("diversity"),
        crossover_probability=series("crossover_probability"),
        mutation_probability=series("mutation_probability"),
        evaluations=np.array([g.evaluations for g in result.history], dtype=np.int64),
    )


def _read_state(path: Path) -> _core.GaState:
    try:
        return _core.GaState.from_bytes(path.read_bytes())
    except OSError as error:
        raise InputError(f"{path}: the checkpoint cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise InputError(f"{path}: {error}") from error
