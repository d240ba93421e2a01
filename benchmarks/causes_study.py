"""Causes that the findings name for each broken assumption, over random joints and motions."""

import argparse
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import jointid as jid
from jointid.identification.causes.families import BY_NAME

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from measured import Part, publish
from plants import Bench, Law, Log, Plant, chirp, simulate, sines, thesis, trapezoids

Array = NDArray[np.float64]

HARM = 0.05  # relative shift of a parameter that counts; two standard errors also count
BATCH = 10  # joints of each plant in one simulation
DURATION = 12.0
_HEADER = (
    "mismatch of the plant",
    "with sensor: joints with a shifted value",
    "cause named [% of these joints]",
    "joints with only a wrong name",
    "without sensor: joints with a shifted value",
    "cause named [% of these joints]",
    "joints with only a wrong name",
)
CAUSES = Part(
    title="Causes",
    asked="Do the findings name the broken assumption? {joints} random joints per plant, four kinds of motion, 12 s "
    "at 1 kHz, seed {seed}. Each row breaks one assumption.",
    header=_HEADER,
    reading="*Shifted value*: the mismatch shifts a parameter by more than 5 % or two standard errors. *Only a wrong "
    "name*: findings name only other causes. With and without sensor, findings also name the cause for {needless} "
    "joints without a shifted value. No recording shows an elastic gear, backlash, a varying inertia behind a sensor "
    "or, without a sensor, a wrong torque constant. So no finding names these mismatches.",
)
MILDER = Part(
    title="Causes: milder mismatches",
    asked="Do the findings name milder mismatches? Each mismatch has {size:g} times its size in [Causes](#causes). "
    "{joints} joints per plant, seed {seed}.",
    header=_HEADER,
    reading="Many of these mismatches shift no value. Many others shift a value by little more than two standard "
    "errors. With and without sensor, findings also name the cause for {needless} joints without a shifted value.",
)
SLOW = {"slow_motion", "presliding", "stribeck_exponent"}


@dataclass(frozen=True)
class Case:
    """One broken assumption: its name, the right names of its cause, and the model of the identification."""

    name: str
    right: frozenset[str] = frozenset()
    model: str = ""


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
    _case("torque_delay", "delay of torque"),
    _case("sensor_delay", "delay of sensor"),
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
    _case("torque_delay", "delay of torque", model="stribeck:gravity=free"),
    _case("bump", "disturbance", model="stribeck:gravity=free"),
    _case("coupling", "other_signal", model="stribeck:gravity=free"),
    _case("asymmetry", "asymmetry", model="stribeck:gravity=free"),
    _case("elastic", model="stribeck:gravity=free"),
    _case("backlash", model="stribeck:gravity=free"),
    _case("torque_scale", model="stribeck:gravity=free"),
)


def benches(
    case: Case, joints: int, sensor: bool, rng: np.random.Generator, size: float = 1.0
) -> list[Bench]:
    """Return random joints of one case on four kinds of motion; `size` is the share of the mismatch's full size."""
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
        plant |= _smaller(broken.get(case.name, {}), size)
        if case.name == "pose_inertia" and not sensor:
            plant["link_inertia"] = between(1.5, 2.5)
        measured: dict[str, dict[str, object]] = {
            "ripple": {"ripple": between(1.0, 3.0)},
            "torque_delay": {"torque_delay": between(1e-3, 3e-3)},
            "sensor_delay": {"sensor_delay": between(1e-3, 3e-3)},
        }
        log |= _smaller(measured.get(case.name, {}), size)
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


# Values of a plant without mismatch: other than 0, and infinite.
_SOUND = {"exponent": 2.0, "torque_scale": 1.0}
_STIFF = {"bristle_stiffness", "gear_stiffness"}
_KEPT = {
    "bristle_damping",
    "gear_damping",
    "bump_time",
    "bump_width",
    "coupling_rate",
    "harmonic_phase",
}


def _smaller(broken: dict[str, object], size: float) -> dict[str, object]:
    """Return a mismatch with a share of its size."""
    found: dict[str, object] = {}
    for name, value in broken.items():
        whole = np.asarray(value, dtype=np.float64)
        if size == 1.0 or name in _KEPT:
            found[name] = value
        elif name in _STIFF:
            found[name] = whole / size
        else:
            sound = _SOUND.get(name, 0.0)
            found[name] = sound + size * (whole - sound)
    return found


