"""The speed contest is fair: one penalty for all, a stop at the target, nothing lost when it is interrupted."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))
from peers.contest import Contest, Expired, Objective, Reached, make_contest, prove_same
from peers.peer import Peer, timed
from peers.projection import Decay, Projection, compiled_decay, numpy_decay
from store import Store
from summary import OURS, OURS_WHOLE, ratio_claims, rows


@pytest.fixture(scope="module")
def contest() -> Contest:
    return make_contest()


def test_numpy_penalty_that_differs_is_refused(contest: Contest) -> None:
    prove_same(contest)
    contest.numpy._balance[0] *= 1.0 + 1e-6
    try:
        with pytest.raises(AssertionError, match="differs"):
            prove_same(contest)
    finally:
        contest.numpy._balance[0] /= 1.0 + 1e-6


@pytest.mark.parametrize("compiled", [False, True])
def test_objective_stops_at_the_target_and_not_before(contest: Contest, compiled: bool) -> None:
    objective = Objective(contest, compiled=compiled, limit=60.0)
    middle = 0.5 * (contest.lower + contest.upper)
    expected = contest.direct(contest.full(middle))
    assert objective(middle) == pytest.approx(expected, rel=1e-9)
    assert objective.many(np.array([middle, middle])) == pytest.approx(expected, rel=1e-9)
    assert objective.unit(np.full(6, 0.5)) == pytest.approx(expected, rel=1e-9)
    residual = objective.residuals(middle)
    assert residual @ residual == pytest.approx(expected, rel=1e-9)
    with pytest.raises(Reached):
        objective(contest.best)
    assert objective.evaluations == 6


def test_jacobian_is_the_residuals_slope(contest: Contest) -> None:
    objective = Objective(contest, compiled=True, limit=60.0)
    at, step = 0.5 * (contest.lower + contest.upper), 1e-6
    slope = objective.residuals(at + step * np.eye(6)[3]) - objective.residuals(
        at - step * np.eye(6)[3]
    )
    expected = slope / (2.0 * step)
    assert objective.jacobian(at)[:, 3] == pytest.approx(
        expected, rel=1e-5, abs=1e-6 * np.abs(expected).max()
    )


def test_variable_projection_has_the_penalty_of_the_best_coefficients(contest: Contest) -> None:
    decays: list[Decay] = [numpy_decay(*contest.sums()), compiled_decay(contest.direct)]
    for decay in decays:
        projection = Projection(contest.direct, contest.full_lower, contest.full_upper, decay)
        assert projection(contest.best[-1:]) == pytest.approx(contest.best_penalty, rel=1e-9)
        away = projection(1.3 * contest.best[-1:])
        assert contest.best_penalty < away < contest.direct(contest.full(1.01 * contest.best))
        assert projection.evaluations == 2


def test_time_that_is_over_ends_a_run(contest: Contest) -> None:
    with pytest.raises(Expired):
        Objective(contest, compiled=True, limit=-1.0)(contest.lower + 1.0)


def test_search_that_ends_early_starts_again_with_another_seed(contest: Contest) -> None:
    seeds = []

    def solve(objective: Objective, seed: int) -> None:
        seeds.append(seed)
        objective(contest.best if len(seeds) == 3 else contest.upper)

    run = timed(Peer(name="x", form="NumPy", solve=solve), contest, 5, 60.0)
    assert run.reached
    assert run.evaluations == 3
    assert len(set(seeds)) == 3


def test_interrupted_run_goes_on_and_a_finished_one_begins_anew(tmp_path: Path) -> None:
    path = tmp_path / "runs.jsonl"
    Store(path, {"limit": 1.0}).append({"kind": "run", "peer": "a"})
    with path.open("a") as file:
        file.write('{"kind": "run", "pe')  # cut off while writing
    again = Store(path, {"limit": 1.0})
    assert again.of("run", peer="a")
    again.append({"kind": "run", "peer": "b"})
    third = Store(path, {"limit": 1.0})
    assert third.of("run", peer="b")
    assert not Store(tmp_path / "runs.jsonl", {"limit": 2.0}).of("run")
    store = Store(path, {"limit": 2.0})
    store.append({"kind": "finished"})
    assert not Store(path, {"limit": 2.0}).of("finished")


def test_median_of_runs_that_mostly_failed_is_a_bound(tmp_path: Path) -> None:
    store = Store(tmp_path / "runs.jsonl", {})
    for reached in (True, False, False):
        store.append(
            {
                "kind": "run",
                "peer": "a | NumPy",
                "seconds": 1.0 if reached else 20.0,
                "reached": reached,
                "ratio": 1.0,
                "evaluations": 10,
            }
        )
    (row,) = rows(store, ["a | NumPy"])
    assert row.bound
    assert (row.seconds, row.reached, row.runs) == (20.0, 1, 3)


def test_a_ratio_has_a_verdict_for_the_search_and_one_for_the_whole_call(tmp_path: Path) -> None:
    seconds = {
        OURS: 0.002,
        OURS_WHOLE: 0.007,
        "DEAP eaSimple | NumPy": 9.0,
        "SciPy differential_evolution | NumPy": 0.9,
        "pygmo cmaes | NumPy": 0.06,
        "pycma fmin2 | NumPy": 0.12,
        "pygmo de | compiled": 0.1,
        "variable projection, SciPy minimize_scalar | NumPy": 0.001,
        "SciPy differential_evolution, eliminated | NumPy": 0.0005,
        "SciPy least_squares, start within 20 % | NumPy": 0.003,
    }
    store = Store(tmp_path / "runs.jsonl", {})
    for peer, spent in seconds.items():
        done = not peer.startswith("DEAP")
        run = {"seconds": spent, "reached": done, "ratio": 1.0, "evaluations": 10}
        store.append({"kind": "run", "peer": peer, **run})
    claims = ratio_claims(rows(store, list(seconds)))
    verdicts = {c.group.split(",")[0]: (c.alone.holds, c.whole.holds) for c in claims}
    assert verdicts == {
        "DEAP": (True, True),
        "SciPy differential evolution": (True, False),
        "CMA-ES": (False, False),
        "genetic algorithms and DE": (True, False),
        "variable projection": (False, False),
        "SciPy least squares from a good start": (True, False),
    }
    cmaes = next(c for c in claims if c.group.startswith("CMA"))
    assert (cmaes.quickest, cmaes.seconds) == ("pygmo cmaes, NumPy", 0.06)
