"""Part of `servo_study.py`: simulated benches with known truth, without and with a broken assumption."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from measured import Part
from simulated_servo import COULOMB, MASS, Bench, Truth, bench_runs, servo_joint

import jointid as jid

FIRST_SEED = 1000
"""Lower seeds were used for the development of the method."""

BENCHES = Part(
    title="Servos without a torque signal",
    asked="How accurate is the identification of a servo on {benches} simulated benches? The values of each bench's "
    "servo are drawn within 30 % of the nominal values. Each bench has 16 runs of 6 s, with four gains and four "
    "motions.",
    header=(
        "parameter",
        "mean error [%]",
        "largest error [%]",
        "coverage of the 95 % intervals [%]",
        "half of the 95 % interval, mean [%]",
    ),
    reading="Benches with a finding other than `at_bound`: {warned}.",
)
SHOWN = ("torque_per_voltage", "load_friction", "inertia", "torque_constant")


def drawn_truth(seed: int) -> Truth:
    """Draw a servo within 30 % of the nominal one."""
    factors = np.random.default_rng([seed, 7]).uniform(0.7, 1.3, 6)
    nominal = Truth()
    names = ("torque_constant", "resistance", "viscous", "coulomb", "load_friction", "inertia")
    return Truth(**{n: getattr(nominal, n) * f for n, f in zip(names, factors, strict=True)})


class Tally:
    """Errors, coverage and widths of the intervals, and findings, over benches."""

    def __init__(self) -> None:
        self.errors: dict[str, list[float]] = {}
        self.held: dict[str, list[bool]] = {}
        self.halves: dict[str, list[float]] = {}
        self.codes: list[set[str]] = []

    def add(self, truth: Truth, found: jid.ServoEstimate) -> None:
        """Add a bench."""
        for name, value in truth.values.items():
            low, high = found.parameters[name].interval or (np.nan, np.nan)
            self.errors.setdefault(name, []).append(found[name] / value - 1.0)
            self.held.setdefault(name, []).append(bool(low <= value <= high))
            self.halves.setdefault(name, []).append(0.5 * (high - low) / value)
        self.codes.append({each.code for each in found.findings})


def bench_table(seeds: Sequence[int]) -> tuple[list[list[str]], str]:
    """Return errors and coverage over benches, and how many benches have a finding."""
    tally = Tally()
    for seed in seeds:
        truth = drawn_truth(seed)
        tally.add(truth, jid.identify_servo(bench_runs(truth, seed=seed), servo_joint()))
    rows = []
    for name, each in tally.errors.items():
        values = 100.0 * np.array(each)
        held, half = 100.0 * np.mean(tally.held[name]), 100.0 * np.mean(tally.halves[name])
        errors = [f"{values.mean():+.2f}", f"{np.abs(values).max():.2f}"]
        rows.append([name, *errors, f"{held:.0f}", f"{half:.2f}"])
    warned = sum(bool(codes - {"at_bound"}) for codes in tally.codes)
    return rows, f"{warned} of {len(tally.codes)}"


_STRIBECK = ("gaussian", 1.8 * COULOMB, 1.8 * COULOMB, (1.0 / 0.3**2,))
BROKEN: dict[str, tuple[Bench, dict[str, Any]]] = {
    "none": (Bench(), {}),
    "the supply has an internal resistance of 0.75 Ω; its voltage is logged": (Bench(sag=0.75), {}),
    "the supply has an internal resistance of 0.15 Ω; constant 7.4 V are stated": (
        Bench(),
        {"supply": 7.4},
    ),
    "the supply has an internal resistance of 0.75 Ω; constant 7.4 V are stated": (
        Bench(sag=0.75),
        {"supply": 7.4},
    ),
    "the duty is read 4.5 ms after the position": (Bench(row=0.0045), {}),
    "the position loop acts 5 ms late, and no delay is stated": (Bench(delay=0.005), {}),
    "static friction 1.8 times Coulomb friction, Stribeck velocity 0.3 rad/s": (
        Bench(friction=(_STRIBECK,)),
        {},
    ),
    "play of 0.5° between load and sensor": (Bench(play=float(np.radians(0.5))), {}),
    "the mass is 5 % more than stated": (Bench(mass=1.05 * MASS), {}),
}
"""Broken assumptions about the bench, and about the stated facts."""


BROKEN_BENCHES = Part(
    title="Servos where an assumption does not hold",
    asked="How large are the errors if the bench differs from the model or the joint file? {benches} benches per row; "
    "mean error of each parameter [%].",
    header=(
        "difference between bench and model or joint file",
        *SHOWN,
        "coverage of the 95 % intervals of these parameters [%]",
        "findings: number of benches",
    ),
)


def broken_table(seeds: Sequence[int]) -> Iterator[list[str]]:
    """Return errors, coverage and findings where an assumption does not hold."""
    for name, (bench, stated) in BROKEN.items():
        tally = Tally()
        for seed in seeds:
            truth = drawn_truth(seed)
            runs = bench_runs(truth, seed=seed, bench=bench)
            tally.add(truth, jid.identify_servo(runs, servo_joint(**stated)))
        errors = [f"{100.0 * np.mean(tally.errors[each]):+.1f}" for each in SHOWN]
        holds = np.mean([np.mean(tally.held[each]) for each in SHOWN])
        said = sorted({code for codes in tally.codes for code in codes - {"at_bound"}})
        counted = [f"{code} {sum(code in c for c in tally.codes)} of {len(seeds)}" for code in said]
        yield [name, *errors, f"{100.0 * holds:.0f}", ", ".join(counted) or "none"]
