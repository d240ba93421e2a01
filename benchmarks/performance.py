"""The parts of the page of measured results that `make bench` writes from the records of the contest."""

from __future__ import annotations

import os
import platform
import subprocess
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path

from anatomy import BEHIND, STEPS
from measured import Part, commit, publish
from store import Record, Store
from summary import Row, Verdict, claims, ratio_claims, rows

import jointid as jid

LIBRARIES = ("numpy", "scipy", "pygmo", "deap", "pymoo", "pygad", "cma")
FORMS = ("compressed", "compiled", "NumPy")
RATIOS = Part(
    title="Speed against other libraries",
    asked='By what factor is the genetic search (`search="ga"`) faster than the fastest peer of a group, if both '
    "reach the same penalty? **Bold**: the required ratio is not reached. Machine: {machine}. Versions: {versions}.",
    header=(
        "required ratio: group of peers",
        "fastest peer",
        "ratio of the search alone",
        "ratio of the whole `identify()`",
    ),
    reading="A peer searches with a ready penalty, so the ratio of the search alone compares equal work. The whole "
    "call also prepares the penalty and computes the standard errors. No search shortens these "
    "[steps](#steps-of-one-call). [The default search](#search-against-variable-projection), `separable`, takes less "
    "time.",
)
CLAIMS = Part(
    title="Required times and memory",
    asked="Does one run of `make bench` keep the limits of time and memory? **Bold**: the requirement is not met.",
    header=("requirement", "measured"),
)
CONTEST = Part(
    title="Time to the optimum",
    asked="How long does each search take to come within 0.1 % of the optimal penalty? All searches get the same "
    "penalty of one recording with 12,000 samples. The times are medians of at most {seeds} seeds, one column for "
    "each form of the penalty. A run ends after {limit} s.",
    header=(
        "search",
        *(f"{each} penalty" for each in FORMS),
        "candidates, median",
        "runs that reach the optimum",
    ),
    reading="The NumPy and the compiled form compute the same sum; the compressed form is jointid's. *Eliminated* "
    "peers search only the nonlinear parameter. Linear least squares give the linear parameters.",
)
MODELS = Part(
    title="Time of the general Stribeck model",
    asked="How much CPU time does a free Stribeck exponent cost? Shortest CPU time of several calls.",
    header=("call", "CPU time", "ratio to `stribeck`"),
)
ANATOMY = Part(
    title="Steps of one call",
    asked='Where does `identify(search="ga")` spend its time? Median time of each step, timed alone after {behind} s '
    "of other work.",
    header=("step", "time with 200 windows", "time with default windows"),
)
CANDIDATES = Part(
    title="Time per candidate",
    asked="How long does it take to compute the penalty of one candidate of a search? Each form is a program for "
    "this penalty.",
    header=("form of the penalty, candidates per call", "time per candidate"),
    reading="The transcription (`benchmarks/literal/genetic.cpp`) follows the thesis's MATLAB listing loop by loop. "
    "The transcription takes {literal_total} for 200 individuals and 1500 generations, extrapolated from "
    "{literal_runs} runs of 200 × {literal_generations}.",
)
SAMPLES = Part(
    title="Growth with the recording",
    asked="How do time and memory of `identify()` grow with the number of samples?",
    header=(
        "samples",
        "time of `identify()`",
        "peak memory / arrays",
        "time per candidate",
        "time per individual",
    ),
)
GROWTH = Part(
    title="Growth with windows and population",
    asked="How does time grow with the number of windows and with the population? *Whole time*: for windows, the time "
    "of `identify()`; for a population, the time of a search with 20 generations and one thread.",
    header=("number", "whole time", "time per candidate"),
)


def versions() -> dict[str, str]:
    """Return versions of the timed programs; that of jointid has the commit, so that a change starts a new run."""
    libraries = {name: version(name) for name in LIBRARIES}
    ours = f"{jid.__version__} ({commit()})"
    return {"jointid": ours, "python": platform.python_version(), **libraries}


