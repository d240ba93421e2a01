"""Writes docs/performance.md from `performance.template.md` and the records."""

from __future__ import annotations

import os
import platform
import subprocess
from importlib.metadata import version
from pathlib import Path
from string import Template

from anatomy import BEHIND, STEPS
from peers.table import all_peers
from rounds import FAILED, FEW
from store import Store
from summary import OURS, RatioClaim, Verdict, claims, floors, ratio_claims, rows

import jointid as jid

TEMPLATE = Path(__file__).resolve().parent / "performance.template.md"
VERDICTS = {True: "yes", False: "**no**", None: "limit too short to decide"}
LIBRARIES = ("numpy", "scipy", "pygmo", "deap", "pymoo", "pygad", "cma")


def versions() -> dict[str, str]:
    """Of what was timed; of jointid with the commit, so that no run continues after a change of the code."""
    libraries = {name: version(name) for name in LIBRARIES}
    ours = f"{jid.__version__} ({commit()})"
    return {"jointid": ours, "python": platform.python_version(), **libraries}


def commit() -> str:
    """The checkout's, "-dirty" if files differ from it; "unknown" outside of one."""
    call = ["git", "describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"]
    try:
        run = subprocess.run(call, check=True, text=True, capture_output=True, cwd=TEMPLATE.parent)
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return run.stdout.strip()


def machine() -> str:
    """Processor, cores, compiler."""
    model = platform.processor() or platform.machine()
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    compiler = subprocess.run(["c++", "--version"], check=True, text=True, capture_output=True)
    return f"{model}, {os.cpu_count()} cores; {compiler.stdout.splitlines()[0]}"


def seconds(value: float) -> str:
    """A time with three figures and its unit."""
    for factor, unit in ((1.0, "s"), (1e3, "ms"), (1e6, "µs")):
        if value * factor >= 1.0:
            return f"{value * factor:.3g} {unit}"
    return f"{value * 1e9:.3g} ns"


def table(header: list[str], lines: list[list[str]]) -> str:
    """In Markdown."""
    head = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join([*head, *("| " + " | ".join(line) + " |" for line in lines)])


def contest_table(store: Store, order: list[str]) -> str:
    """A line a peer."""
    found = rows(store, order)
    ours = next(row.seconds for row in found if row.key == OURS)
    given = {peer.key: peer.given for peer in all_peers()}
    lines = []
    for row in found:
        sign = "> " if row.bound else ""
        spread = f"{seconds(row.quickest)} … {seconds(row.slowest)}"
        lines.append(
            [
                row.name,
                row.form,
                given[row.key],
                sign + seconds(row.seconds),
                "—" if row.bound else spread,
                f"{sign}{row.seconds / ours:.3g}",
                f"{row.reached}/{row.runs}",
                f"{row.ratio:.4g}",
                f"{row.evaluations:,.0f}" if row.evaluations else "—",
                seconds(row.candidate) if row.evaluations else "—",
            ]
        )
    header = [
        "search",
        "penalty",
        "given",
        "median time",
        "range",
        "times our search",
        "reached",
        "P/P*",
    ]
    return table([*header, "candidates", "time a candidate"], lines)


def scaling_tables(store: Store) -> dict[str, str]:
    """One a direction."""

    def of(over: str) -> list[dict[str, float]]:
        return store.of("scaling", over=over)

    return {
        "samples": table(
            [
                "samples",
                "windows",
                "`identify()`",
                "arrays",
                "peak memory",
                "times the arrays",
                "compressed, a candidate",
                "genetic search, an individual",
            ],
            [
                [
                    f"{r['samples']:,}",
                    f"{r['windows']:,}",
                    seconds(r["seconds"]),
                    f"{r['arrays'] / 1e6:.1f} MB",
                    f"{r['memory'] / 1e6:.1f} MB",
                    f"{r['memory'] / r['arrays']:.1f}",
                    seconds(r["candidate"]),
                    seconds(r["individual"]),
                ]
                for r in of("samples")
            ],
        ),
        "windows": table(
            ["windows", "`identify()`", "compressed, a candidate"],
            [
                [f"{r['windows']}", seconds(r["seconds"]), seconds(r["candidate"])]
                for r in of("windows")
            ],
        ),
        "population": table(
            ["population", "search of 20 generations", "a candidate, breeding included"],
            [
                [f"{r['population']}", seconds(r["seconds"]), seconds(r["candidate"])]
                for r in of("population")
            ],
        ),
        "threads": table(
            ["threads", "direct sum, a candidate", "compressed, a candidate"],
            [
                [f"{r['threads']}", seconds(r["direct"]), seconds(r["compressed"])]
                for r in of("threads")
            ],
        ),
    }


