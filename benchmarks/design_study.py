"""Errors with designed motions, from identifications of many simulated recordings. By hand.

The recordings are simulated with noise, and identified with the separable search, which is the default. Every
error counts.
"""

import argparse
import dataclasses
import math
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

import jointid as jid

sys.path.insert(0, str(Path(__file__).resolve().parent))
from measured import Part, publish
from store import Store

INERTIA = 2.472e-4 * 101**2
JOINTS = {
    1: {
        "coulomb": 25.0,
        "static": 20.0,
        "stribeck": 100.0,
        "viscous": 20.0,
        "sensor_gain": 2.4,
        "sensor_offset": 15.0,
    },
    2: {
        "coulomb": 17.0,
        "static": 14.0,
        "stribeck": 120.0,
        "viscous": 26.0,
        "sensor_gain": 1.7,
        "sensor_offset": -7.0,
    },
}
WRONG = {
    "coulomb": 10.0,
    "static": 20.0,
    "stribeck": 200.0,
    "viscous": 10.0,
    "sensor_gain": 1.0,
    "sensor_offset": 0.0,
}
LIMITS = jid.MotionLimits(
    position=(-math.radians(60.0), math.radians(60.0)), velocity=3.4, torque=160.0
)
MOTIONS = {
    "20°, 6 s": jid.Trajectory.thesis(),
    "60°, 3 s": jid.Trajectory.thesis(math.radians(60.0), cycle=3.0),
}
SENSORS = jid.Sensors(torque_noise=0.5)
SMALL = 0.05  # largest error of a parameter that counts in the comparison of random joints
PATH = Path(__file__).resolve().parent / "results" / "design_study.jsonl"
DESIGNED = Part(
    title="Designed motions",
    asked="How much smaller are the errors with a designed motion than with a default motion? RMS error of the worst "
    "parameter over {runs} simulated recordings of 12 s. Limits: ±60°, 3.4 rad/s, 160 N·m. Sensor noise: 0.5 N·m.",
    header=(
        "situation",
        *(f"default motion ({each}): error [%]" for each in MOTIONS),
        "designed motion: error [%]",
        "error ratio: better default motion / designed motion",
        "expected / observed error, range",
    ),
    reading="Joint 1 is the thesis's joint, joint 2 is another joint. The controller's parameters are right or wrong. "
    "The last four rows have joint 1, hanging, with wrong parameters. The prior range is the true value ± 20 %. The "
    "last column has the smallest and the largest ratio of all parameters.",
)
PRIORS = Part(
    title="Designed motions: a wrong prior",
    asked="How much larger are the errors if the prior is centered at twice or half the true values? RMS error of the "
    "worst parameter over {runs} identifications. In brackets: ratio to the error with the right prior.",
    header=(
        "situation",
        "prior at twice the truth: error [%]",
        "prior at half the truth: error [%]",
        "motions keep the limits",
    ),
)
WIDE = Part(
    title="Designed motions: a wide prior",
    asked="How well does one motion identify all joints within the bounds? The design knows only the joint's bounds. "
    "The joints are drawn uniformly within these bounds. The largest error of a parameter is compared with that of "
    "the default motion (20°, 6 s). Only parameters with an error below 5 % in at least one motion count.",
    header=(
        "link",
        "joints",
        "joints that keep the limits",
        "joints that the designed motion improves",
        "largest error: default / designed motion, median",
    ),
)

Values = Mapping[str, Any]


@dataclasses.dataclass(frozen=True)
class Case:
    """One situation: joint, truth, controller, sensors."""

    name: str
    joint: jid.Joint
    truth: Values
    controller: Any
    sensors: Any = SENSORS
    motions: Mapping[str, jid.Trajectory] = dataclasses.field(default_factory=lambda: MOTIONS)

    def prior(self, factor: float = 1.0, share: float = 0.2) -> dict[str, tuple[float, float]]:
        """Return ranges around `factor` times the truth."""
        ranges = {}
        for name, value in self.truth.items():
            ends = sorted((factor * value * (1.0 - share), factor * value * (1.0 + share)))
            ranges[name] = (ends[0], ends[1])
        return ranges


