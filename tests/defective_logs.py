"""Log files of simulated joints with the defects and mismatches of real ones, each with its truth."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from plants import Bench, Law, Log, Plant, simulate, sines, thesis

import jointid as jid
from jointid.app.call import Call

DURATION = 8.0
_TURN = 101.0  # of the motor, an output turn
_INERTIA = Plant().inertia
_ENCODER = {"counts": 8000.0 * _TURN, "differenced": 1.0}
_SOFT = {"stiffness": 40.0}
_UNITS = {
    "time": "time_s",
    "position": "position_rad",
    "velocity": "velocity_rad_s",
    "torque": "torque_Nm",
    "sensor": "sensor_raw",
}


@dataclass(frozen=True, kw_only=True)
class Defect:
    """What a simulated log suffers from: in plant or recorder, or in the file."""

    plant: Mapping[str, float] = field(default_factory=dict)
    law: Mapping[str, float] = field(default_factory=dict)
    log: Mapping[str, float] = field(default_factory=dict)
    file: Callable[[dict[str, Any]], dict[str, Any]] = dict
    stated: bool = True  # whether the file's header states the units
    identify: Mapping[str, Any] = field(default_factory=dict)


def _times(**factors: float) -> Callable[[dict[str, Any]], dict[str, Any]]:
    def changed(signals: dict[str, Any]) -> dict[str, Any]:
        return {name: values * factors.get(name, 1.0) for name, values in signals.items()}

    return changed


def _spiked(signals: dict[str, Any]) -> dict[str, Any]:
    torque = signals["torque"].copy()
    torque[len(torque) // 2] += 80.0
    return signals | {"torque": torque}


_DEGREES = 180.0 / np.pi

# For a joint with a sensor and for one without.
DEFECTS: Mapping[str, Defect] = {
    "clean": Defect(),
    "units not stated": Defect(stated=False),
    "degrees": Defect(file=_times(position=_DEGREES, velocity=_DEGREES), stated=False),
    "position in degrees": Defect(file=_times(position=_DEGREES), stated=False),
    "torque reversed": Defect(file=_times(torque=-1.0)),
    "velocity reversed": Defect(file=_times(velocity=-1.0)),
    "sensor reversed": Defect(file=_times(sensor=-1.0)),
    "velocity scaled": Defect(file=_times(velocity=1.1)),
    "torque scaled": Defect(file=_times(torque=1.5)),
    "torque constant 10 % off": Defect(plant={"torque_scale": 1.1}),
    "spike": Defect(file=_spiked),
    "torque late": Defect(log={"torque_delay": 2e-3}),
    "velocity late": Defect(log={"velocity_delay": 3e-3}),
    "backward difference": Defect(law=_SOFT, log=_ENCODER),
    "backward difference, 4 ms": Defect(law=_SOFT | {"every": 4.0}, log=_ENCODER | {"every": 4.0}),
    "filtered": Defect(law={"stiffness": 30.0}, log={"velocity_cutoff": 40.0}),
    "filtered, coarse encoder": Defect(
        law={"stiffness": 30.0},
        log={"velocity_cutoff": 40.0, "differenced": 1.0, "counts": 20_000.0},
    ),
    "coarse encoder": Defect(
        law=_SOFT, log={"counts": 20_000.0, "differenced": 1.0, "velocity": 0.0}
    ),
    "noisy velocity": Defect(log={"velocity_noise": 0.03}),
    "repeated rows": Defect(log={"repeated": 0.1}),
    "host stamps": Defect(log={"stamp_jitter": 2e-4}),
    "host stamps, coarse encoder, 5 ms": Defect(
        law=_SOFT | {"every": 5.0},
        log={"every": 5.0, "stamp_jitter": 5e-4, "counts": 20_000.0, "differenced": 1.0},
    ),
    "uneven samples": Defect(log={"sample_jitter": 2e-4, "jitter_known": 0.0}),
    "clipped sensor": Defect(log={"sensor_clip": 5.0}),
    "rippled": Defect(log={"ripple": 2.6}),
    "drift": Defect(plant={"viscous_drift": -0.3}),
    "presliding": Defect(plant={"bristle_stiffness": 1e5, "bristle_damping": 300.0}),
    "asymmetric": Defect(plant={"asymmetry": 0.2}),
    "load friction": Defect(plant={"load_friction": 0.2}),
    "Stribeck exponent 1": Defect(plant={"exponent": 1.0}),
    "sin 3q": Defect(plant={"harmonic_torque": 1.0}),
    "disturbance": Defect(plant={"bump": 5.0}),
    "no Stribeck effect": Defect(plant={"static": 0.0}),
    "narrow Stribeck effect": Defect(plant={"stribeck": 2000.0, "static": 10.0}),
    "too simple a model": Defect(identify={"model": "coulomb_viscous"}),
    "too narrow a bound": Defect(identify={"parameters": {"coulomb": {"min": 0.0, "max": 18.0}}}),
    "few windows": Defect(identify={"windows": 30}),
    "wrong inertia": Defect(identify={"parameters": {"inertia": 1.3 * float(_INERTIA)}}),
}
_OF_A_SENSOR = ("sensor reversed", "clipped sensor", "rippled")
_OF_AN_INERTIA = ("wrong inertia",)


@dataclass(frozen=True, kw_only=True)
class Case:
    """A call, and what it should find: a value by parameter, or a range."""

    call: Call
    truth: Mapping[str, float | tuple[float, float]]


def names() -> Iterator[str]:
    """Of all cases."""
    for name in DEFECTS:
        yield f"sensor: {name}"
        if name not in _OF_A_SENSOR + _OF_AN_INERTIA:
            yield f"no sensor: {name}"


def simulated(folder: Path) -> dict[str, Case]:
    """All cases by name, with their files in a folder; simulated side by side."""
    chosen = list(names())
    benches = [
        _bench(DEFECTS[name.partition(": ")[2]], name.startswith("sensor")) for name in chosen
    ]
    recordings = simulate(Bench.stack(benches), duration=DURATION, seed=11, finer=2)
    return {
        name: _case(name, recording, folder / f"{number}.npz")
        for number, (name, recording) in enumerate(zip(chosen, recordings, strict=True))
    }


def _bench(defect: Defect, sensor: bool) -> Bench:
    law = Law(**({"stiffness": 60.0, "on_reference": 1.0} | dict(defect.law)))
    log = {"sensor": float(sensor), "torque_noise": 0.0 if sensor else 0.2} | dict(defect.log)
    motion = thesis(np.radians([60.0]))
    if not sensor:
        motion = sines([[0.6, 0.3, 0.1]], [[1.3, 2.9, 5.1]], [[0.0, 1.0, 2.0]])
    return Bench(motion=motion, plant=Plant(**defect.plant), law=law, log=Log(**log))


def _case(name: str, recording: jid.Recording, file: Path) -> Case:
    sensor, defect = name.startswith("sensor"), DEFECTS[name.partition(": ")[2]]
    signals = {each: getattr(recording, each) for each in recording.signals if each in _UNITS}
    if recording.velocity_derived:
        del signals["velocity"]
    signals = defect.file(signals)
    np.savez(file, **{_UNITS[k] if defect.stated else k: v for k, v in signals.items()})
    joint = jid.Joint(
        inertia=float(_INERTIA) if sensor else None,
        gear_ratio=_TURN,
        sensor=sensor,
        model=jid.Model("stribeck", gravity="none" if sensor else "free"),
        torque_hold="zoh",
    )
    identify = dict(defect.identify)
    if not sensor and "model" in identify:
        identify["model"] = f"{identify['model']}:gravity=free"
    truth = dict(recording.truth or {})
    if truth["static"] == 0.0:
        del truth["static"], truth["stribeck"]
    known = {key: value for key, value in truth.items() if value != 0.0}
    return Case(call=Call(file=file, joint=joint, identify=identify), truth=known)
