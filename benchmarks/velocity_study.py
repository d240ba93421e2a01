"""Velocity from a coarse encoder: joints without a torque sensor, simulated independently, in closed loop.

`python benchmarks/velocity_study.py [--seeds 4] [--differences]`: 120 runs per seed, from counts per motor revolution ×
control period × five motions × two laws × friction compensated at the measured or the reference velocity. Prints a
table with median, 90th percentile and largest error, and coverage of the 95 % intervals. It also counts runs in which a
parameter has an error above 5 % and no finding names it. `--differences` uses central differences for all runs.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from plants import Bench, Law, Log, Motion, chirp, simulate, sines, thesis, trapezoids

import jointid as jid
from jointid.recording.derived import differences

RATIO = 101
NAMES = ("coulomb", "static", "stribeck", "viscous")
DURATION = 10.0


@dataclass(frozen=True, kw_only=True)
class Case:
    """Encoder counts per motor revolution, and milliseconds between commands and between samples."""

    counts: int
    every: int


def motions(rng: np.random.Generator) -> Iterator[Motion]:
    """Yield five motions; the seed varies their size by up to 15 %."""
    size = float(rng.uniform(0.85, 1.15))
    yield thesis([np.radians(60.0) * size])
    yield thesis([np.radians(20.0) * size])
    yield trapezoids([0.8 * size], [0.6], [2.0])
    yield sines([[0.35 * size, 0.16, 0.07]], [[1.3, 3.1, 5.7]], [[0.0, 1.1, 2.3]])
    yield chirp([0.4 * size], 0.2, 1.0, DURATION)


def cases() -> list[Case]:
    """Return the grid of encoders and periods."""
    return [Case(counts=counts, every=every) for counts in (500, 2000, 8000) for every in (1, 2)]


def runs_of(case: Case, seed: int) -> list[jid.Recording]:
    """Return 20 runs: each motion under each law and compensation."""
    rng = np.random.default_rng(seed)
    benches = []
    for motion in motions(rng):
        for integral in (0.0, 4000.0):
            for on_reference in (0.0, 1.0):
                law = Law(
                    inertia=2.7,
                    gravity=7.36,
                    integral=integral,
                    on_reference=on_reference,
                    every=case.every,
                )
                log = Log(
                    sensor=0,
                    counts=case.counts * RATIO,
                    velocity=0,
                    differenced=1,
                    every=case.every,
                )
                benches.append(Bench(motion=motion, law=law, log=log))
    return simulate(Bench.stack(benches), duration=DURATION, seed=seed)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--differences", action="store_true")
    chosen = parser.parse_args()
    joint = jid.Joint(model=jid.Model("stribeck", gravity="free"))
    head = " | ".join(f"{name}: median, 90 %, worst [%], coverage [%]" for name in NAMES)
    print(f"| counts, period [ms] | {head} | off and unnamed |")
    print("|" + "---|" * (len(NAMES) + 2))
    totals: dict[str, list[tuple[float, bool]]] = {name: [] for name in NAMES}
    spikes = number = lost = 0
    for case in cases():
        rows: dict[str, list[tuple[float, bool]]] = {name: [] for name in NAMES}
        unnamed = 0
        for seed in range(chosen.seeds):
            for run in runs_of(case, seed):
                if chosen.differences:
                    run = run.with_velocity(differences(run.time, run.position, run.gaps))
                found = jid.identify(run, joint, search="separable")
                named = {name for finding in found.warnings for name in finding.parameters}
                off = False
                for name in NAMES:
                    each, true = found.parameters[name], dict(run.truth or {})[name]
                    error = abs(each.value / true - 1.0)
                    held = (
                        each.interval is not None and each.interval[0] <= true <= each.interval[1]
                    )
                    rows[name].append((100.0 * error, held))
                    off = off or (error > 0.05 and name not in named)
                unnamed += off
                spikes += any(finding.code == "spikes" for finding in found.warnings)
                number += 1
        lost += unnamed
        for name in NAMES:
            totals[name] += rows[name]
        print(f"| {case.counts}, {case.every} | {_cells(rows)} | {unnamed} |", flush=True)
    print(f"| all | {_cells(totals)} | {lost} of {number} |")
    print(f"\n`spikes` on {spikes} of {number} clean runs.")


def _cells(rows: dict[str, list[tuple[float, bool]]]) -> str:
    cells = []
    for pairs in rows.values():
        errors = np.array([error for error, _ in pairs])
        cover = 100.0 * np.mean([held for _, held in pairs])
        low, high = np.percentile(errors, [50, 90])
        cells.append(f"{low:.2f}, {high:.2f}, {errors.max():.1f}; {cover:.0f}")
    return " | ".join(cells)


if __name__ == "__main__":
    main()