def runs(
    cases: Sequence[Case], joints: int, sensor: bool, seed: int, size: float = 1.0
) -> Iterator[tuple[Case, jid.Recording, jid.Recording]]:
    """Yield each case with two recordings: with the mismatch, and of the same joint and noise without it."""
    rng = np.random.default_rng(seed)
    apart: dict[bool, list[tuple[Case, Bench]]] = {False: [], True: []}
    for case in cases:
        for bench in benches(case, joints, sensor, rng, size):
            apart[case.name in ("elastic", "backlash")].append((case, bench))
    for pairs in apart.values():
        if not pairs:
            continue
        broken = simulate(Bench.stack([b for _, b in pairs]), duration=DURATION, seed=seed)
        whole = [replace(b, plant=_sound(case, b.plant), log=_prompt(b.log)) for case, b in pairs]
        sound = simulate(Bench.stack(whole), duration=DURATION, seed=seed)
        recordings = zip(broken, sound, strict=True)
        for case, bench in pairs:
            for _ in range(bench.motion.runs):
                yield case, *next(recordings)


def _sound(case: Case, plant: Plant) -> Plant:
    """Return the plant without its mismatches."""
    new = Plant()
    names = ("inertia", "coulomb", "static", "stribeck", "viscous", "link_inertia", "constant")
    same = {name: getattr(plant, name) for name in (*names, "gravity", "gravity_angle")}
    if case.name == "gravity":
        same["gravity"] = 0.0
    if case.name == "no_stribeck":
        same["static"] = 0.0
    return replace(new, **same)


def _prompt(log: Log) -> Log:
    return replace(log, ripple=0.0, torque_delay=0.0, sensor_delay=0.0)


def identified(
    case: Case, recording: jid.Recording, sensor: bool, shift: dict[str, float] | None = None
) -> jid.Estimate:
    """Return the estimate of a call with the known facts of the joint."""
    given: dict[str, Any] = {"inertia": float((recording.truth or {})["inertia"])} if sensor else {}
    model = jid.Model.parse("stribeck" if sensor else case.model)
    joint = jid.Joint(gear_ratio=101.0, sensor=sensor, model=model, **given)
    return jid.identify(recording, joint, search="separable", shift=shift)


def named(case: Case, recording: jid.Recording, estimate: jid.Estimate) -> list[str]:
    """Return the named causes in the order of the findings; removed delays come first.

    A note about a harmless cause does not count, nor a delay if its removal shifted no value.
    """
    found = _late(estimate)
    if case.name == "coupling":
        plant = recording.metadata["plant"]
        signal = np.sin(plant["coupling_rate"] * recording.time + plant["coupling_phase"])
        causes = estimate.causes({"other axis": signal}).found
        return found + [_full(each.name, each.detail) for each in causes]
    for finding in estimate.findings:
        if finding.code in BY_NAME and finding.severity != "info":
            detail = finding.message.partition(" (")[2].partition(",")[0]
            found.append(_full(finding.code, detail))
    return found


def _late(estimate: jid.Estimate) -> list[str]:
    """Return the delays that remain, and the removed delays that shifted a value."""
    texts = [
        finding.message
        for finding in estimate.findings
        if (finding.code == "delay_removed" and finding.parameters)
        or (finding.code == "signal_lag" and finding.severity != "info")
    ]
    return [
        f"delay of {each.signal}"
        for each in estimate.delays.values()
        if any(text.startswith(f"the {each.signal} ") for text in texts)
    ]


def _full(name: str, detail: str) -> str:
    return f"delay of {detail}" if name == "delay" else name


def moved(broken: jid.Estimate, sound: jid.Estimate, truths: Sequence[dict[str, object]]) -> bool:
    """Return whether the mismatch shifts a parameter by more than 5 % or two standard errors."""
    for name, p in broken.parameters.items():
        if not p.vary or name not in sound.parameters:
            continue
        true, before = (
            value if isinstance(value := truth.get(name), float) else 0.0 for truth in truths
        )
        reference = sound.parameters[name]
        move = abs((p.value - true) - (reference.value - before))
        small = "offset" in name or "gravity" in name
        scale = max(abs(reference.value), 10.0) if small else abs(reference.value)
        if move > HARM * scale or (p.stderr is not None and move > 2.0 * p.stderr):
            return True
    return False


