"""Simulations per second: ours, alone and in batches, SciPy's `solve_ivp`, a plain Python loop.

Six seconds of the thesis's joint under PD control at 1 kHz, one integration step per period. Medians of runs in turn.
Only the ratios are meaningful, because single times depend on the load of the machine.
"""

import argparse
import math
import statistics
import time
from collections.abc import Callable
from dataclasses import replace

from measured import Part, publish
from scipy.integrate import solve_ivp

import jointid as jid

TRUTH = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
SENSOR = {"sensor_gain": 2.4, "sensor_offset": 15.0}
MASS, WEIGHT = 2.472e-4 * 101**2 + 0.25, 3.0 * 9.817 * 0.25
_COLD = "jointid, one simulation, first call after other work"
_ENOUGH = 0.03  # [s] for which a peer is called in each of its turns
STIFFNESS, DAMPING, PERIOD, COUNT = 2e4, 500.0, 1e-3, 6000

PART = Part(
    title="Speed of the simulator",
    asked="How long does a simulation of 6 s take? The thesis's joint under PD control at 1 kHz, one integration step "
    "per control period. Medians of {runs} rounds.",
    header=(
        "simulation",
        "time [ms]",
        "simulations per second",
        "speed / speed of one jointid simulation",
    ),
    reading="A batch returns tracking errors only. The Python loop has neither sticking nor sensors. `solve_ivp` is "
    "called once per control period. The time of `solve_ivp` is measured over a twentieth of the 6 s, and multiplied "
    "by 20.",
)


def friction(v: float) -> float:
    """Return the true friction, with the sign of the velocity and 0 at rest."""
    level = TRUTH["coulomb"] + TRUTH["static"] * math.exp(-TRUTH["stribeck"] * v * v)
    return math.copysign(level, v) * (v != 0.0) + TRUTH["viscous"] * v


def slope(q: float, v: float, torque: float) -> float:
    """Return the acceleration."""
    return (torque - WEIGHT * math.sin(q) - friction(v)) / MASS


def _seconds(run: Callable[[], None]) -> float:
    began = time.perf_counter()
    run()
    return time.perf_counter() - began


def main(runs: int, batch: int, *, write: bool) -> None:
    """Time, in turn, and publish the table."""
    joint = jid.thesis_joint().with_parameters(TRUTH | SENSOR)
    assert joint.link is not None
    joint = joint.replace(link=replace(joint.link, angle=-math.pi / 2.0))
    law = jid.Pd(stiffness=STIFFNESS, damping=DAMPING)
    trajectory = jid.Trajectory.thesis(math.radians(60.0), cycle=3.0, duration=COUNT * PERIOD)
    wanted, wanted_velocity, _ = (
        each.tolist() for each in trajectory.sample([k * PERIOD for k in range(COUNT)])
    )

    def command(k: int, q: float, v: float) -> float:
        asked = STIFFNESS * (wanted[k] - q) + DAMPING * (wanted_velocity[k] - v)
        return float(max(-160.0, min(160.0, asked)))

    def alone() -> None:
        jid.simulate(joint, law, trajectory, integration_step=PERIOD)

    def together(threads: int) -> None:
        jid.simulate_batch(
            joint, [law] * batch, trajectory, integration_step=PERIOD, threads=threads
        )

    def plain() -> None:
        q = v = 0.0
        for k in range(COUNT):
            torque = command(k, q, v)
            middle = v + 0.5 * PERIOD * slope(q, v, torque)
            v += PERIOD * slope(q + 0.5 * PERIOD * v, middle, torque)
            q += PERIOD * middle

    def scipy() -> None:
        state = [0.0, 0.0]
        for k in range(COUNT // 20):  # a twentieth of the time suffices
            torque = command(k, *state)
            solved = solve_ivp(
                lambda _, y, held: (y[1], slope(y[0], y[1], held)),
                (0.0, PERIOD),
                state,
                args=(torque,),
            )
            state = solved.y[:, -1].tolist()

    peers: dict[str, tuple[Callable[[], None], float]] = {
        "jointid, one simulation": (alone, 1.0),
        f"jointid, batch of {batch}, one thread": (lambda: together(1), batch),
        f"jointid, batch of {batch}, all threads": (lambda: together(0), batch),
        "plain Python loop": (plain, 1.0),
        "SciPy solve_ivp, default tolerances": (scipy, 0.05),
    }
    seconds: dict[str, list[float]] = {name: [] for name in (next(iter(peers)), _COLD, *peers)}
    for _ in range(runs):
        for name, (run, simulations) in peers.items():
            cold = _seconds(run)
            if run is alone:
                seconds[_COLD].append(cold)
            enough = max(1, math.ceil(_ENOUGH / cold))
            again = [_seconds(run) for _ in range(enough)] if enough > 1 else [cold]
            seconds[name].append(statistics.mean(again) / simulations)
    reference = statistics.median(seconds["jointid, one simulation"])
    rows = []
    for name, values in seconds.items():
        median = statistics.median(values)
        each = f"{1 / median:.0f}" if median < 1.0 else f"{1 / median:.2g}"
        rows.append([name, f"{median * 1e3:.4g}", each, f"{reference / median:.3g}"])
    publish(PART, rows, write=write, runs=runs)


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--runs", type=int, default=7)
    arguments.add_argument("--batch", type=int, default=64)
    arguments.add_argument("--write", action="store_true", help="write it into the page, too")
    options = arguments.parse_args()
    main(options.runs, options.batch, write=options.write)
