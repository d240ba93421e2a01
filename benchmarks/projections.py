"""Our search against variable projection on six problems, each from its ready penalty; CPU time, in turn."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from peers.projection import Projection, compiled_decay, numpy_decay
from scipy.optimize import Bounds, minimize, minimize_scalar
from store import Record

import jointid as jid
from jointid import _core
from jointid.cli.demo import data_folder
from jointid.identification.search.domain import SearchDomain, domain_for
from jointid.joint.model import Model
from jointid.problem.problem import Problem
from jointid.problem.terms import Request, choose_terms

Array = NDArray[np.float64]
REPEATS = 15
CLOSE = 1e-3  # of the optimal penalty


@dataclass(frozen=True, slots=True, kw_only=True)
class Given:
    """A ready penalty, as each search is handed it."""

    name: str
    direct: _core.Penalty
    domain: SearchDomain
    numpy: Projection
    compiled: Projection
    samples: int


def given(name: str, recordings: tuple[jid.Recording, ...], joint: jid.Joint, model: str) -> Given:
    """The default penalty of `identify` for these recordings."""
    choice = choose_terms(recordings, joint, Request(model=Model.of(model)))
    problem = Problem(
        recordings=recordings, joint=joint, choice=choice, torque_hold=None, mask_standstill=True
    )
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
        samples=sum(len(each.time) for each in recordings),
    )


def problems() -> list[Given]:
    """The table's rows."""
    folder = data_folder()
    excited, thesis = jid.load(folder / "well_excited.csv.gz"), jid.thesis_joint()
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
        given("one shape", (excited,), thesis, "stribeck"),
        given("two shapes", (excited,), thesis, "stribeck_general"),
        given("ripple of orders 2 and 4", (excited,), thesis, "stribeck:ripple=2,4"),
        given("free inertia", (excited,), free, "stribeck"),
        given("eight recordings", (excited,) * 8, thesis, "stribeck"),
        given("KR300, joint 1", (robot,), robot_joint, "stribeck"),
    ]


def projected(penalty: Projection, problem: Given) -> float:
    """Variable projection to the end of SciPy's search; the penalty found."""
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
    """Compression, our default genetic search and its polish."""
    low, high = problem.domain.lower, problem.domain.upper
    form = _core.CompressedPenalty(problem.direct, low, high)
    found = _core.minimise_genetic(form, low, high, options=_core.GaOptions(), seed=0)
    return _core.refine_separable(form, low, high, found.best).penalty


def separable(problem: Given) -> float:
    """Our separable search: by projection, or from the compressed penalty where that is not safe."""
    low, high = problem.domain.lower, problem.domain.upper
    projected = _core.minimise_projected(problem.direct, low, high).found
    if projected is not None:
        return projected.penalty
    form = _core.CompressedPenalty(problem.direct, low, high)
    return _core.minimise_separable(form, low, high).penalty


def measure() -> list[Record]:
    """A record a problem.

    Raises
    ------
    AssertionError
        A search ended elsewhere than the others.
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
            {"kind": "projection", "name": problem.name, "samples": problem.samples, **spent}
        )
    return records


if __name__ == "__main__":
    for record in measure():
        print(record)