def ratios(store: Store, order: list[str]) -> str:
    """What is required of the search and of the whole call, each with its own verdict."""
    lines = []
    for c in ratio_claims(rows(store, order)):
        verdicts = [cell for v in (c.alone, c.whole) for cell in (v.measured, VERDICTS[v.holds])]
        lines.append([f"≥ {c.wanted:g} times as fast as {c.group}", c.quickest, *verdicts])
    header = ["required", "fastest of them", "search alone", "holds", "whole `identify()`", "holds"]
    return table(header, lines)


def anatomy_table(store: Store) -> str:
    """A step a line."""
    records = store.of("anatomy")
    header = ["step"]
    for r in records:
        windows = "default" if r["windows"] is None else str(r["windows"])
        header.append(f"{windows} windows, {r['way']}")
    lines = [[step, *(seconds(r["steps"][step]) for r in records)] for step in STEPS]
    whole = ["the whole call", *(seconds(r["whole"]) for r in records)]
    return table(header, [*lines, whole])


def missed(store: Store, order: list[str]) -> str:
    """A line a missed ratio; empty when none is."""
    lines = []
    for floor in floors(store, order):
        claim = floor.claim

        def best(spent: float, claim: RatioClaim = claim) -> str:
            return f"{claim.seconds / spent:.3g} times"

        lines.append(
            [
                f"≥ {claim.wanted:g} times as fast as {claim.group}",
                seconds(floor.allowed),
                _taken(floor.search, claim.alone),
                f"{seconds(floor.compression)}: {best(floor.compression)}",
                _taken(floor.whole, claim.whole),
                f"{seconds(floor.rest)}: {best(floor.rest)}",
            ]
        )
    header = [
        "required",
        "time it allows",
        "our search alone",
        "with nothing but compression",
        "whole `identify()`",
        "with preparation and inference alone",
    ]
    return table(header, lines) if lines else "None is missed in this run."


def _taken(spent: float, verdict: Verdict) -> str:
    return f"{seconds(spent)}: {verdict.measured}" + ("" if verdict.holds else ", **missed**")


def write(store: Store, order: list[str], limit: float, path: Path) -> None:
    """Fill the template."""
    literal = store.of("literal")[0]
    candidate_lines = [[r["name"], seconds(r["seconds"])] for r in store.of("candidate")]
    candidate_lines.append(
        ["literal C++ transcription, -O2, one thread", seconds(literal["candidate"])]
    )
    most = max(len(store.of("run", peer=key)) for key in order)
    content = Template(TEMPLATE.read_text()).substitute(
        machine=machine(),
        versions=", ".join(f"{name} {value}" for name, value in versions().items()),
        limit=f"{limit:.3g}",
        seeds=most,
        few=FEW,
        failed=FAILED,
        claims=table(
            ["required", "measured", "holds"],
            [[c.wish, c.verdict.measured, VERDICTS[c.verdict.holds]] for c in claims(store, order)],
        ),
        ratios=ratios(store, order),
        missed=missed(store, order),
        models=table(
            ["call", "CPU time", "times `stribeck`"],
            [[r["name"], seconds(r["seconds"]), f"{r['ratio']:.2f}"] for r in store.of("model")],
        ),
        anatomy=anatomy_table(store),
        behind=f"{BEHIND:g}",
        contest=contest_table(store, order),
        candidates=table(["form", "time per candidate"], candidate_lines),
        literal_total=seconds(literal["total"]),
        literal_runs=literal["runs"],
        literal_generations=literal["generations"],
        **scaling_tables(store),
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(content)
