"""jointid itself: whole `identify` calls, and only the search, stopped by its callback at the target."""

from __future__ import annotations

import jointid as jid
from jointid import _core
from jointid.identification.search.search import Method
from peers.contest import WINDOWS, Contest, Objective
from peers.peer import Peer, Solve
from peers.starts import near_optimum

POLISH = "jointid polish, start within 20 %"
POPULATION, GENERATIONS = 200, 1500  # of the thesis presets


def whole_identify(method: Method, windows: int | None) -> Solve:
    """Run the call of a user: checks, penalty, search, polish, standard errors, warnings."""

    def solve(objective: Objective, seed: int) -> None:
        contest = objective.contest
        estimate = jid.identify(
            contest.recording, contest.joint, windows=windows, search=jid.Search(method, seed=seed)
        )
        found = estimate.convergence
        objective.evaluations += int(found.evaluations[-1]) if found is not None else 0
        # By instruments and over its own windows, which are the defaults, so it is compared with its own optimum.
        objective.best = contest.best_penalty * estimate.penalty / own_optimum(contest, windows)

    return solve


_OPTIMA: dict[int | None, float] = {}


def own_optimum(contest: Contest, windows: int | None) -> float:
    """Return the optimal penalty of the whole call; found once, in the untimed first round."""
    if windows not in _OPTIMA:
        best = jid.identify(contest.recording, contest.joint, windows=windows, search="separable")
        _OPTIMA[windows] = best.penalty
    return _OPTIMA[windows]


def search(options: _core.GaOptions, threads: int = 0) -> Solve:
    """Run compression, genetic search until the target, and the polish if the options have one."""

    def solve(objective: Objective, seed: int) -> None:
        contest = objective.contest
        low, high = contest.full_lower, contest.full_upper
        form = _core.CompressedPenalty(contest.direct, low, high, threads=threads)
        assert form.exact
        found = _core.minimise_genetic(
            form,
            low,
            high,
            options=options,
            seed=seed,
            threads=threads,
            callback=lambda generation: generation.best <= contest.target,
        )
        objective.evaluations += found.evaluations
        best = found.best
        if found.penalty > contest.target and options.polish:
            best = _core.refine_separable(form, low, high, best, threads=threads).best
        objective.best = min(objective.best, contest.direct(best))

    return solve


def separable(objective: Objective, seed: int) -> None:
    """Eliminate the linear parameters; deterministic."""
    del seed
    contest = objective.contest
    low, high = contest.full_lower, contest.full_upper
    found = _core.minimise_projected(contest.direct, low, high).found
    if found is None:  # as `identify` does
        form = _core.CompressedPenalty(contest.direct, low, high)
        found = _core.minimise_separable(form, low, high)
    objective.evaluations += found.evaluations
    objective.best = min(objective.best, contest.direct(found.best))


def polish(objective: Objective, seed: int) -> None:
    """Run Levenberg-Marquardt on the direct sum, from the starts of SciPy's least squares."""
    contest = objective.contest
    start = contest.full(near_optimum(objective, seed))
    found = _core.polish(contest.direct, contest.full_lower, contest.full_upper, start)
    objective.evaluations += found.iterations
    objective.best = min(objective.best, found.penalty)


def peers() -> list[Peer]:
    """Return the rows; those called `identify` time the whole call."""
    thesis, code = (
        options.replace(population=POPULATION, generations=GENERATIONS)
        for options in (_core.GaOptions.thesis(), _core.GaOptions.thesis_code())
    )
    rows = {
        "jointid `identify()`, default windows": whole_identify("ga", None),
        "jointid `identify()`, 200 windows": whole_identify("ga", WINDOWS),
        'jointid `identify(search="separable")`, 200 windows': whole_identify("separable", WINDOWS),
        "jointid search, default": search(_core.GaOptions()),
        "jointid search, `thesis()` 200 × 1500": search(thesis),
        "jointid search, `thesis_code()` 200 × 1500": search(code),
        "jointid search, separable": separable,
    }

    def given(name: str) -> str:
        if "identify" in name:
            return "recording"
        if "thesis" in name:
            return "values"
        return "columns" if "separable" in name else "values; the polish: columns"

    return [
        *(
            Peer(name=name, form="compressed", solve=solve, given=given(name), whole=True)
            for name, solve in rows.items()
        ),
        Peer(name=POLISH, form="compiled", solve=polish, given="residuals, Jacobian", whole=True),
    ]