def varied(recording: jid.Recording, estimate: jid.Estimate, sensor: bool) -> bool:
    """Return whether a varying coefficient differs from its estimate by more than 5 % or two standard errors."""
    plant = recording.metadata["plant"]
    halves = {
        "viscous": 0.5 * abs(plant["viscous_drift"] * plant["viscous"]),
        "coulomb": 0.5 * abs(plant["coulomb_drift"] * plant["coulomb"]),
    }
    if not sensor:  # with a sensor, the link's inertia is not in the model
        halves["inertia"] = (
            0.5 * plant["pose_inertia"] * float(np.ptp(np.cos(2.0 * recording.position)))
        )
    return any(
        p is not None and half > min(HARM * abs(p.value), 2.0 * (p.stderr or np.inf))
        for name, half in halves.items()
        if (p := estimate.parameters.get(name)) is not None
    )


@dataclass
class Row:
    """Counts of the named causes of one case."""

    joints: int = 0
    harmed: int = 0
    named: int = 0
    harmless: int = 0  # the right cause is named, but no value is shifted
    wrong: int = 0  # only wrong causes are named

    def add(self, right: frozenset[str], harmed: bool, found: list[str]) -> None:
        """Count one joint."""
        self.joints += 1
        self.harmed += harmed
        hit = bool(right & set(found))
        if harmed:
            self.named += hit
        else:
            self.harmless += hit
        self.wrong += bool(found) and not hit

    def cells(self, right: frozenset[str]) -> list[object]:
        """Return three columns of the table."""
        share = f"{100.0 * self.named / self.harmed:.0f}" if self.harmed and right else "–"
        return [self.harmed, share, self.wrong]


def counted(
    cases: Sequence[Case], joints: int, sensor: bool, seed: int, verbose: bool, size: float = 1.0
) -> dict[str, Row]:
    """Return the counts of each case."""
    rows = {case.name: Row() for case in cases}
    for first in range(0, joints, BATCH):
        count = min(BATCH, joints - first)
        for case, broken, sound in runs(cases, count, sensor, seed + first, size):
            estimate = identified(case, broken, sensor)
            found = named(case, broken, estimate)
            harmed = False
            if case.name != "clean":
                late = any(each.startswith("delay") for each in case.right)
                as_it_is = identified(case, broken, sensor, {}) if late else estimate
                truths = [dict(each.truth or {}) for each in (broken, sound)]
                harmed = moved(as_it_is, identified(case, sound, sensor), truths)
                harmed |= varied(broken, as_it_is, sensor)
            rows[case.name].add(case.right, harmed, found)
            if verbose:
                print(case.name, harmed, found, flush=True)
    return rows


def needless(cases: Sequence[Case], rows: Mapping[str, Row]) -> str:
    """Return how many mismatches with a name are named although they shift no value."""
    nameable = [rows[case.name] for case in cases if case.right]
    harmless = sum(row.joints - row.harmed for row in nameable)
    return f"{sum(row.harmless for row in nameable)} of {harmless}"


def main() -> None:
    """Publish the table, with a sensor and without one."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--joints", type=int, default=20, help="random joints per plant")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--only", default="", help="only plants with one of these words in their names"
    )
    parser.add_argument(
        "--size",
        type=float,
        default=1.0,
        help="share of each mismatch's full size; below 1 most mismatches are harmless",
    )
    parser.add_argument("--verbose", action="store_true", help="print the result of each joint")
    parser.add_argument("--write", action="store_true", help="also write the table into the page")
    given = parser.parse_args()
    began = time.perf_counter()
    words = given.only.split() or [""]
    lines: dict[str, list[object]] = {}
    said = []
    for place, whole in enumerate((WITH_SENSOR, WITHOUT)):
        cases = [case for case in whole if any(word in case.name for word in words)]
        found = counted(cases, given.joints, not place, given.seed, given.verbose, given.size)
        said.append(needless(cases, found))
        for case in cases:
            cells = lines.setdefault(case.name, [case.name, *("–",) * 6])
            cells[1 + 3 * place : 4 + 3 * place] = found[case.name].cells(case.right)
    publish(
        CAUSES if given.size == 1.0 else MILDER,
        lines.values(),
        write=given.write,
        joints=given.joints,
        seed=given.seed,
        size=given.size,
        needless=" and ".join(said),
    )
    print(f"{time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main()
