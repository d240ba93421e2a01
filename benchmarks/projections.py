"""Our search against variable projection on six problems, each from its ready penalty; CPU time, in turn."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from measured import Part, publish
from numpy.typing import NDArray
from peers.projection import Projection, compiled_decay, numpy_decay
from recordings import WELL_EXCITED
from scipy.optimize import Bounds, minimize, minimize_scalar
from store import Record

import jointid as jid
from jointid import _core
from jointid.cli.demonstration import data_folder
from jointid.identification.search.domain import SearchDomain, domain_for
from jointid.identification.search.run import Engine
from jointid.joint.model import Model
from jointid.problem.problem import Problem
from jointid.problem.terms import Request, choose_terms

Array = NDArray[np.float64]
REPEATS = 15
CLOSE = 1e-3  # of the optimal penalty
PART = Part(
    title="Search against variable projection",
    asked="How long does each search take with a ready penalty? Shortest CPU time of {repeats} runs, all searches in "
    "turn. Only the ratios are comparable between machines.",
    header=(
        "problem",
        "genetic [ms]",
        "separable [ms]",
        "variable projection, NumPy [ms]",
        "variable projection, compiled column [ms]",
        "variable projection, NumPy / separable",
    ),
    reading="Required: in at least 4 of 6 problems, `separable` is not slower than variable projection in NumPy. "
    "Measured: this holds in {held} of {problems} problems. Variable projection keeps no bounds on the coefficients, "
    "and finds only one local minimum.",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Given:
    """A ready penalty, as each search receives it."""

    name: str
    direct: _core.Penalty
    domain: SearchDomain
    numpy: Projection
    compiled: Projection


def given(name: str, recordings: tuple[jid.Recording, ...], joint: jid.Joint, model: str) -> Given:
    """Return the default penalty of `identify` for these recordings."""
    choice = choose_terms(recordings, joint, Request(model=Model.of(model)))
    problem = Problem(recordings=recordings, joint=joint, choice=choice)
    direct = problem.penalty(None)
    domain = domain_for(direct, joint, None, problem.peak_speed)
    usable = [np.asarray(_core.usable_intervals(each), dtype=np.bool_) for each in problem.in_core]
    decay = numpy_decay(problem.recordings, usable, direct.windows, list(direct.recording_of))
    low, high = domain.lower, domain.upper
    return Given(
        name=name,
        direct=direct,
        domain=domain,
        numpy=Projection(direct, low, high, decay),
        compiled=Projection(direct, low, high, compiled_decay(direct)),
    )


def problems() -> list[Given]:
    """Return the table's rows."""
    folder = data_folder()
    excited, thesis = jid.load(WELL_EXCITED), jid.thesis_joint()
    robot = jid.load(folder / "kr300_joint1.csv.gz")
    robot_joint = jid.Joint.load(folder / "kr300_joint1.toml")
    free = replace(
        thesis,
        parameters={
            **thesis.parameters,
            "inertia": jid.Parameter(name="inertia", min=0.0, max=10.0),
        },
    )
    return [
        given("one shape parameter", (excited,), thesis, "stribeck"),
        given("two shape parameters", (excited,), thesis, "stribeck_general"),
        given("ripple of orders 2 and 4", (excited,), thesis, "stribeck:ripple=2,4"),
        given("free inertia", (excited,), free, "stribeck"),
        given("eight recordings", (excited,) * 8, thesis, "stribeck"),
        given("KR300, joint 1", (robot,), robot_joint, "stribeck"),
    ]


def projected(penalty: Projection, problem: Given) -> float:
    """Run variable projection to the end of SciPy's search; return the penalty."""
    count = problem.direct.coefficients
    low, high = problem.domain.lower[count:], problem.domain.upper[count:]
    if len(low) == 1:
        root = minimize_scalar(
            lambda x: penalty(np.array([x * x])), bounds=(0.0, float(np.sqrt(high[0])))
        )
        return float(root.fun)

    def value(x: Array) -> float:
        return penalty(np.exp(x))

    start = 0.5 * (np.log(low) + np.log(high))
    found = minimize(value, start, method="L-BFGS-B", bounds=Bounds(np.log(low), np.log(high)))
    return float(found.fun)


def genetic(problem: Given) -> float:
    """Run compression, our default genetic search and its polish."""
    low, high = problem.domain.lower, problem.domain.upper
    form = Engine.of(problem.direct, problem.domain, 0).form
    found = _core.minimise_genetic(form, low, high, options=_core.GaOptions(), seed=0)
    return _core.refine_separable(form, low, high, found.best).penalty


def separable(problem: Given) -> float:
    """Run our separable search: by projection, or from the compressed penalty where that is not safe."""
    low, high = problem.domain.lower, problem.domain.upper
    projected = _core.minimise_projected(problem.direct, low, high).found
    if projected is not None:
        return projected.penalty
    form = Engine.of(problem.direct, problem.domain, 0).form
    return _core.minimise_separable(form, low, high).penalty


def measure() -> list[Record]:
    """Return one record per problem.

    Raises
    ------
    AssertionError
        A search ended at another optimum than the others.
    """
    records = []
    for problem in problems():
        searches: dict[str, Callable[[], float]] = {
            "genetic": partial(genetic, problem),
            "separable": partial(separable, problem),
            "numpy": partial(projected, problem.numpy, problem),
            "compiled": partial(projected, problem.compiled, problem),
        }
        ends = {name: search() for name, search in searches.items()}
        best = min(ends["genetic"], ends["separable"])
        for name, end in ends.items():
            assert abs(end / best - 1.0) < CLOSE, f"{problem.name}, {name}: {end} for {best}"
        spent = dict.fromkeys(searches, float("inf"))
        for _ in range(REPEATS):
            for name, search in searches.items():
                began = time.process_time()
                search()
                spent[name] = min(spent[name], time.process_time() - began)
        records.append(
            {
                "name": problem.name,
                **spent,
            }
        )
    return records


def main(*, write: bool) -> None:
    """Measure, and publish one line per problem."""
    records = measure()
    rows = []
    for r in records:
        searches = ("genetic", "separable", "numpy", "compiled")
        times = [f"{1e3 * r[search]:.3g}" for search in searches]
        rows.append([r["name"], *times, f"{r['numpy'] / r['separable']:.2f}"])
    held = sum(r["numpy"] >= r["separable"] for r in records)
    publish(PART, rows, write=write, repeats=REPEATS, held=held, problems=len(records))


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--write", action="store_true", help="write it into the page, too")
    main(write=arguments.parse_args().write)
