"""Which cause is named for which broken assumption, over random joints and motions, as a table in markdown.

python benchmarks/causes_study.py [joints a plant] [seed] [-v]
"""

import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import jointid as jid
from jointid.estimate.causes import MEANINGS

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from plants import Bench, Law, Log, Plant, chirp, simulate, sines, thesis, trapezoids

Array = NDArray[np.float64]

HARM = 0.05  # of a parameter; or two of its errors
BATCH = 10  # joints of each plant simulated together
DURATION = 12.0
SLOW = {"slow_motion", "presliding", "stribeck_exponent"}


@dataclass(frozen=True)
class Case:
    """One broken assumption: what differs, the model to identify with, and the names that are right."""

    name: str
    right: frozenset[str] = frozenset()
    model: str = ""
    given: str = ""  # a parameter that is not identified


def _case(name: str, *right: str, model: str = "") -> Case:
    return Case(name, frozenset(right), model)


WITH_SENSOR = (
    _case("clean"),
    _case("load_friction", "load_friction"),
    _case("viscous_drift", "drift"),
    _case("coulomb_drift", "drift"),
    _case("bristles", *SLOW),
    _case("exponent", *SLOW),
    _case("harmonic", "harmonic"),
    _case("ripple", "ripple"),
    _case("torque_delay", "delay"),
    _case("sensor_delay", "delay"),
    _case("bump", "disturbance"),
    _case("coupling", "other_signal"),
    _case("asymmetry", "asymmetry"),
    _case("elastic"),
    _case("backlash"),
    _case("torque_scale", "wrong_scale"),
    _case("pose_inertia"),
)
WITHOUT = (
    _case("clean", model="stribeck:gravity=free"),
    _case("gravity", "gravity", model="stribeck"),
    _case("pose_inertia", "inertia_varies", model="stribeck:gravity=free"),
    _case("load_friction", "load_friction", model="stribeck:gravity=free"),
    _case("viscous_drift", "drift", model="stribeck:gravity=free"),
    _case("coulomb_drift", "drift", model="stribeck:gravity=free"),
    _case("bristles", *SLOW, model="stribeck:gravity=free"),
    _case("exponent", *SLOW, model="stribeck:gravity=free"),
    _case("no_stribeck", *SLOW, model="coulomb_viscous:gravity=free"),
    _case("harmonic", "harmonic", model="stribeck:gravity=free"),
    _case("torque_delay", "delay", model="stribeck:gravity=free"),
    _case("bump", "disturbance", model="stribeck:gravity=free"),
    _case("coupling", "other_signal", model="stribeck:gravity=free"),
    _case("asymmetry", "asymmetry", model="stribeck:gravity=free"),
    _case("elastic", model="stribeck:gravity=free"),
    _case("backlash", model="stribeck:gravity=free"),
    _case("torque_scale", model="stribeck:gravity=free"),
)


def benches(case: Case, joints: int, sensor: bool, rng: np.random.Generator) -> list[Bench]:
    """Random joints of one case on four kinds of motion."""
    found = []
    for kind in range(4):
        runs = len(range(kind, joints, 4))
        if not runs:
            continue

        def between(low: float, high: float, runs: int = runs) -> Array:
            return rng.uniform(low, high, runs)

        sign = rng.choice([-1.0, 1.0], runs)
        drive = between(1.5, 4.0)
        plant: dict[str, object] = {
            "inertia": drive,
            "coulomb": between(15.0, 35.0),
            "static": between(8.0, 25.0),
            "stribeck": between(50.0, 200.0),
            "viscous": between(10.0, 35.0),
            "link_inertia": between(0.15, 0.5),
            "gravity": between(5.0, 12.0),
            "constant": 0.0 if sensor else between(-3.0, 3.0),
        }
        log: dict[str, object] = {"gain": between(1.5, 3.0), "offset": between(-15.0, 15.0)}
        if not sensor:
            log |= {"sensor": 0.0, "torque_noise": 0.2}
        broken: dict[str, dict[str, object]] = {
            "load_friction": {"load_friction": between(0.03, 0.2)},
            "viscous_drift": {"viscous_drift": -0.3},
            "coulomb_drift": {"coulomb_drift": sign * between(0.1, 0.3)},
            "bristles": {"bristle_stiffness": 1e5, "bristle_damping": between(50.0, 300.0)},
            "exponent": {"exponent": 1.0},
            "harmonic": {"harmonic_torque": between(0.3, 2.0), "harmonic_phase": between(0.0, 6.0)},
            "bump": {
                "bump": sign * between(5.0, 15.0),
                "bump_time": between(2.0, 9.0),
                "bump_width": between(0.2, 0.5),
            },
            "coupling": {"coupling": between(2.0, 6.0), "coupling_rate": between(2.0, 7.0)},
            "asymmetry": {"asymmetry": sign * 0.1, "viscous_asymmetry": sign * between(0.1, 0.3)},
            "elastic": {"gear_stiffness": (2 * np.pi * between(20.0, 80.0)) ** 2 * 0.3},
            "backlash": {"gear_stiffness": 2e4, "gear_damping": 20.0, "backlash": 0.003},
            "torque_scale": {"torque_scale": 1.0 + sign * between(0.03, 0.1)},
            "pose_inertia": {"pose_inertia": between(0.05, 0.14) if sensor else between(0.4, 1.0)},
        }
        plant |= broken.get(case.name, {})
        if case.name == "pose_inertia" and not sensor:
            plant["link_inertia"] = between(1.5, 2.5)
        log |= {
            "ripple": {"ripple": between(1.0, 3.0)},
            "torque_delay": {"torque_delay": between(1e-3, 3e-3)},
            "sensor_delay": {"sensor_delay": between(1e-3, 3e-3)},
        }.get(case.name, {})
        angles = np.radians(between(40.0, 75.0))
        if kind == 0:
            motion = thesis(angles, between(2.0, 4.0))
        elif kind == 1:
            rate = between(1.5, 3.0)[:, None] * np.array([0.5, 1.0, 1.7])
            share = rng.dirichlet([2.0, 2.0, 2.0], runs)
            motion = sines(1.3 * angles[:, None] * share, rate, rng.uniform(0.0, 6.28, (runs, 3)))
        elif kind == 2:
            motion = chirp(angles, between(0.08, 0.15), between(0.5, 1.0), DURATION)
        else:
            motion = trapezoids(angles, between(0.6, 1.6), between(3.0, 8.0))
        law = Law(
            inertia=2.5,
            stiffness=40.0,
            coulomb=between(10.0, 20.0),
            feedback=1.5 if sensor else 0.0,
            gravity=0.0 if sensor else 7.0,
            on_reference=1.0,
        )
        found.append(Bench(motion=motion, law=law, plant=Plant(**plant), log=Log(**log)))  # type: ignore[arg-type]
    return found