def posed(hanging: bool, **changes: Any) -> jid.Joint:
    """Return the thesis's joint with a hanging or a horizontal link."""
    joint = jid.thesis_joint()
    assert joint.link is not None
    link = dataclasses.replace(joint.link, angle=-math.pi / 2.0 if hanging else 0.0)
    return joint.replace(link=link, **changes)


def law(believed: Values) -> Any:
    """Return the adaptive-robust law with friction compensation at the reference velocity."""
    return jid.AdaptiveRobust(inertia=INERTIA, friction_velocity="reference", **believed)


def situations() -> list[Case]:
    """Return the eight situations of the table."""
    found = []
    for number, truth in JOINTS.items():
        for hanging in (True, False):
            for right in (False, True):
                posture, belief = (
                    "hanging" if hanging else "horizontal",
                    "right" if right else "wrong",
                )
                found.append(
                    Case(
                        f"{number} {posture}, {belief}",
                        posed(hanging),
                        truth,
                        law(truth if right else WRONG),
                    )
                )
    return found


def others() -> list[Case]:
    """Return cases without a sensor, with a coarse encoder, with ripple, and with free inertia and gravity."""
    truth = JOINTS[1]
    friction = {n: v for n, v in truth.items() if not n.startswith("sensor")}
    believed: dict[str, Any] = {n: v for n, v in WRONG.items() if not n.startswith("sensor")}
    own = jid.AdaptiveRobust(
        inertia=INERTIA + 0.25, friction_velocity="reference", torque_feedback=False, **believed
    )
    coarse = jid.Sensors(encoder_counts=8000.0, velocity="difference")
    alone = posed(True, sensor=False, torque_offset=False)
    weight = 3.0 * 9.817 * 0.25
    free = {"gravity_cos": 0.2 * weight, "gravity_sin": weight}
    ripple = {"ripple_cos_2": 1.5, "ripple_sin_2": -2.1}
    wide = {n: jid.Parameter(name=n, min=-40.0, max=40.0) for n in (*free, *ripple)}

    def with_bounds(joint: jid.Joint, names: Any) -> jid.Joint:
        return joint.replace(parameters={**joint.parameters, **{n: wide[n] for n in names}})

    def without_sensor(joint: jid.Joint) -> jid.Joint:
        kept = {n: p for n, p in joint.parameters.items() if not n.startswith("sensor")}
        return joint.replace(parameters=kept)

    known = without_sensor(alone.replace(model=jid.Model("stribeck", gravity="known")))
    freed = with_bounds(
        without_sensor(
            alone.replace(
                model=jid.Model("stribeck", gravity="free"), link=None, rotor_inertia=None
            )
        ),
        free,
    )
    freed = freed.replace(
        parameters={**freed.parameters, "inertia": jid.Parameter(name="inertia", min=0.5, max=10.0)}
    )
    rippled = with_bounds(
        posed(True, model=jid.Model("stribeck", gravity="none", ripple=(2.0,))), ripple
    )
    return [
        Case("no sensor, encoder of 8,000 counts", known, friction, own, coarse),
        Case(
            "sensor, encoder of 8,000 counts",
            posed(True),
            truth,
            law(WRONG),
            jid.Sensors(torque_noise=0.5, encoder_counts=8000.0, velocity="difference"),
        ),
        Case("ripple of 2.6 N·m", rippled, {**truth, **ripple}, law(WRONG)),
        Case(
            "no sensor, inertia and gravity free, 8,000 counts",
            freed,
            {"inertia": INERTIA + 0.25, **friction, **free},
            own,
            coarse,
        ),
    ]


