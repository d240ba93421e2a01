"""How well a servo without a torque signal is identified: simulated benches with known truth, and the XL330's logs.

    python benchmarks/servo_study.py --benches 100

writes docs/servo_accuracy.md. The benches are `tests/simulated_servo.py`: their truth is drawn anew for each. The logs
are Rhoban BAM's (Apache-2.0), in tests/data. The peer is CMA-ES on rollouts of the same model,
on the same training runs, with the rollouts of the core and pycma (dependency group `bench`).
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import jointid as jid

ROOT = Path(__file__).resolve().parents[1]
LOGS = ROOT / "tests" / "data" / "xl330" / "bam_xl330.csv.gz"
sys.path.insert(0, str(ROOT / "tests"))
sys.path.insert(0, str(ROOT / "benchmarks"))

from simulated_servo import Truth, bench_runs, servo_joint  # noqa: E402

LOAD = jid.Model("coulomb_viscous", load_friction=True)
PLAIN = jid.Model("coulomb_viscous", load_friction=False)
KNOWN = {"mass": 0.49, "centre_of_mass": 0.1, "angle": -np.pi / 2}


def drawn_truth(seed: int) -> Truth:
    """A servo within 30 % of the nominal one."""
    factors = np.random.default_rng([seed, 7]).uniform(0.7, 1.3, 6)
    nominal = Truth()
    names = ("torque_constant", "resistance", "viscous", "coulomb", "load_friction", "inertia")
    return Truth(**{n: getattr(nominal, n) * f for n, f in zip(names, factors, strict=True)})


def bench_table(benches: int) -> Iterator[str]:
    """Errors and coverage over benches."""
    errors: dict[str, list[float]] = {}
    held: dict[str, list[bool]] = {}
    for seed in range(benches):
        truth = drawn_truth(seed)
        found = jid.identify_servo(bench_runs(truth, seed=seed), servo_joint())
        for name, value in truth.values.items():
            errors.setdefault(name, []).append(found[name] / value - 1.0)
            low, high = found.parameters[name].interval or (np.nan, np.nan)
            held.setdefault(name, []).append(bool(low <= value <= high))
    yield "| parameter | mean error | largest error | 95 % intervals that hold the truth |"
    yield "|---|---|---|---|"
    for name, each in errors.items():
        values = 100.0 * np.array(each)
        yield (
            f"| {name} | {values.mean():+.2f} % | {np.abs(values).max():.2f} % "
            f"| {100.0 * np.mean(held[name]):.0f} % |"
        )


def xl330_joint(resistance: float | None = None) -> jid.Joint:
    """BAM's bench: a pendulum of .49 kg at .1 m."""
    loop = jid.PositionLoop(gain=4096.0 / (2.0 * np.pi) / (256.0 * 885.0))
    signals = {"duty": "duty", "driven": "torque_enabled", "gain": "firmware_kp"}
    return jid.Joint(
        name="xl330",
        link=jid.Link(**KNOWN),
        voltage=jid.VoltageDrive(
            supply=7.3, resistance=resistance, position_loop=loop, signals=signals
        ),
    )


def xl330_runs(logs: Path) -> tuple[list[jid.Recording], dict[str, list[float]]]:
    """The runs, and how they are held out: by gain, and by trajectory."""
    signals = {"duty": "duty", "driven": "torque_enabled", "gain": "firmware_kp"}
    runs = list(jid.load_runs(logs, by="run_index", extra=signals))
    # The four trajectories follow each other at each gain.
    return runs, {
        "gain": [float(run.extra["gain"][0]) for run in runs],
        "trajectory": [float(k % 4) for k in range(len(runs))],
    }


