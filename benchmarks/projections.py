"""Our search against variable projection on six problems, each from its ready penalty; CPU time, in turn. Markdown."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from peers.projection import Projection, compiled_decay, numpy_decay
from recordings import WELL_EXCITED
from scipy.optimize import Bounds, minimize, minimize_scalar
from store import Record

import jointid as jid
from jointid import _core
from jointid.base.files import write_whole
from jointid.cli.demonstration import data_folder
from jointid.identification.search.domain import SearchDomain, domain_for
from jointid.identification.search.run import Engine
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
        samples=sum(len(each.time) for each in recordings),
    )


def problems() -> list[Given]:
    """The table's rows."""
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
    form = Engine.of(problem.direct, problem.domain, 0).form
    found = _core.minimise_genetic(form, low, high, options=_core.GaOptions(), seed=0)
    return _core.refine_separable(form, low, high, found.best).penalty


def separable(problem: Given) -> float:
    """Our separable search: by projection, or from the compressed penalty where that is not safe."""
    low, high = problem.domain.lower, problem.domain.upper
    projected = _core.minimise_projected(problem.direct, low, high).found
    if projected is not None:
        return projected.penalty
    form = Engine.of(problem.direct, problem.domain, 0).form
    return _core.minimise_separable(form, low, high).penalty


def _way(problem: Given) -> str:
    low, high = problem.domain.lower, problem.domain.upper
    projected = _core.minimise_projected(problem.direct, low, high)
    return "compressed" if projected.found is None else f"{projected.found.evaluations} shapes"


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
            {
                "name": problem.name,
                "samples": problem.samples,
                "windows": problem.direct.window_count,
                "way": _way(problem),
                **spent,
            }
        )
    return records


_PAGE = """# The search against variable projection

Written by `python benchmarks/projections.py --output docs/projection.md` (part of `make bench`); do not edit. From a
ready penalty to the end of the search, least CPU time of {repeats} runs, all in turn on one machine: the ratios are
what holds. Required: not slower than variable projection in NumPy in at least 4 of 6 rows; {held} of {rows} here.

{table}

- *Variable projection* (Golub and Pereyra 1973) is what an expert writes in some 15 lines of NumPy
  (`benchmarks/peers/projection.py`). It is given the columns that no shape changes, made orthonormal beforehand, the
  target, and the sums over the samples with everything computed beforehand that can be; it searches the shapes alone,
  with SciPy's `minimize_scalar` in the bounds for one, L-BFGS-B over the logarithms for two, tolerances as SciPy has
  them. It keeps no bounds on the coefficients and searches one valley. *With our compiled column* the sums of the
  shaped column are ours; the columns beside it are computed, too.
- *Separable*, the default search, is given the penalty as `identify` makes it: it makes the columns orthonormal
  itself, scans the whole range of the shapes over some hundred windows, and takes Gauss-Newton steps over all of them
  from each valley; it keeps the box. *Tries* are the shapes of the scan and the steps; below twice 96 windows it
  compresses.
- *Genetic* is the genetic algorithm: of one shape it compresses the penalty first, by some seventy sums over the
  samples, and can then try any number of candidates; of two it sums for each candidate.
- All end within {close:g} of the same penalty. `stribeck` has one shape, `stribeck_general` two; {samples:,} samples of
  `well_excited`, if no other recording is named.
"""


_HEADER = (
    "problem",
    "samples",
    "windows",
    "genetic [ms]",
    "separable [ms]",
    "tries",
    "variable projection, NumPy [ms]",
    "with our compiled column [ms]",
    "NumPy / separable",
    "compiled / separable",
    "not slower than NumPy",
)


def page(records: list[Record]) -> str:
    """A line a problem."""
    lines = ["| " + " | ".join(_HEADER) + " |", "|---" * len(_HEADER) + "|"]
    held = 0
    for r in records:
        ours = r["separable"]
        held += r["numpy"] >= ours
        cells = [r["name"], f"{r['samples']:,}", f"{r['windows']:,}"]
        cells += [f"{1e3 * r['genetic']:.3g}", f"{1e3 * ours:.3g}", r["way"]]
        cells += [f"{1e3 * r[peer]:.3g}" for peer in ("numpy", "compiled")]
        cells += [f"{r[peer] / ours:.2f}" for peer in ("numpy", "compiled")]
        cells.append("yes" if r["numpy"] >= ours else "**no**")
        lines.append("| " + " | ".join(cells) + " |")
    return _PAGE.format(
        repeats=REPEATS,
        held=held,
        rows=len(records),
        table="\n".join(lines),
        close=CLOSE,
        samples=records[0]["samples"],
    )


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--output", type=Path, help="write the page here, too")
    written = page(measure())
    print(written)
    if (output := arguments.parse_args().output) is not None:
        write_whole(output, written.encode())