def observed(
    case: Case, trajectory: jid.Trajectory, runs: int, first: int = 5000
) -> dict[str, Any]:
    """Return relative errors of identifications from simulated recordings, and the largest reached signals.

    The parameters of the joints vary within 0.5 % of the truth. So the encoder's quantization errors differ.
    """
    errors, warned = [], 0
    low, high, speed, torque = math.inf, -math.inf, 0.0, 0.0
    for begin in range(0, runs, 20):
        seeds = list(range(first + begin, first + min(begin + 20, runs)))
        truths = [nearby(case.truth, seed) for seed in seeds]
        batch = jid.simulate_batch(
            [case.joint.with_parameters(each) for each in truths],
            case.controller,
            trajectory,
            seeds=seeds,
            sensors=case.sensors,
            recordings=True,
        )
        for run, truth in zip(batch.recordings, truths, strict=True):
            found = jid.identify(run, case.joint, search="separable")
            errors.append([found.parameters[n].value / v - 1.0 for n, v in truth.items()])
            warned += bool(found.warnings)
            signals = run.truth.signals
            low = min(low, float(signals["position"].min()))
            high = max(high, float(signals["position"].max()))
            speed = max(speed, float(np.abs(signals["velocity"]).max()))
            torque = max(torque, float(np.abs(np.asarray(run.torque)).max()))
    table = np.array(errors)
    rms = np.sqrt(np.mean(table**2, axis=0))
    return {
        "rms": dict(zip(case.truth, rms.tolist(), strict=True)),
        "bias": dict(zip(case.truth, table.mean(axis=0).tolist(), strict=True)),
        "warned": warned,
        "reached": [low, high, speed, torque],
    }


def nearby(truth: Values, seed: int) -> dict[str, float]:
    """Return parameters within 0.5 % of the truth, and within the bounds of the thesis's joint."""
    steps = np.random.default_rng(seed + 10**6).uniform(-0.005, 0.005, len(truth))
    bounds = jid.thesis_joint().parameters
    found = {}
    for (name, value), step in zip(truth.items(), steps.tolist(), strict=True):
        own = bounds.get(name)
        low, high = (-math.inf, math.inf) if own is None else (own.min or 0.0, own.max or 0.0)
        found[name] = min(max(value * (1.0 + step), low), high)
    return found


def worst(rms: Values) -> tuple[float, str]:
    """Return the largest error and its parameter's name."""
    name = max(rms, key=lambda each: rms[each])
    return rms[name], name


def kept(reached: list[float]) -> bool:
    """Return whether all limits were kept."""
    low, high = LIMITS.position
    assert LIMITS.torque is not None
    within = low <= reached[0] and reached[1] <= high
    return within and reached[2] <= LIMITS.velocity and reached[3] <= LIMITS.torque


def designed(case: Case, factor: float = 1.0, seed: int = 0, **options: Any) -> tuple[Any, float]:
    """Return the design of a case, and its CPU time [s]."""
    started = time.process_time()
    search = jid.DesignSearch(seed=seed)
    design = jid.design_excitation(
        case.joint,
        LIMITS,
        controller=case.controller,
        sensors=case.sensors,
        search=search,
        **({"prior": case.prior(factor)} | options),
    )
    return design, time.process_time() - started


def run_case(case: Case, runs: int) -> dict[str, Any]:
    """Return the errors with the designed motion and with the two default motions."""
    design, spent = designed(case)
    record = {"name": case.name, "spent": spent, "kept": True}
    found = observed(case, design.trajectory, runs)
    record |= {"design": found, "kept": kept(found["reached"])}
    record["expected"] = {n: e.relative for n, e in design.parameters.items()}
    for name, motion in case.motions.items():
        record[name] = observed(case, motion, runs)
    return record


def run_prior(case: Case, factor: float, runs: int) -> dict[str, Any]:
    """Return the errors with a design for a prior around a multiple of the truth."""
    design, _ = designed(case, factor)
    found = observed(case, design.trajectory, runs)
    return {"name": case.name, "factor": factor, "design": found, "kept": kept(found["reached"])}


def run_random(hanging: bool, count: int, runs: int) -> list[dict[str, Any]]:
    """Return the errors of random joints within the bounds, with one design for these bounds."""
    joint = posed(hanging)
    design = jid.design_excitation(joint, LIMITS, sensors=SENSORS)
    random = np.random.default_rng(77)
    bounds = {n: (p.min or 0.0, p.max or 0.0) for n, p in joint.parameters.items()}
    found = []
    for number in range(count):
        truth = {n: float(random.uniform(low, high)) for n, (low, high) in bounds.items()}
        case = Case("", joint, truth, design.controller)
        record: dict[str, Any] = {"number": number, "hanging": hanging, "truth": truth}
        for name, motion in (("design", design.trajectory), ("default", MOTIONS["20°, 6 s"])):
            record[name] = observed(case, motion, runs)
        record["kept"] = kept(record["design"]["reached"])
        both = [record["design"]["rms"], record["default"]["rms"]]
        counted = [n for n in truth if min(each[n] for each in both) < SMALL]
        record["worst"] = [max((each[n] for n in counted), default=math.inf) for each in both]
        found.append(record)
    return found


