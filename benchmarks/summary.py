"""Results of the records: medians of rows, and whether each required figure holds."""

from __future__ import annotations

import statistics
from collections.abc import Callable
from dataclasses import dataclass

from candidates import COMPRESSED, THESIS, THESIS_CODE
from store import Store

OURS = "jointid search, default | compressed"
OURS_WHOLE = "jointid `identify()`, 200 windows | compressed"
DEFAULT = "jointid `identify()`, default windows | compressed"


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A peer's runs. `seconds` is their median; with `bound`, the median is at least that long.

    Runs that did not reach the target count with the time at which they were stopped.
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
        """Name without the form."""
        return self.key.split(" | ")[0]

    @property
    def form(self) -> str:
        """Form of its penalty."""
        return self.key.split(" | ")[1]


def rows(store: Store, order: list[str]) -> list[Row]:
    """Return one row per peer, in the table's order."""
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
class Verdict:
    """Measured value, and whether it suffices; None: the limit of a run was too short to decide."""

    measured: str
    holds: bool | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A requirement and its verdict."""

    wish: str
    verdict: Verdict


@dataclass(frozen=True, slots=True, kw_only=True)
class RatioClaim:
    """Ratio of speed to a group of peers, for only the search and for the whole call.

    `seconds` is the time of the group's quickest peer, `wanted` the required ratio.
    """

    group: str
    wanted: float
    quickest: str
    seconds: float
    alone: Verdict
    whole: Verdict


def ratio_claims(found: list[Row]) -> list[RatioClaim]:
    """Return the ratios to the same penalty, against the quickest row of each group."""
    by_key = {row.key: row for row in found}
    ours, whole = by_key[OURS].seconds, by_key[OURS_WHOLE].seconds

    def is_evolution(row: Row) -> bool:
        others = ("jointid", "pycma", "pygmo cmaes", "variable projection")
        return not row.name.startswith(others) and not any(
            word in row.name for word in ("least_squares", "eliminated")
        )

    groups: list[tuple[str, float, Callable[[Row], bool]]] = [
        (
            "DEAP, pymoo and pygmo's SGA, NumPy penalty",
            500.0,
            lambda r: (
                r.form == "NumPy"
                and r.name.startswith(("DEAP", "pymoo", "pygmo sga"))
                and "eliminated" not in r.name
            ),
        ),
        (
            "SciPy differential evolution, NumPy penalty",
            300.0,
            lambda r: (
                r.form == "NumPy"
                and "differential_evolution" in r.name
                and "eliminated" not in r.name
            ),
        ),
        (
            "CMA-ES, NumPy penalty",
            40.0,
            lambda r: (
                r.form == "NumPy"
                and r.name.startswith(("pygmo cmaes", "pycma"))
                and "eliminated" not in r.name
            ),
        ),
        (
            "genetic algorithms and DE, compiled penalty",
            20.0,
            lambda r: r.form == "compiled" and is_evolution(r),
        ),
        (
            "variable projection, NumPy columns",
            1.0,
            lambda r: r.form == "NumPy" and r.name.startswith("variable projection"),
        ),
        (
            "SciPy least squares from a good start, NumPy residual",
            1.0,
            lambda r: r.form == "NumPy" and "start within" in r.name,
        ),
    ]
    claims = []
    for group, wanted, belongs in groups:
        quickest = min((row for row in found if belongs(row)), key=lambda row: row.seconds)
        claims.append(
            RatioClaim(
                group=group,
                wanted=wanted,
                quickest=f"{quickest.name}, {quickest.form}",
                seconds=quickest.seconds,
                alone=_ratio(quickest, ours, wanted),
                whole=_ratio(quickest, whole, wanted),
            )
        )
    return claims


def _ratio(theirs: Row, ours: float, wanted: float) -> Verdict:
    holds: bool | None = theirs.seconds >= wanted * ours
    if theirs.bound and not holds:
        holds = None
    sign = "> " if theirs.bound else ""
    return Verdict(measured=f"{sign}{theirs.seconds / ours:.3g} times", holds=holds)


def _from_good_start(found: list[Row]) -> Claim:
    """Compare local searches from the same starts, on the same compiled residual and Jacobian."""
    ours, theirs = (
        next(
            r
            for r in found
            if r.form == "compiled" and r.name.startswith(who) and "within" in r.name
        )
        for who in ("jointid polish", "SciPy least_squares")
    )
    measured = f"{theirs.seconds / ours.seconds:.3g} times as fast"
    return Claim(
        wish="local search from a good start: not slower than SciPy least squares, compiled",
        verdict=Verdict(measured=measured, holds=theirs.seconds >= ours.seconds),
    )


def _at_most(wish: str, value: float, limit: float, measured: str) -> Claim:
    return Claim(wish=wish, verdict=Verdict(measured=measured, holds=value <= limit))


def claims(store: Store, order: list[str]) -> list[Claim]:
    """Return all other requirements that this run can judge."""
    found = rows(store, order)
    by_key = {row.key: row for row in found}
    candidate = {record["name"]: record["seconds"] for record in store.of("candidate")}
    whole = by_key[DEFAULT].seconds
    return [
        _at_most(
            "compressed penalty ≤ 0.1 µs per candidate",
            candidate[COMPRESSED],
            1e-7,
            f"{1e6 * candidate[COMPRESSED]:.3f} µs",
        ),
        *_growth(store),
        _at_most(
            "`identify()` with default windows ≤ 10 ms", whole, 10e-3, f"{1e3 * whole:.1f} ms"
        ),
        _from_good_start(found),
        *_presets(candidate, store.of("literal")[0]["total"]),
        *_hour(store),
        *_while_it_runs(store),
    ]


def _growth(store: Store) -> list[Claim]:
    """Compare the search's times over the recording's length."""
    records = store.of("scaling", over="samples")
    if not records:
        return []
    shortest, longest = records[0], records[-1]
    growth = longest["candidate"] / shortest["candidate"]
    individual = max(record["individual"] for record in records)
    samples = f"{shortest['samples']:,} to {longest['samples']:,} samples"
    return [
        _at_most(
            "time per candidate does not grow with the recording: ratio ≤ 1.1",
            growth,
            1.1,
            f"{growth:.2f} times from {samples}",
        ),
        _at_most(
            "genetic search ≤ 0.3 µs per individual, including breeding",
            individual,
            3e-7,
            f"{1e6 * individual:.2f} µs at worst from {samples}",
        ),
    ]


def _presets(candidate: dict[str, float], literal: float) -> list[Claim]:
    """Compare the thesis's budget by both presets with the transcription of its listing."""
    result = []
    for name, key in (("`thesis()`", THESIS), ("`thesis_code()`", THESIS_CODE)):
        total = candidate[key] * 200 * 1501
        result += [
            _at_most(
                f"{name}, 200 × 1500 ≤ 90 ms on one core", total, 90e-3, f"{1e3 * total:.0f} ms"
            ),
            Claim(
                wish=f"{name} ≥ 1000 times as fast as the literal transcription",
                verdict=Verdict(
                    measured=f"{literal / total:.0f} times (transcription: {literal:.0f} s)",
                    holds=literal >= 1000 * total,
                ),
            ),
        ]
    return result


