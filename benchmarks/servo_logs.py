"""Part of `servo_study.py`: the XL330's logs, by windows and by CMA-ES on rollouts of the same model."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from measured import Part
from numpy.typing import NDArray

import jointid as jid

ROOT = Path(__file__).resolve().parents[1]
LOGS = ROOT / "tests" / "data" / "xl330" / "bam_xl330.csv.gz"
SEARCHED = ROOT / "build" / "servo_evolution.json"
"""Results of the peer so far. Its searches take minutes, and an interrupted study continues from there."""

LOAD = jid.Model("coulomb_viscous", load_friction=True)
PLAIN = jid.Model("coulomb_viscous", load_friction=False)
KNOWN = {"mass": 0.49, "centre_of_mass": 0.1, "angle": -np.pi / 2}

HELD_OUT = Part(
    title="Servo XL330",
    asked="How well do the identified values simulate held-out runs of Rhoban BAM's 16 logs in closed loop? The peer "
    "is CMA-ES on rollouts of the same model. Mean absolute error of the position: median; largest of the 16 runs.",
    header=(
        "model",
        "stated resistance",
        "held-out group: all runs with the same",
        "jointid: error",
        "CMA-ES: error",
        "CMA-ES: CPU time of a fit",
    ),
)
TIMES = Part(
    title="Servo XL330: times",
    asked="How long do the calls take with all 16 runs? Shortest of {repeats} calls.",
    header=("call", "CPU time", "elapsed time"),
)
REPEATS = 20  # of a timed call; the best counts, because other programs cost time, too


def xl330_joint(resistance: float | None = None) -> jid.Joint:
    """Return BAM's bench: a pendulum of 0.49 kg at 0.1 m."""
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
    """Return the runs, and the held-out groups: by gain, and by trajectory."""
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
) -> tuple[NDArray[np.float64], float]:
    """Return closed-loop errors of held-out runs [deg], and seconds of one fit of the peer."""
    errors = np.zeros(len(runs))
    spent = []
    for value in sorted(set(groups)):
        train = [run for run, group in zip(runs, groups, strict=True) if group != value]
        test = [k for k, group in enumerate(groups) if group == value]
        found: jid.ServoEstimate | jid.Joint
        if peer:
            names = ",".join(run.name for run in train)
            found, seconds = _searched(train, joint, model, f"{model} {names}")
            spent.append(seconds)
        else:
            found = jid.identify_servo(train, joint, model=model, draws=0)
        rolled = jid.rollout(found, [runs[k] for k in test])
        errors[test] = np.degrees(rolled.errors)
    return errors, float(np.mean(spent)) if spent else 0.0


def _searched(
    train: list[jid.Recording], joint: jid.Joint, model: jid.Model, key: str
) -> tuple[jid.Joint, float]:
    """Return the peer's joint and its seconds: stored from before, or searched now."""
    from peers.servo_evolution import described, evolved

    known = json.loads(SEARCHED.read_text(encoding="utf-8")) if SEARCHED.exists() else {}
    if key not in known:
        started = time.process_time()
        values, evaluations = evolved(train, joint, load_friction=model == LOAD)
        known[key] = [values, evaluations, time.process_time() - started]
        SEARCHED.parent.mkdir(exist_ok=True)
        SEARCHED.write_text(json.dumps(known), encoding="utf-8")
    values, _, seconds = known[key]
    return described(joint, np.array(values)), float(seconds)


def held_out_rows(logs: Path, *, peer: bool) -> Iterator[list[str]]:
    """Return held-out errors of both models, by windows and by the peer."""
    runs, groups = xl330_runs(logs)
    for model, name in ((LOAD, "with load friction"), (PLAIN, "Coulomb and viscous")):
        for resistance in (None, 4.0):
            joint = xl330_joint(resistance)
            for group, values in groups.items():
                ours, _ = held_out(runs, values, joint, model, peer=False)
                given = "none" if resistance is None else f"{resistance:g} Ω"
                cells = [name, given, group, _errors(ours)]
                if peer and resistance is None:
                    theirs, seconds = held_out(runs, values, joint, model, peer=True)
                    cells += [_errors(theirs), f"{seconds:.0f} s"]
                else:
                    cells += ["–", "–"]
                yield cells


def _errors(degrees: NDArray[np.float64]) -> str:
    return f"{np.median(degrees):.2f}°; {degrees.max():.1f}°"


def time_rows(logs: Path) -> Iterator[list[str]]:
    """Return times of the calls, the best of several."""
    runs, _ = xl330_runs(logs)
    joint = xl330_joint()
    found = jid.identify_servo(runs, joint)
    calls: dict[str, Callable[[], object]] = {
        "`identify_servo(draws=0)`": lambda: jid.identify_servo(runs, joint, draws=0),
        "`identify_servo`": lambda: jid.identify_servo(runs, joint),
        "`rollout`: three simulations of each run of 6 s, steps of 1 ms": lambda: jid.rollout(
            found, runs
        ),
    }
    for name, call in calls.items():
        spent = []
        for _ in range(REPEATS):
            started = time.process_time(), time.perf_counter()
            call()
            spent.append((time.process_time() - started[0], time.perf_counter() - started[1]))
        processor, wall = (1e3 * min(each) for each in zip(*spent, strict=True))
        yield [name, f"{processor:.0f} ms", f"{wall:.0f} ms"]
