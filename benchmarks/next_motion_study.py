"""Effect of a designed second motion on the errors of an estimate: sequential design, over many seeds.

    python benchmarks/next_motion_study.py [--seeds 100] [--evaluations 2000] [--workers 2] [--output FILE]
        [--file poorly_excited.csv.gz] [--only WORD]

The first recording of a joint has 6 s of motion by ±20°. It contains little information about the sensor's gain. The
second recording has 6 s of a motion designed from the first estimate, or the same motion again. Errors are in % of the
true values. In the designed motion, the controller uses the values of the first estimate.
"""

from __future__ import annotations

import argparse
import math
import multiprocessing
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import jointid as jid

LIMITS = {"position": (-math.pi / 3.0, math.pi / 3.0), "velocity": 3.4, "torque": 160.0}
TRUE = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
TRUE |= {"sensor_gain": 2.4, "sensor_offset": 15.0}
WRONG = {"coulomb": 10.0, "static": 20.0, "stribeck": 200.0, "viscous": 10.0}
WRONG |= {"sensor_gain": 1.0, "sensor_offset": 0.0}


@dataclass(frozen=True, kw_only=True)
class Situation:
    """Angle of the link, noise of the sensor, and values that the first controller uses."""

    angle: float = 0.0
    noise: float = 0.2
    believes: dict[str, float] = field(default_factory=lambda: TRUE)
    first: jid.Trajectory = field(
        default_factory=lambda: jid.Trajectory.thesis(cycle=3.0, duration=6.0)
    )

    def run(
        self, values: dict[str, float], controller: Any, trajectory: jid.Trajectory, seed: int
    ) -> jid.Recording:
        """Return one recording of the joint."""
        sensors = jid.Sensors(torque_noise=self.noise)
        joint = self.joint().with_parameters(values)
        return jid.simulate(joint, controller, trajectory, sensors=sensors, seed=seed)

    def joint(self) -> jid.Joint:
        """Return the thesis's joint, with its link at this angle."""
        joint = jid.thesis_joint()
        link = jid.Link(
            mass=3.0, centre_of_mass=0.25, angle=self.angle, inertia=0.25, gravity=9.817
        )
        return joint.replace(link=link)

    def law(self, values: dict[str, float]) -> jid.AdaptiveRobust:
        """Return the controller that uses these values."""
        believed = jid.control_estimates(self.joint().with_parameters(values))
        return jid.AdaptiveRobust(**believed, friction_velocity="reference")


SITUATIONS = {
    "±20° in 3 s, horizontal, 0.2 N·m": Situation(),
    "±20° in 6 s, horizontal, 0.5 N·m": Situation(
        noise=0.5, first=jid.Trajectory.thesis(duration=6.0)
    ),
    "the same, controller wrong": Situation(
        noise=0.5, believes=WRONG, first=jid.Trajectory.thesis(duration=6.0)
    ),
    "±20° in 6 s, hanging, 0.5 N·m, controller wrong": Situation(
        noise=0.5,
        angle=-0.5 * math.pi,
        believes=WRONG,
        first=jid.Trajectory.thesis(duration=6.0),
    ),
}


def errors(estimate: jid.Estimate) -> dict[str, float]:
    """Return the relative errors [%]; NaN if the model lacks the parameter."""
    found = estimate.parameters
    return {
        name: 100.0 * (found[name].value / true - 1.0) if name in found else math.nan
        for name, true in TRUE.items()
    }


def trial(situation: Situation, evaluations: int, seed: int) -> dict[str, dict[str, float]]:
    """Return errors after one recording, with the same motion again, with the designed motion, and expected errors."""
    joint, law = situation.joint(), situation.law(situation.believes)
    first = situation.run(TRUE, law, situation.first, 2 * seed)
    estimate = jid.identify(first, joint, model="stribeck")
    search = jid.DesignSearch(evaluations=evaluations, seed=seed, threads=1)
    design = estimate.next_motion(LIMITS, 6.0, search=search)
    second = situation.run(TRUE, design.controller, design.trajectory, 2 * seed + 1)
    again = situation.run(TRUE, law, situation.first, 2 * seed + 1)
    both = jid.identify([first, second], joint, model="stribeck")
    same = jid.identify([first, again], joint, model="stribeck")
    expected = {
        name: 100.0 * row.stderr / abs(TRUE[name]) for name, row in design.parameters.items()
    }
    return {
        "first": errors(estimate),
        "same again": errors(same),
        "designed": errors(both),
        "expected": expected,
    }