def machine() -> str:
    """Return processor, cores, compiler."""
    model = platform.processor() or platform.machine()
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    compiler = subprocess.run(["c++", "--version"], check=True, text=True, capture_output=True)
    return f"{model}, {os.cpu_count()} cores; {compiler.stdout.splitlines()[0]}"


def seconds(value: float) -> str:
    """Return a time with three figures and its unit."""
    for factor, unit in ((1.0, "s"), (1e3, "ms"), (1e6, "µs")):
        if value * factor >= 1.0:
            return f"{value * factor:.3g} {unit}"
    return f"{value * 1e9:.3g} ns"


def judged(verdict: Verdict) -> str:
    """Return a measured value: bold if it is missed, with a question mark if it is not decided."""
    if verdict.holds is None:
        return f"{verdict.measured} (limit too short to decide)"
    return verdict.measured if verdict.holds else f"**{verdict.measured}**"


def contest_rows(store: Store, order: list[str]) -> Iterator[list[str]]:
    """Return one line per search, with its medians by the form of the penalty."""
    by_name: dict[str, dict[str, Row]] = {}
    for row in rows(store, order):
        by_name.setdefault(row.name, {})[row.form] = row
    for name, forms in by_name.items():
        times = [
            ("> " if row.bound else "") + seconds(row.seconds) if row else "—"
            for row in map(forms.get, FORMS)
        ]
        first, *_ = forms.values()
        count = f"{first.evaluations:,.0f}" if first.evaluations else "—"
        reached = dict.fromkeys(f"{row.reached}/{row.runs}" for row in forms.values())
        yield [name, *times, count, ", ".join(reached)]


def growth_rows(store: Store) -> Iterator[list[str]]:
    """Return one line per number of windows, then one per population."""
    for over in ("windows", "population"):
        for r in store.of("scaling", over=over):
            yield [f"{over} {r[over]:,}", seconds(r["seconds"]), seconds(r["candidate"])]


def publish_all(store: Store, order: list[str], limit: float, *, write: bool) -> None:
    """Print all parts, and write them into the page if requested."""
    found = rows(store, order)
    (literal,) = store.of("literal")
    candidates = [[r["name"], seconds(r["seconds"])] for r in store.of("candidate")]
    candidates.append(["literal C++ transcription, -O2", seconds(literal["candidate"])])
    publish(
        RATIOS,
        (
            [f"≥ {c.wanted:g} times: {c.group}", c.quickest, judged(c.alone), judged(c.whole)]
            for c in ratio_claims(found)
        ),
        write=write,
        machine=machine(),
        versions=", ".join(f"{name} {value}" for name, value in versions().items()),
    )
    publish(CLAIMS, ([c.wish, judged(c.verdict)] for c in claims(store, order)), write=write)
    most = max(row.runs for row in found)
    publish(CONTEST, contest_rows(store, order), write=write, seeds=most, limit=f"{limit:.3g}")
    models = ([r["name"], seconds(r["seconds"]), f"{r['ratio']:.2f}"] for r in store.of("model"))
    publish(MODELS, models, write=write)
    publish(ANATOMY, anatomy_rows(store), write=write, behind=f"{BEHIND:g}")
    publish(
        CANDIDATES,
        candidates,
        write=write,
        literal_total=seconds(literal["total"]),
        literal_runs=literal["runs"],
        literal_generations=literal["generations"],
    )
    publish(SAMPLES, map(_samples, store.of("scaling", over="samples")), write=write)
    publish(GROWTH, growth_rows(store), write=write)


def anatomy_rows(store: Store) -> Iterator[list[str]]:
    """Return one line per step, by the number of windows."""
    records = store.of("anatomy")
    for step in STEPS:
        yield [step, *(seconds(r["steps"][step]) for r in records)]
    yield ["the whole call", *(seconds(r["whole"]) for r in records)]


def _samples(r: Record) -> list[str]:
    memory = f"{r['memory'] / r['arrays']:.1f}"
    times = [seconds(r[name]) for name in ("candidate", "individual")]
    return [f"{r['samples']:,}", seconds(r["seconds"]), memory, *times]