def _hour(store: Store) -> list[Claim]:
    result = []
    for record in store.of("scaling", over="samples", samples=3_600_000):
        share = record["memory"] / record["arrays"]
        result += [
            _at_most(
                "`identify()` of one hour at 1 kHz ≤ 1 s, without loading",
                record["seconds"],
                1.0,
                f"{record['seconds']:.2f} s ({record['windows']} windows)",
            ),
            _at_most(
                "peak memory for this hour ≤ 3 times the arrays", share, 3.0, f"{share:.1f} times"
            ),
        ]
    for record in store.of("interruption"):
        measured = f"{1e3 * record['worst']:.0f} ms at worst, {1e3 * record['median']:.0f} ms in the median"
        wish = f"Ctrl-C ends `identify()` on {record['samples']:,} samples within 0.1 s"
        result.append(_at_most(wish, record["worst"], 0.1, measured))
    return result


def _while_it_runs(store: Store) -> list[Claim]:
    result = []
    for record in store.of("online"):
        measured = (
            f"{1e3 * record['median']:.1f} ms in the median, {1e3 * record['worst']:.1f} ms at worst of "
            f"{record['updates']} updates"
        )
        wish = "online identification ≤ 5 ms per update: 30 s at 1 kHz, blocks of 50 samples"
        result.append(_at_most(wish, record["worst"], 5e-3, measured))
    return result
