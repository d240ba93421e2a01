"""The sensor's gain from instrumental variables, the sensor's residual and the torque's residual, where each can fail.

    python benchmarks/gain_study.py [runs [word in the condition's name]]

Prints one row per condition and residual. A row has the relative error of the gain [%] (mean, standard deviation and
largest), the least standard deviation that the sensor's noise allows, the coverage of the 95 % intervals, and the mean
errors of Coulomb and viscous friction.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import jointid as jid
from jointid.problem.terms import Residual

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from plants import Bench, Law, Log, Plant, simulate, thesis

RESIDUALS: tuple[Residual | None, ...] = (None, "sensor", "torque")
NOISE = Log(sensor_noise=0.5)
HELD = Law(inertia=2.5, stiffness=80.0, feedback=1.5)


@dataclass(frozen=True, kw_only=True)
class Condition:
    """A joint, its log, its controller, and the model to identify."""

    log: Log = NOISE
    plant: Plant = field(default_factory=Plant)
    law: Law = HELD
    model: str | None = None


CONDITIONS = {
    "no noise": Condition(log=Log(sensor_noise=0.0)),
    "noise 0.2 N·m": Condition(log=Log(sensor_noise=0.2)),
    "noise 0.5 N·m": Condition(),
    "noise 3 N·m": Condition(log=Log(sensor_noise=3.0)),
    "noise 5 N·m": Condition(log=Log(sensor_noise=5.0)),
    "100,000 counts per revolution": Condition(log=Log(sensor_noise=0.5, counts=1e5, velocity=0.0)),
    "viscous −10 %": Condition(plant=Plant(viscous_drift=-0.1)),
    "viscous −30 %": Condition(plant=Plant(viscous_drift=-0.3)),
    "viscous −30 %, noise 5 N·m": Condition(
        log=Log(sensor_noise=5.0), plant=Plant(viscous_drift=-0.3)
    ),
    "Coulomb −20 %": Condition(plant=Plant(coulomb_drift=-0.2)),
    "LuGre, 1e5 N·m/rad": Condition(plant=Plant(bristle_stiffness=1e5)),
    "Stribeck exponent 1": Condition(plant=Plant(exponent=1.0)),
    "load friction 0.1": Condition(plant=Plant(load_friction=0.1)),
    "0.3 N·m sin 3q": Condition(plant=Plant(harmonic_torque=0.3, harmonic_order=3.0)),
    "ripple 2.6 N·m, not modelled": Condition(log=Log(sensor_noise=0.5, ripple=2.6)),
    "ripple 2.6 N·m, modelled": Condition(log=Log(sensor_noise=0.5, ripple=2.6), model=":ripple=2"),
    "gear of 300 N·m/mrad": Condition(plant=Plant(gear_stiffness=3e5)),
    "viscous −30 %, no torque feedback": Condition(
        plant=Plant(viscous_drift=-0.3), law=Law(inertia=2.5, stiffness=80.0, feedback=0.0)
    ),
}


def least_deviation(recording: jid.Recording, noise: float) -> float:
    """Return the Cramér-Rao bound of the gain's relative error [%]: white noise on the reading, other signals exact.

    The gain is the slope of the load over the reading, next to the offset and the columns of friction.
    """
    plant = recording.metadata["plant"]
    velocity = recording.velocity
    acceleration = np.gradient(velocity, recording.time)
    load = plant["link_inertia"] * acceleration + plant["gravity"] * np.sin(recording.position)
    sign, decay = np.sign(velocity), np.exp(-plant["stribeck"] * velocity**2)
    others = [np.ones_like(velocity), sign, velocity, sign * decay, sign * velocity**2 * decay]
    columns = np.column_stack(others)
    rest = load - columns @ np.linalg.lstsq(columns, load, rcond=None)[0]
    return 100.0 * noise / float(np.linalg.norm(rest))


def main(runs: int, word: str = "") -> None:
    """Print the table of the conditions with this word in their names."""
    rng = np.random.default_rng(11)
    joint = jid.thesis_joint()
    motion = thesis(np.radians(rng.uniform(50.0, 70.0, runs)))
    print(
        "| condition | residual | gain: mean ± sd (worst) [%] | least sd | held | Coulomb | viscous |"
    )
    print("|---|---|---|---|---|---|---|")
    for number, (name, case) in enumerate(CONDITIONS.items()):
        if word not in name:
            continue
        bench = Bench(motion=motion, plant=case.plant, law=case.law, log=case.log)
        recordings = simulate(Bench.stack([bench]), duration=12.0, seed=number)
        noise = float(np.max(case.log.sensor_noise))
        least = float(np.mean([least_deviation(recording, noise) for recording in recordings]))
        for residual in RESIDUALS:
            gains, held, others = [], 0, []
            for recording in recordings:
                found = jid.identify(
                    recording,
                    joint,
                    residual=residual,
                    model=None if case.model is None else jid.Model.parse(case.model),
                    search="separable",
                ).parameters
                gain = found["sensor_gain"]
                gains.append(100.0 * (gain.value / 2.4 - 1.0))
                held += gain.interval is not None and gain.interval[0] <= 2.4 <= gain.interval[1]
                truth = recording.truth or {}
                others.append(
                    [100.0 * (found[n].value / truth[n] - 1.0) for n in ("coulomb", "viscous")]
                )
            coulomb, viscous = np.mean(others, axis=0)
            worst = np.max(np.abs(gains))
            print(
                f"| {name} | {residual or 'default'} | {np.mean(gains):+.2f} ± {np.std(gains, ddof=1):.2f} "
                f"({worst:.2f}) | {least:.2f} | {held} of {runs} | {coulomb:+.2f} | {viscous:+.2f} |",
                flush=True,
            )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 50, *sys.argv[2:3])