def after_a_file(path: Path, seeds: int, evaluations: int) -> Iterator[str]:
    """Yield the table of one design after a file's recording, with the errors over many second recordings."""
    joint, situation = jid.thesis_joint(), Situation()
    first = jid.load(path)
    estimate = jid.identify(first, joint)
    design = estimate.next_motion(LIMITS, 6.0, search=jid.DesignSearch(evaluations=evaluations))
    found = []
    for seed in range(seeds):
        second = situation.run(TRUE, design.controller, design.trajectory, seed)
        found.append(list(errors(jid.identify([first, second], joint)).values()))
    of_both = np.array(found)
    yield f"\n### {path.name.partition('.')[0]}, and {seeds} second recordings of one design\n"
    yield "| parameter | first | error before | expected | both: mean | both: rms | largest |"
    yield "|---|---|---|---|---|---|---|"
    for column, (name, error) in enumerate(errors(estimate).items()):
        row, own = design.parameters[name], of_both[:, column]
        before = math.nan if row.before is None else 100.0 * row.before / abs(TRUE[name])
        numbers = (error, before, 100.0 * row.relative, own.mean(), np.sqrt(np.mean(own**2)))
        cells = [f"{number:.3f}" for number in (*numbers, np.abs(own).max())]
        yield f"| `{name}` | {' | '.join(cells)} |"
    worst = np.abs(of_both).max(axis=1)
    yield f"\nEvery error at most 1 % in {np.count_nonzero(worst <= 1.0)} of {seeds}; largest {worst.max():.2f} %."


def table(name: str, trials: list[dict[str, dict[str, float]]]) -> Iterator[str]:
    """Yield one row per parameter (RMS and expected errors), then the number of seeds with all errors below 1 %."""
    yield f"\n### {name}\n\n| parameter | first | same again | designed | expected |\n|---|---|---|---|---|"
    for parameter in TRUE:
        cells = []
        for column in ("first", "same again", "designed", "expected"):
            values = np.array([each[column].get(parameter, math.nan) for each in trials])
            cells.append(f"{np.sqrt(np.nanmean(values**2)):.2f}")
        yield f"| `{parameter}` | {' | '.join(cells)} |"
    for column in ("first", "same again", "designed"):
        worst = np.array([np.nanmax(np.abs(list(each[column].values()))) for each in trials])
        yield (
            f"\nWorst parameter, {column}: median {np.median(worst):.2f} %, largest {worst.max():.2f} %; "
            f"below 1 % in {np.count_nonzero(worst <= 1.0)} of {len(worst)}."
        )


def main() -> None:
    """Print the tables, and write them to the output file if there is one."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--evaluations", type=int, default=2000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--file", type=Path, help="first recording of the thesis's joint")
    parser.add_argument("--only", default="", help="only situations with this word in their names")
    parser.add_argument("--output", type=Path)
    arguments = parser.parse_args()
    lines: list[str] = []
    if arguments.file is not None:
        lines += after_a_file(arguments.file, arguments.seeds, arguments.evaluations)
        print("\n".join(lines), flush=True)
    with ProcessPoolExecutor(arguments.workers, multiprocessing.get_context("spawn")) as pool:
        for name, situation in SITUATIONS.items():
            if arguments.only in name:
                run = partial(trial, situation, arguments.evaluations)
                trials = list(pool.map(run, range(arguments.seeds)))
                found = list(table(name, trials))
                print("\n".join(found), flush=True)
                lines += found
    if arguments.output is not None:
        arguments.output.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