def runs(joints: int, sensor: bool, seed: int) -> Iterator[tuple[Case, jid.Recording]]:
    """Every case with its recordings."""
    rng = np.random.default_rng(seed)
    cases = WITH_SENSOR if sensor else WITHOUT
    apart: dict[bool, list[tuple[Case, Bench]]] = {False: [], True: []}
    for case in cases:
        for bench in benches(case, joints, sensor, rng):
            apart[case.name in ("elastic", "backlash")].append((case, bench))
    for pairs in apart.values():
        recordings = iter(
            simulate(Bench.stack([bench for _, bench in pairs]), duration=DURATION, seed=seed)
        )
        for case, bench in pairs:
            for _ in range(bench.motion.runs):
                yield case, next(recordings)


def examined(case: Case, recording: jid.Recording, sensor: bool) -> tuple[bool, list[str]]:
    """Whether a parameter is wrong, and the causes named."""
    truth = dict(recording.truth or {})
    given = {"inertia": float(truth["inertia"])} if sensor else {}
    if not sensor:  # the drive moves the link, too
        truth["inertia"] += recording.metadata["plant"]["link_inertia"]
    model = jid.Model.parse("stribeck" if sensor else case.model)
    joint = jid.Joint(gear_ratio=101.0, sensor=sensor, model=model, **given)
    estimate = jid.identify(recording, joint, search="separable")
    found = [each.code for each in estimate.findings if each.code in MEANINGS]
    if case.name == "coupling":
        plant = recording.metadata["plant"]
        signal = np.sin(plant["coupling_rate"] * recording.time + plant["coupling_phase"])
        found = [each.name for each in estimate.causes({"other axis": signal}).found]
    harmed = False
    for name, p in estimate.parameters.items():
        if not p.vary or name not in truth or not isinstance(truth[name], float):
            continue
        error = abs(p.value - truth[name])
        small = "offset" in name or "gravity" in name
        scale = max(abs(truth[name]), 10.0) if small else abs(truth[name])
        harmed |= error > HARM * scale or (p.stderr is not None and error > 2.0 * p.stderr)
    return harmed, found


def main() -> None:
    """Print the table with a sensor, then without one."""
    numbers = [int(each) for each in sys.argv[1:] if each.isdigit()]
    joints, seed = (*numbers, 20, 1)[:2] if len(numbers) != 1 else (numbers[0], 1)
    for sensor in (True, False):
        rows: dict[str, Counter[str]] = defaultdict(Counter)
        for first in range(0, joints, BATCH):
            for case, recording in runs(min(BATCH, joints - first), sensor, seed + first):
                harmed, found = examined(case, recording, sensor)
                row = rows[case.name]
                row["harmed"] += harmed
                row[":" + (found[0] if found else "none")] += 1
                if case.right and harmed:
                    hit = "right" if case.right & set(found[:1]) else "wrong" if found else "none"
                    row[hit] += 1
                elif found and not case.right & set(found):
                    row["false"] += 1
                if "-v" in sys.argv:
                    print(case.name, harmed, found)
        print(f"\n{'With' if sensor else 'Without'} a torque sensor, {joints} joints a row\n")
        print("| plant | harmed | rightly first | another first | none | false | first names |")
        print("|---|---|---|---|---|---|---|")
        for name, row in rows.items():
            named = sorted(
                ((key[1:], n) for key, n in row.items() if key.startswith(":")), key=lambda e: -e[1]
            )
            told = ", ".join(f"{key} {n}" for key, n in named)
            cells = [row[key] for key in ("harmed", "right", "wrong", "none", "false")]
            print(f"| {name} | " + " | ".join(map(str, cells)) + f" | {told} |")


if __name__ == "__main__":
    main()