def held_out(
    runs: list[jid.Recording],
    groups: list[float],
    joint: jid.Joint,
    model: jid.Model,
    *,
    peer: bool,
) -> tuple[np.ndarray, float, float]:
    """Closed-loop errors of held-out runs [deg]; evaluations and seconds of one fit."""
    errors = np.zeros(len(runs))
    spent, counts = [], []
    for value in sorted(set(groups)):
        train = [run for run, group in zip(runs, groups, strict=True) if group != value]
        test = [k for k, group in enumerate(groups) if group == value]
        started = time.process_time()
        found: jid.ServoEstimate | jid.Joint
        if peer:
            from peers.servo_evolution import evolved

            found, evaluations = evolved(train, joint, load_friction=model == LOAD)
            counts.append(float(evaluations))
        else:
            found = jid.identify_servo(train, joint, model=model, draws=0)
            counts.append(1.0)
        spent.append(time.process_time() - started)
        rolled = jid.rollout(found, [runs[k] for k in test])
        errors[test] = np.degrees(rolled.errors)
    return errors, float(np.mean(counts)), float(np.mean(spent))


def log_tables(logs: Path, *, peer: bool) -> Iterator[str]:
    """Held-out errors of both models, by windows and by the peer."""
    runs, groups = xl330_runs(logs)
    yield (
        "| model | R given | held out by | windows: median | worst | a fit "
        "| CMA-ES: median | worst | evaluations | a fit | ratio |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|---|"
    for model, name in ((PLAIN, "Coulomb and viscous"), (LOAD, "with friction of the load")):
        for resistance in (None, 4.0):
            joint = xl330_joint(resistance)
            for group, values in groups.items():
                ours, _, seconds = held_out(runs, values, joint, model, peer=False)
                cells = [
                    name,
                    "no" if resistance is None else f"{resistance:g} Ω",
                    group,
                    f"{np.median(ours):.2f}°",
                    f"{ours.max():.1f}°",
                    f"{1e3 * seconds:.0f} ms",
                ]
                if peer and resistance is None:
                    theirs, evaluations, other = held_out(runs, values, joint, model, peer=True)
                    ratio = np.median(ours) / np.median(theirs)
                    cells += [
                        f"{np.median(theirs):.2f}°",
                        f"{theirs.max():.1f}°",
                        f"{evaluations:.0f}",
                        f"{other:.0f} s",
                        f"{ratio:.2f}",
                    ]
                else:
                    cells += ["", "", "", "", ""]
                yield f"| {' | '.join(cells)} |"
    estimate = jid.identify_servo(runs, xl330_joint())
    yield ""
    yield "All 16 runs together, R not given:"
    yield ""
    yield "```"
    yield from estimate.report().splitlines()
    yield "```"


def page(benches: int, logs: Path, *, peer: bool) -> str:
    """The whole page."""
    lines = [
        "# Accuracy of a servo without a torque signal",
        "",
        "Written by `benchmarks/servo_study.py`; do not edit. [Servos](servos.md) says how to use it.",
        "",
        f"## Simulated benches: {benches}, each with a servo of its own",
        "",
        "16 runs of 6 s, four gains and four motions; torque constant, resistance, inertia and friction are drawn "
        "within 30 % of the nominal ones. Position in 4,096 counts; the duty is read 2.5 ms after it; the supply sags "
        "by .15 Ω and is logged with noise; the logged velocity lags by 20 ms.",
        "",
        *bench_table(benches),
    ]
    lines += [
        "",
        "## XL330: logs of Rhoban BAM",
        "",
        "16 runs of a pendulum. Mean absolute error of the position in closed loop, simulated from the logged "
        "initial state, on runs that the fit did not see: median and worst of 16. Seconds are of the processor.",
        "",
        *log_tables(logs, peer=peer),
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Run the study."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--benches", type=int, default=100)
    parser.add_argument("--logs", type=Path, default=LOGS)
    parser.add_argument("--no-peer", action="store_true")
    parser.add_argument("--output", type=Path, default=ROOT / "docs" / "servo_accuracy.md")
    arguments = parser.parse_args()
    text = page(arguments.benches, arguments.logs, peer=not arguments.no_peer)
    arguments.output.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
