"""What the records say: medians of rows, and whether each wanted ratio holds."""

from __future__ import annotations

import statistics
from collections.abc import Callable
from dataclasses import dataclass

from store import Store

OURS = "jointid search, default | compressed"
OURS_WHOLE = "jointid `identify()`, 200 windows | compressed"
DEFAULT = "jointid `identify()`, default windows | compressed"


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A peer's runs. `seconds` is their median; `bound` says that it is at least that long.

    Runs that did not reach the target count with the time after which they were given up.
    """

    key: str
    seconds: float
    quickest: float
    slowest: float
    bound: bool
    reached: int
    runs: int
    ratio: float
    evaluations: float
    candidate: float
    each: tuple[float, ...]

    @property
    def name(self) -> str:
        """Without the form."""
        return self.key.split(" | ")[0]

    @property
    def form(self) -> str:
        """The penalty it was handed."""
        return self.key.split(" | ")[1]


def rows(store: Store, order: list[str]) -> list[Row]:
    """One a peer, in the table's order."""
    found = []
    for key in order:
        runs = store.of("run", peer=key)
        if not runs:
            continue
        seconds = [float(run["seconds"]) for run in runs]
        reached = sum(bool(run["reached"]) for run in runs)
        found.append(
            Row(
                key=key,
                seconds=statistics.median(seconds),
                quickest=min(seconds),
                slowest=max(seconds),
                bound=2 * reached <= len(runs),
                reached=reached,
                runs=len(runs),
                ratio=statistics.median(float(run["ratio"]) for run in runs),
                evaluations=statistics.median(int(run["evaluations"]) for run in runs),
                candidate=statistics.median(
                    float(run["seconds"]) / max(int(run["evaluations"]), 1) for run in runs
                ),
                each=tuple(seconds),
            )
        )
    return found


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A wish, what was measured, and whether it holds; None: the limit of a run was too short to tell."""

    wish: str
    measured: str
    holds: bool | None


def _ratio_claims(found: list[Row]) -> list[Claim]:
    """To the same penalty: the slowest-to-beat row of each group against our search."""
    by_key = {row.key: row for row in found}
    ours, whole = by_key[OURS].seconds, by_key[OURS_WHOLE].seconds

    def is_evolution(row: Row) -> bool:
        return not row.name.startswith(("jointid", "pycma", "pygmo cmaes")) and (
            "least_squares" not in row.name
        )

    groups: list[tuple[str, float, Callable[[Row], bool]]] = [
        (
            "DEAP, pymoo and pygmo's SGA, NumPy penalty",
            500.0,
            lambda r: r.form == "NumPy" and r.name.startswith(("DEAP", "pymoo", "pygmo sga")),
        ),
        (
            "SciPy differential evolution, NumPy penalty",
            300.0,
            lambda r: r.form == "NumPy" and "differential_evolution" in r.name,
        ),
        (
            "CMA-ES, NumPy penalty",
            40.0,
            lambda r: r.form == "NumPy" and r.name.startswith(("pygmo cmaes", "pycma")),
        ),
        (
            "genetic algorithms and DE, compiled penalty",
            20.0,
            lambda r: r.form == "compiled" and is_evolution(r),
        ),
        (
            "SciPy least squares from a good start, NumPy residual",
            1.0,
            lambda r: r.form == "NumPy" and "start within" in r.name,
        ),
    ]
    claims = [_from_good_start(found)]
    for name, wanted, belongs in groups:
        group = [row for row in found if belongs(row)]
        quickest = min(group, key=lambda row: row.seconds)
        sign = "> " if quickest.bound else ""
        holds: bool | None = quickest.seconds >= wanted * ours
        if quickest.bound and not holds:
            holds = None
        claims.append(
            Claim(
                wish=f"search ≥ {wanted:g} times as fast as {name}",
                measured=f"{sign}{quickest.seconds / ours:.3g} times ({quickest.name}, {quickest.form}); "
                f"whole `identify()`: {sign}{quickest.seconds / whole:.3g} times",
                holds=holds,
            )
        )
    return claims


def _from_good_start(found: list[Row]) -> Claim:
    """Local searches from the same starts, on the same compiled residual and Jacobian."""
    ours, theirs = (
        next(
            r
            for r in found
            if r.form == "compiled" and r.name.startswith(who) and "within" in r.name
        )
        for who in ("jointid polish", "SciPy least_squares")
    )
    return Claim(
        wish="from a good start no slower than SciPy least squares, compiled residual and Jacobian",
        measured=f"{theirs.seconds / ours.seconds:.3g} times as fast ({ours.name}, to the end; SciPy to the target)",
        holds=theirs.seconds >= ours.seconds,
    )


def claims(store: Store, order: list[str]) -> list[Claim]:
    """All wishes that this run can judge."""
    found = rows(store, order)
    by_key = {row.key: row for row in found}
    candidate = {record["name"]: record["seconds"] for record in store.of("candidate")}
    compressed = candidate["compressed, 200 a call, one thread"]
    thesis = candidate["thesis() search 200 × 1500, one thread, all of it"] * 200 * 1501
    literal = store.of("literal")[0]["total"]
    whole = by_key[DEFAULT].seconds
    result = [
        Claim(
            wish="compressed penalty ≤ 0.1 µs a candidate",
            measured=f"{1e6 * compressed:.3f} µs",
            holds=compressed <= 1e-7,
        ),
        Claim(
            wish="default `identify()` ≤ 10 ms",
            measured=f"{1e3 * whole:.1f} ms",
            holds=whole <= 10e-3,
        ),
        *_ratio_claims(found),
        Claim(
            wish="the thesis's 200 × 1500 ≤ 90 ms on one core",
            measured=f"{1e3 * thesis:.0f} ms",
            holds=thesis <= 90e-3,
        ),
        Claim(
            wish="that ≥ 1000 times as fast as the literal transcription",
            measured=f"{literal / thesis:.0f} times ({literal:.0f} s)",
            holds=literal >= 1000 * thesis,
        ),
    ]
    for record in store.of("scaling", over="samples", samples=3_600_000):
        share = record["memory"] / record["arrays"]
        result += [
            Claim(
                wish="one hour at 1 kHz ≤ 1 s after loading",
                measured=f"{record['seconds']:.2f} s ({record['windows']} windows)",
                holds=record["seconds"] <= 1.0,
            ),
            Claim(
                wish="memory ≤ 3 times the arrays",
                measured=f"{share:.1f} times",
                holds=share <= 3.0,
            ),
        ]
    return result
