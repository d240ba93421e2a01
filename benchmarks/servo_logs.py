"""Part of `servo_study.py`: the XL330's logs, by windows and by CMA-ES on rollouts of the same model."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import jointid as jid

ROOT = Path(__file__).resolve().parents[1]
LOGS = ROOT / "tests" / "data" / "xl330" / "bam_xl330.csv.gz"
SEARCHED = ROOT / "build" / "servo_evolution.json"
"""What the peer has found so far: its searches take minutes, and an interrupted study goes on from there."""

LOAD = jid.Model("coulomb_viscous", load_friction=True)
PLAIN = jid.Model("coulomb_viscous", load_friction=False)
KNOWN = {"mass": 0.49, "centre_of_mass": 0.1, "angle": -np.pi / 2}

_REPEATS = 20  # of a timed call; the best counts, since other programs cost time, too


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
) -> tuple[NDArray[np.float64], float, float]:
    """Closed-loop errors of held-out runs [deg]; evaluations and seconds of one fit."""
    errors = np.zeros(len(runs))
    spent, counts = [], []
    for value in sorted(set(groups)):
        train = [run for run, group in zip(runs, groups, strict=True) if group != value]
        test = [k for k, group in enumerate(groups) if group == value]
        started = time.process_time()
        found: jid.ServoEstimate | jid.Joint
        if peer:
            names = ",".join(run.name for run in train)
            found, evaluations, seconds = _searched(train, joint, model, f"{model} {names}")
            counts.append(evaluations)
            spent.append(seconds)
        else:
            found = jid.identify_servo(train, joint, model=model, draws=0)
            counts.append(1.0)
            spent.append(time.process_time() - started)
        rolled = jid.rollout(found, [runs[k] for k in test])
        errors[test] = np.degrees(rolled.errors)
    return errors, float(np.mean(counts)), float(np.mean(spent))


def _searched(
    train: list[jid.Recording], joint: jid.Joint, model: jid.Model, key: str
) -> tuple[jid.Joint, float, float]:
    """The peer's joint, evaluations and seconds: as found before, or searched now."""
    from peers.servo_evolution import described, evolved

    known = json.loads(SEARCHED.read_text(encoding="utf-8")) if SEARCHED.exists() else {}
    if key not in known:
        started = time.process_time()
        values, evaluations = evolved(train, joint, load_friction=model == LOAD)
        known[key] = [values, evaluations, time.process_time() - started]
        SEARCHED.parent.mkdir(exist_ok=True)
        SEARCHED.write_text(json.dumps(known), encoding="utf-8")
    values, evaluations, seconds = known[key]
    return described(joint, np.array(values)), float(evaluations), float(seconds)


def log_tables(logs: Path, *, peer: bool) -> Iterator[str]:
    """Held-out errors of both models, by windows and by the peer; times; and all runs together."""
    runs, groups = xl330_runs(logs)
    yield (
        "| model | R given | held out by | windows: median | worst "
        "| CMA-ES: median | worst | evaluations | a fit | ratio |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for model, name in ((LOAD, "with friction of the load"), (PLAIN, "Coulomb and viscous")):
        for resistance in (None, 4.0):
            joint = xl330_joint(resistance)
            for group, values in groups.items():
                ours, _, _ = held_out(runs, values, joint, model, peer=False)
                given = "no" if resistance is None else f"{resistance:g} Ω"
                cells = [name, given, group, f"{np.median(ours):.2f}°", f"{ours.max():.1f}°"]
                if peer and resistance is None:
                    theirs, evaluations, seconds = held_out(runs, values, joint, model, peer=True)
                    cells += [f"{np.median(theirs):.2f}°", f"{theirs.max():.1f}°"]
                    cells += [f"{evaluations:.0f}", f"{seconds:.0f} s"]
                    cells.append(f"{np.median(ours) / np.median(theirs):.2f}")
                else:
                    cells += [""] * 5
                yield f"| {' | '.join(cells)} |"
    yield ""
    yield from _times(runs)
    yield ""
    yield "All 16 runs together, R not given:"
    yield ""
    yield "```"
    report = jid.identify_servo(runs, xl330_joint()).report().splitlines()
    yield from (line for line in report if not line.startswith("time "))
    yield "```"


def _times(runs: list[jid.Recording]) -> Iterator[str]:
    joint = xl330_joint()
    found = jid.identify_servo(runs, joint)
    calls: dict[str, Callable[[], object]] = {
        "the fit": lambda: jid.identify_servo(runs, joint, draws=0),
        "the fit with its errors": lambda: jid.identify_servo(runs, joint),
        "rollouts of 16 runs of 6 s at 1 ms, three times, for what is bistable": lambda: (
            jid.rollout(found, runs)
        ),
    }
    yield f"All 16 runs, best of {_REPEATS} calls:"
    yield ""
    yield "| | processor | wall |"
    yield "|---|---|---|"
    for name, call in calls.items():
        spent = []
        for _ in range(_REPEATS):
            started = time.process_time(), time.perf_counter()
            call()
            spent.append((time.process_time() - started[0], time.perf_counter() - started[1]))
        processor, wall = (1e3 * min(each) for each in zip(*spent, strict=True))
        yield f"| {name} | {processor:.0f} ms | {wall:.0f} ms |"
