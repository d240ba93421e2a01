"""`make study`, fourth part: simulates the joint, identifies it and simulates it again; writes its parts of the page.

Each figure comes from many noise seeds of the sensors, failures included.
"""

from __future__ import annotations

import argparse
import math
import time
from dataclasses import replace
from typing import Any

import numpy as np
from measured import Part, publish

import jointid as jid

TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}
# Table 6-3's initial estimates, in the order above.
INITIAL = dict(zip(TRUTH, (10.0, 20.0, 200.0, 10.0, 1.0, 0.0), strict=True))
NOISE = jid.Sensors(torque_noise=0.5)
# 12 bit for ±217 units of the reading, mean of 16 × 8 conversions; 2000 encoder lines at the motor.
CHAIN = NOISE.replace(
    encoder_counts=8000,
    velocity="counts",
    converter_bits=12,
    converter_range=217.34,
    converter_noise=3.0,
    converter_samples=128,
)
EVERYTHING = CHAIN.replace(ripple=2.6, nonlinearity=0.0014, filter_order=2, filter_frequency=5e3)
PRESETS = {
    "default": jid.GaOptions(),
    "thesis(), 100 × 1000": jid.GaOptions.thesis(),
    "thesis(), 200 × 1500": jid.GaOptions.thesis().replace(population=200, generations=1500),
    "thesis_code(), 100 × 1000": jid.GaOptions.thesis_code(),
    "thesis_code(), 200 × 1500": jid.GaOptions.thesis_code().replace(
        population=200, generations=1500
    ),
}
WANTED = {
    "noise 0.5 N·m": (2.0, 3.0),
    "with encoder and converter": (4.0, 6.0),
}  # largest allowed error [%]; the second limit is for stribeck
ACCURACY = Part(
    title="Accuracy of the simulated joint",
    asked="How accurate is `identify(recording, joint)`? The joint is `thesis_joint()` with the link hanging. A "
    "controller with Table 6-3's initial estimates moves the joint by ±60° for 12 s. Relative error of each parameter "
    "[%] over {trials} recordings: mean (largest).",
    header=(
        "sensors: genetic search, population × generations",
        *TRUTH,
        "recordings with all errors within 5 %",
    ),
    reading="Limit of the largest error for the default: {wanted}. The presets `thesis()` and `thesis_code()` use the "
    'thesis\'s residual, `residual="sensor"`. These presets do not polish the best candidate. They end at values '
    "where errors of gain and offset compensate each other. [thesis.md](../thesis.md) says which statements of the "
    "thesis hold.",
)
RING = Part(
    title="Simulate, identify, simulate again",
    asked="Does the controller track as well with the identified parameters as with the true ones? RMS tracking error "
    "with each set of parameters, medians of {trials} seeds.",
    header=(
        "velocity for the friction compensation",
        "control period",
        "effects of the sensors",
        "initial parameters: error [rad]",
        "identified parameters: error [rad]",
        "true parameters: error [rad]",
        "error ratio, identified / true parameters: median, largest",
    ),
    reading="`ripple=2` in the model removes the bias that the sensor's ripple causes. Compensation at the measured "
    "velocity does not help a joint that sticks. Then the tracking error differs from run to run.",
)
GRID = Part(
    title="The thesis's grid",
    asked="How long does `jid.sweep` take for the thesis's grid? The sweep runs {searches} genetic searches with "
    "{candidates:.1f} million candidates, and {runs} closed-loop simulations with the averaged estimates. The sweep "
    "takes {seconds:.2f} s (median of 3 runs, all threads).",
)


def scenario(friction_velocity: str, control_period: float = 1e-3) -> jid.Scenario:
    """Return the thesis's joint with the link hanging, moved by ±60° in cycles of 3 s with the initial estimates."""
    joint = known_joint()
    true = joint.with_parameters(TRUTH)
    law = jid.AdaptiveRobust(**(jid.control_estimates(true) | INITIAL))
    return jid.Scenario(
        true,
        law.replace(friction_velocity=friction_velocity),
        jid.Trajectory.thesis(math.radians(60.0), cycle=3.0, duration=12.0),
        NOISE,
        control_period=control_period,
    )


def known_joint() -> jid.Joint:
    """Return the joint with the facts that a user knows."""
    joint = jid.thesis_joint()
    assert joint.link is not None
    return joint.replace(link=replace(joint.link, angle=-math.pi / 2.0))


