"""`make bench`: time to the optimum, ours and SciPy's, on the same recording and penalty, in one run. Markdown.

SciPy gets the penalty its users would write: vectorised NumPy over the samples. Each is timed several times in turn;
medians and ratios are printed, because single times on a busy machine mean little.
"""

import argparse
import statistics
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, differential_evolution

import jointid as jid
from jointid.demo import data_folder

NAMES = ("coulomb", "static", "viscous", "sensor_gain", "sensor_offset", "stribeck")
Array = NDArray[np.float64]
LOWER, UPPER = (0.0, 0.0, 0.0, 0.1, -30.0, 0.0), (50.0, 40.0, 40.0, 5.0, 30.0, 200.0)


def numpy_penalty(recording: jid.Recording, count: int) -> Callable[[Array], float]:
    """The integral penalty as one would write it in NumPy: `count` windows, sticking samples left out."""
    t, q, v = recording.time, recording.position, recording.velocity
    assert recording.torque is not None
    assert recording.sensor is not None
    tau, raw = recording.torque, recording.sensor
    step, sign = np.diff(t), np.sign(v)
    moving = (v[1:] != 0) & (v[:-1] != 0)
    starts = np.linspace(0, len(step), count + 1).round().astype(int)[:-1]
    inertia = 2.472e-4 * 101**2

    def over_windows(values: Array) -> Array:
        return np.asarray(np.add.reduceat(np.where(moving, values, 0.0), starts), dtype=np.float64)

    def middle(values: Array) -> Array:
        return 0.5 * (values[1:] + values[:-1]) * step

    sensed = over_windows(middle(raw))
    balance = over_windows(tau[:-1] * step) - inertia * over_windows(np.diff(v))
    coulomb, viscous, length = (
        over_windows(middle(sign)),
        over_windows(np.diff(q)),
        over_windows(step),
    )

    def penalty(theta: Array) -> float:
        c, s, b, gain, offset, shape = theta
        decay = over_windows(middle(np.exp(-shape * v * v) * sign))
        model = (balance - c * coulomb - s * decay - b * viscous - offset * length) / gain
        return float(np.sum((sensed - model) ** 2))

    return penalty


def main(runs: int) -> None:
    """Time, in turn, and print the table."""
    recording = jid.load(data_folder() / "well_excited.csv.gz")
    joint = jid.thesis_joint()
    best = jid.identify(recording, joint, method="separable", windows=200).penalty
    penalty = numpy_penalty(recording, 200)

    def ours(method: str) -> float:
        return jid.identify(recording, joint, method=method, windows=200).penalty / best

    def scipy_de() -> float:
        return float(
            differential_evolution(
                penalty, Bounds(LOWER, UPPER), seed=1, tol=1e-10, maxiter=2000
            ).fun
        )

    peers: dict[str, Callable[[], float]] = {
        "jointid, ga (default)": lambda: ours("ga"),
        "jointid, separable": lambda: ours("separable"),
        "SciPy differential_evolution, NumPy penalty": scipy_de,
    }
    seconds: dict[str, list[float]] = {name: [] for name in peers}
    for _ in range(runs):
        for name, run in peers.items():
            began = time.perf_counter()
            run()
            seconds[name].append(time.perf_counter() - began)
    reference = statistics.median(seconds["jointid, ga (default)"])
    print("| what | median [s] | times the default |\n|---|---|---|")
    for name, values in seconds.items():
        median = statistics.median(values)
        print(f"| {name} | {median:.3f} | {median / reference:.1f} |")


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--runs", type=int, default=3)
    main(arguments.parse_args().runs)
