"""Load friction: how often it is chosen although there is none, and how well a true one is found. Markdown.

python benchmarks/load_friction.py [runs of each kind, default 14]
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from plants import Bench, Law, Log, Plant, simulate, thesis

import jointid as jid
from jointid.comparison.comparison import refusal

INERTIA = 2.472e-4 * 101.0**2
SENSED = jid.Joint(inertia=INERTIA, sensor=True, torque_hold="zoh")
LINK = jid.Link(mass=4.0, centre_of_mass=1.0, inertia=1.0)
BARE = jid.Joint(inertia=INERTIA, link=LINK, torque_hold="zoh")
OTHERS = {
    "nothing": ({}, {}),
    "viscous drift −30 %": ({"viscous_drift": -0.3}, {}),
    "1 N·m sin 3q": ({"harmonic_torque": 1.0}, {}),
    "torque 2 ms late": ({}, {"torque_delay": 2e-3}),
    "torque constant 10 % off": ({"torque_scale": 1.1}, {}),
    "LuGre": ({"bristle_stiffness": 1e5, "bristle_damping": 500.0}, {}),
    "Stribeck exponent 1": ({"exponent": 1.0}, {}),
    "sensor 5 % nonlinear": ({}, {"nonlinearity": 0.05}),
}


def without(runs: int, rng: np.random.Generator) -> Iterator[tuple[str, jid.Joint, Bench]]:
    """Yield joints without load friction, each with another error of the model."""
    for name, (plant, log) in OTHERS.items():
        values = {"coulomb": rng.uniform(10, 30, runs), "viscous": rng.uniform(10, 25, runs)}
        yield (
            name,
            SENSED,
            Bench(
                motion=thesis(np.radians(rng.uniform(45, 75, runs))),
                law=Law(inertia=2.5, stiffness=80.0, feedback=1.5),
                plant=Plant(**plant, **values),
                log=Log(**log),
            ),
        )
    for name, (plant, log) in OTHERS.items():
        if "nonlinearity" in log:
            continue
        for _, joint, bench in list(loaded(runs, rng, 0.0))[1:]:
            known = "known" if joint.link is not None else "not known"
            other = replace(bench.log, **log)
            broken = replace(bench, plant=replace(bench.plant, **plant), log=other)
            yield f"{name}, no sensor, link {known}", joint, broken


def loaded(
    runs: int, rng: np.random.Generator, size: float
) -> Iterator[tuple[str, jid.Joint, Bench]]:
    """Return joints with a load friction of this size, by the torque behind the gear."""
    sensed = Log()
    blind = Log(sensor=0.0, torque_noise=0.2)
    for name, joint, log, inertia in (
        ("sensor", SENSED, sensed, 2.0),
        ("gravity, link known", BARE, blind, 1.0),
        ("gravity, link not known", jid.Joint(torque_hold="zoh"), blind, 1.0),
    ):
        yield (
            name,
            joint,
            Bench(
                motion=thesis(np.radians(rng.uniform(45, 75, runs))),
                law=Law(inertia=2.7, stiffness=60.0, gravity=30.0 * (log is blind)),
                plant=Plant(
                    coulomb=rng.uniform(5, 20, runs),
                    viscous=rng.uniform(10, 25, runs),
                    gravity=40.0,
                    link_inertia=inertia,
                    load_friction=size,
                ),
                log=log,
            ),
        )


def main(runs: int) -> None:
    """Print both tables."""
    rng = np.random.default_rng(1)
    found = list(without(runs, rng))
    recordings = simulate(Bench.stack([bench for *_, bench in found]), duration=9.0, seed=1)
    print("| error of the model | runs | load friction wins | refused |\n|---|---|---|---|")
    for i, (name, joint, _) in enumerate(found):
        refused = wins = 0
        base = "stribeck" if joint.sensor else "stribeck:gravity=free"
        models = [base, f"{base}:load_friction"]
        for run in recordings[i * runs : (i + 1) * runs]:
            rich = jid.identify(run, joint, model=jid.Model.parse(models[1]), search="separable")
            if refusal(rich) is not None:
                refused += 1
                continue
            wins += "load" in jid.compare_models(run, joint, models=models).winner
        print(f"| {name} | {runs} | {wins} | {refused} |", flush=True)
    print("\n| true | | median | worst error | wins |\n|---|---|---|---|---|")
    for size in (0.2, 0.05):
        of_size(size, runs, rng)


def of_size(size: float, runs: int, rng: np.random.Generator) -> None:
    """Print the rows of a true load friction."""
    kinds = list(loaded(runs, rng, size))
    recordings = simulate(Bench.stack([bench for *_, bench in kinds]), duration=9.0, seed=2)
    for i, (name, joint, _) in enumerate(kinds):
        base = "stribeck" if joint.sensor else "stribeck:gravity=free"
        values, wins = [], 0
        for run in recordings[i * runs : (i + 1) * runs]:
            compared = jid.compare_models(run, joint, models=[base, f"{base}:load_friction"])
            wins += "load" in compared.winner
            rich = jid.identify(
                run, joint, model=jid.Model.parse(f"{base}:load_friction"), search="separable"
            )
            values.append(rich.parameters["load_friction"].value)
        worst = 100.0 * np.abs(np.array(values) / size - 1.0).max()
        print(
            f"| {size:g} | {name} | {np.median(values):.4f} | {worst:.2g} % | {wins} of {runs} |",
            flush=True,
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 14)