def accuracy(trials: int, *, write: bool) -> None:
    """Publish the errors of each parameter: with our default, and with the thesis's presets and residual."""
    rows: dict[str, list[list[str]]] = {sensors: [] for sensors in WANTED}
    verdicts = []
    for name, ga in PRESETS.items():
        study = jid.sweep(
            scenario("reference"),
            known_joint(),
            grid={"sensors": {"noise 0.5 N·m": NOISE, "with encoder and converter": CHAIN}},
            trials=trials,
            search=jid.Search(seed=1000, ga=ga),
            residual="instruments" if name == "default" else "sensor",
        )
        for number, cell in enumerate(study.cells):
            sensors = cell["sensors"]
            mine = [row for row in study.rows if row.cell == number]
            errors = {
                each: np.array([100.0 * (row.values[each] / true - 1.0) for row in mine])
                for each, true in TRUTH.items()
            }
            worst = {each: float(np.abs(e).max()) for each, e in errors.items()}
            shown = [f"{e.mean():+.2f} ({worst[each]:.2f})" for each, e in errors.items()]
            near = np.all([np.abs(e) <= 5.0 for e in errors.values()], axis=0)
            rows[sensors].append([f"{sensors}: {name}", *shown, f"{near.sum()}/{trials}"])
            if name == "default":
                verdicts.append(f"{sensors}: {_verdict(worst, *WANTED[sensors])}")
    table = [row for each in rows.values() for row in each]
    publish(ACCURACY, table, write=write, trials=trials, wanted="; ".join(verdicts))


def _verdict(worst: dict[str, float], limit: float, stribeck_limit: float) -> str:
    limits = {name: stribeck_limit if name == "stribeck" else limit for name in worst}
    kept = all(worst[name] <= limits[name] for name in worst)
    return f"{limit:g} % (stribeck {stribeck_limit:g} %), {'kept' if kept else '**not** kept'}"


def ring(trials: int, *, write: bool) -> None:
    """Publish the tracking error with the initial, the identified and the true parameters."""
    rows = []
    for velocity in ("reference", "measured"):
        for period in (1e-3, 2e-3):
            study = jid.sweep(
                scenario(velocity, period),
                known_joint(),
                grid={
                    "sensors": {
                        "noise": NOISE,
                        "noise, encoder, converter": CHAIN,
                        "noise, encoder, converter, ripple, non-linearity": EVERYTHING,
                    }
                },
                trials=trials,
                tracking=True,
                search=jid.Search(seed=2000),
            )
            for number, cell in enumerate(study.cells):
                mine = [row.tracking for row in study.rows if row.cell == number]
                ratio = np.array([t["after"] / t["true"] for t in mine])
                before, after, true = (
                    float(np.median([t[name] for t in mine]))
                    for name in ("before", "after", "true")
                )
                sizes = [f"{each:.2e}" for each in (before, after, true)]
                ratios = f"{np.median(ratio):.3f}, {ratio.max():.3f}"
                control = f"{1e3 * period:g} ms"
                rows.append([velocity, control, cell["sensors"], *sizes, ratios])
    publish(RING, rows, write=write, trials=trials)


def grid(*, write: bool) -> None:
    """Publish the time of the thesis's grid and of the closed loops with its averaged estimates."""
    base = scenario("reference")
    recording = base.simulate(0).recordings[0]
    sizes = {
        "ga.population": [20, 50, 100, 200],
        "ga.generations": [20, 50, 100, 500, 1000, 1500],
    }
    seconds = []
    for _ in range(3):
        began = time.perf_counter()
        study = jid.sweep(
            recording, known_joint(), grid=sizes, trials=10, search=jid.Search(ga="thesis")
        )
        summary = study.summary()
        laws = [base.controller.replace(**_assumed(cell.mean)) for cell in summary.cells]
        runs = base.simulate(0, controllers=laws, recordings=False)
        seconds.append(time.perf_counter() - began)
    candidates = int(study.column("evaluations").sum())
    publish(
        GRID,
        (),
        write=write,
        searches=len(study),
        candidates=candidates / 1e6,
        runs=len(runs.error),
        seconds=np.median(seconds),
    )


def _assumed(mean: dict[str, float]) -> dict[str, Any]:
    return {name: mean[name] for name in TRUTH}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=100)
    parser.add_argument("--ring-trials", type=int, default=20)
    parser.add_argument("--write", action="store_true", help="also write the parts into the page")
    chosen = parser.parse_args()
    accuracy(chosen.trials, write=chosen.write)
    ring(chosen.ring_trials, write=chosen.write)
    grid(write=chosen.write)
