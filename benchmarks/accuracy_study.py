"""`make study`: accuracy of `identify` over many seeds, failures included. Prints a Markdown table.

The study separates two sources of spread: the seed of the search on one recording, and the noise of simulated
recordings. Their torque follows from the torque balance. The motion is smooth and never sticks, so this needs no
simulator.
"""

import argparse

import numpy as np
from recordings import WELL_EXCITED

import jointid as jid

TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}
SMOOTH = {"inertia": 0.8, "coulomb": 3.0, "viscous": 5.0, "torque_offset": 0.4}


def search_seeds(seeds: int) -> list[str]:
    """Return the spread of the values over seeds of the genetic algorithm, on one recording."""
    recording = jid.load(WELL_EXCITED)
    exact = jid.identify(recording, jid.thesis_joint(), search="separable")
    found = [
        jid.identify(recording, jid.thesis_joint(), search=jid.Search("ga", seed=seed))
        for seed in range(seeds)
    ]
    reached = sum(e.penalty <= exact.penalty * (1 + 1e-6) for e in found)
    lines = [
        f"\n`well_excited`, {seeds} seeds of the search: {reached} reach the separable optimum within 1e-6.\n",
        "| parameter | truth | mean error | worst error |",
        "|---|---|---|---|",
    ]
    for name, truth in TRUTH.items():
        errors = np.array([e.parameters[name].value / truth - 1 for e in found])
        worst = errors[np.argmax(np.abs(errors))]
        lines.append(
            f"| {name} | {truth:g} | {100 * errors.mean():+.3f} % | {100 * worst:+.3f} % |"
        )
    return lines


def smooth_recording(seed: int) -> jid.Recording:
    """Return 10 s at 1 kHz of a joint without a sensor, with torque noise of 0.3 N·m."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, 10.0, 1e-3)
    rate = np.array([1.3, 2.9, 5.1])
    size = np.array([0.6, 0.3, 0.1])
    phase = np.outer(time, rate) + rng.uniform(0, 2 * np.pi, 3)
    position = np.sin(phase) @ size
    velocity = np.cos(phase) @ (size * rate)
    acceleration = -np.sin(phase) @ (size * rate**2)
    torque = SMOOTH["inertia"] * acceleration + SMOOTH["coulomb"] * np.sign(velocity)
    torque += SMOOTH["viscous"] * velocity + SMOOTH["torque_offset"]
    noise = rng.normal(0.0, 0.3, time.size)
    return jid.Recording(time=time, position=position, torque=torque + noise)


def noise_seeds(seeds: int) -> list[str]:
    """Return spread and coverage over recordings with different noise and different motion."""
    found = [jid.identify(smooth_recording(seed), search="separable") for seed in range(seeds)]
    lines = [
        f"\n{seeds} recordings of a joint without a sensor (torque noise 0.3 N·m), no options given:\n",
        "| parameter | truth | bias | spread | 95 % interval contains the truth |",
        "|---|---|---|---|---|",
    ]
    for name, truth in SMOOTH.items():
        values = np.array([e.parameters[name].value for e in found])
        inside = 0
        for e in found:
            interval = e.parameters[name].interval
            inside += interval is not None and interval[0] <= truth <= interval[1]
        bias, spread = 100 * (values.mean() / truth - 1), 100 * values.std(ddof=1) / truth
        lines.append(
            f"| {name} | {truth:g} | {bias:+.3f} % | {spread:.3f} % | {100 * inside / seeds:.0f} % |"
        )
    return lines


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--seeds", type=int, default=100)
    count = arguments.parse_args().seeds
    print("\n".join([*search_seeds(count), *noise_seeds(count)]))