def measure(store: Store, runs: int, joints: int) -> None:
    """Measure all rows that the store lacks."""

    def once(kind: str, key: dict[str, Any], make: Callable[[], dict[str, Any]]) -> None:
        if store.of(kind, **key):
            return
        store.append({"kind": kind, **make()})
        print(kind, key, flush=True)

    for case in situations():
        once("situation", {"name": case.name}, lambda case=case: run_case(case, runs))  # type: ignore[misc]
    for case in others():
        once("other", {"name": case.name}, lambda case=case: run_case(case, runs))  # type: ignore[misc]
    if not store.of("random"):
        for hanging in (True, False):
            for record in run_random(hanging, joints, max(10, runs // 10)):
                store.append({"kind": "random", **record})
    for factor in (2.0, 0.5):
        for case in situations():
            once(
                "prior",
                {"name": case.name, "factor": factor},
                lambda case=case, factor=factor: run_prior(case, factor, max(10, runs // 4)),  # type: ignore[misc]
            )


def percent(value: float) -> str:
    """Return a share in %, with two significant digits."""
    return f"{100.0 * value:.2g}"


def cell(rms: Values) -> str:
    """Return the worst error of a motion, with its parameter."""
    size, name = worst(rms)
    return f"{percent(size)} {name}"


def rows(records: list[dict[str, Any]]) -> Iterator[list[str]]:
    """Yield one line per situation: worst error of each motion, and the ratios of expected to observed errors."""
    for each in records:
        others = [each[name]["rms"] for name in MOTIONS]
        found = each["design"]["rms"]
        best = min(worst(rms)[0] for rms in others) / worst(found)[0]
        ratios = [each["expected"][n] / found[n] for n in found]
        spread = f"{min(ratios):.2f}–{max(ratios):.2f}"
        yield [each["name"], *map(cell, [*others, found]), f"{best:.1f}", spread]


def prior_rows(store: Store) -> Iterator[list[str]]:
    """Yield one line per situation: its worst error with a wrong prior."""
    for each in store.of("situation"):
        cells, all_kept = [], True
        for factor in (2.0, 0.5):
            for other in store.of("prior", name=each["name"], factor=factor):
                ratio = worst(other["design"]["rms"])[0] / worst(each["design"]["rms"])[0]
                cells.append(f"{cell(other['design']['rms'])} ({ratio:.2f})")
                all_kept &= other["kept"]
        yield [each["name"], *cells, "yes" if all_kept else "no"]


def wide_rows(store: Store) -> Iterator[list[object]]:
    """Yield one line per link position: errors of one motion for random joints within wide bounds."""
    for hanging in (True, False):
        records = store.of("random", hanging=hanging)
        if records:
            better = sum(each["worst"][0] < each["worst"][1] for each in records)
            within = sum(each["kept"] for each in records)
            ratio = np.median([each["worst"][1] / each["worst"][0] for each in records])
            link = "hanging" if hanging else "horizontal"
            yield [link, len(records), within, better, f"{ratio:.1f}"]


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--runs", type=int, default=400)
    arguments.add_argument("--joints", type=int, default=50)
    arguments.add_argument(
        "--page", action="store_true", help="only the tables of the stored outcomes"
    )
    arguments.add_argument(
        "--write", action="store_true", help="also write the tables into the page"
    )
    given = arguments.parse_args()
    store = Store(PATH, {"runs": given.runs, "joints": given.joints})
    if not given.page:
        measure(store, given.runs, given.joints)
        store.append({"kind": "finished"})
    records = [*store.of("situation"), *store.of("other")]
    publish(DESIGNED, rows(records), write=given.write, runs=given.runs)
    publish(PRIORS, prior_rows(store), write=given.write, runs=max(10, given.runs // 4))
    publish(WIDE, wide_rows(store), write=given.write)
