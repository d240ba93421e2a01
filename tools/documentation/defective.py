"""Recordings that each show one finding: a good recording with a defect, a joint unlike its model, or a file."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import jointid as jid
from documentation.staging import ROOT

sys.path.insert(0, str(ROOT / "tests"))
import commanded_torque
import defects
from plants import Bench, Law, Log, Plant, simulate, sines, thesis

GOOD = ROOT / "examples" / "data" / "well_excited.csv.gz"
DURATION = 9.0


@dataclass(frozen=True, kw_only=True)
class Case:
    """The identified recordings, and the call."""

    recording: jid.Recording
    others: tuple[jid.Recording, ...] = ()
    joint: jid.Joint | None = field(default_factory=jid.thesis_joint)
    identify: Mapping[str, Any] = field(default_factory=dict)
    text: str = ""  # content of a file, if the defect is in the file

    def estimate(self) -> jid.Estimate:
        """Identify the recordings."""
        return jid.identify(
            [self.recording, *self.others],
            self.joint,
            **{"search": "separable"} | dict(self.identify),
        )


def cases(folder: Path) -> dict[str, Case]:
    """Return a case for each code of a finding that a recording of one joint can have.

    Parameters
    ----------
    folder : pathlib.Path
        Where files are written.
    """
    good = jid.load(GOOD)
    return damaged(good) | _mismatched() | _unlike(good) | _of_files(good, folder)


# Names from the tests' own table of defects, if it has the code.
_DAMAGED: dict[str, Callable[[jid.Recording], jid.Recording]] = {
    "reversed_sign": defects.reversed_torque,
    "implausible_units": defects.degrees,
    "velocity_mismatch": lambda r: defects.changed(r, velocity=0.8 * r.velocity),
    "delay_removed": defects.late_velocity,
    "wrong_scale": defects.wrong_gear_ratio,
    "torque_saturated": defects.saturated_torque,
    "sensor_clipped": defects.clipped_sensor,
    "spikes": defects.spike,
    "jumps": lambda r: defects.changed(
        r, position=np.where(r.time < 5.0, r.position, r.position - 1.0)
    ),
    "repeated_samples": defects.repeated_sensor,
    "held_rows": defects.repeated_samples,
    "unwrapped": defects.wrapped_angle,
    "time_jitter": defects.jittered_stamps,
    "standing": defects.stuck,
    "gaps": defects.gap,
}


def _rippled(recording: jid.Recording) -> jid.Recording:
    """Add a torque with two periods per revolution of the motor."""
    assert recording.sensor is not None
    ripple = 1.5 * np.sin(202.0 * recording.position)
    return defects.changed(recording, sensor=recording.sensor + ripple)


def _frozen(recording: jid.Recording) -> jid.Recording:
    """Break the sensor's cable at 4 s, for two seconds."""
    assert recording.sensor is not None
    sensor = recording.sensor.copy()
    broken = (recording.time > 4.0) & (recording.time < 6.0)
    sensor[broken] = sensor[broken][0]
    return defects.changed(recording, sensor=sensor)


def damaged(good: jid.Recording) -> dict[str, Case]:
    """Return the cases that are a good recording with a defect."""
    made = _DAMAGED | {"constant_signal": _frozen, "ripple": _rippled}
    found = {code: Case(recording=make(good)) for code, make in made.items()}
    late = defects.late_velocity(good)
    found["signal_lag"] = found["delay"] = Case(recording=late, identify={"shift": {}})
    found["at_bound"] = Case(
        recording=good, identify={"parameters": {"coulomb": {"min": 0.0, "max": 18.0}}}
    )
    found["few_windows"] = Case(recording=good, identify={"windows": 30})
    rough = jid.GaOptions(population=20, generations=8, polish=False)
    found["stopped"] = Case(recording=good, identify={"search": jid.Search(ga=rough)})
    return found


@dataclass(frozen=True, kw_only=True)
class _Unlike:
    """Differences of a simulated joint, its log or the call from the model."""

    plant: Mapping[str, float] = field(default_factory=dict)
    law: Mapping[str, float] = field(default_factory=dict)
    log: Mapping[str, float] = field(default_factory=dict)
    sensor: bool = True
    degrees: float = 60.0
    joint: Callable[[], jid.Joint | None] = jid.thesis_joint
    identify: Mapping[str, Any] = field(default_factory=dict)


def _plain(model: str, **facts: Any) -> jid.Joint:
    """Return a joint without a sensor, with a named model."""
    return jid.Joint(torque_hold="zoh", model=jid.Model.parse(model), **facts)


_INERTIA = float(Plant().inertia)
_UNLIKE: Mapping[str, _Unlike] = {
    "gravity": _Unlike(sensor=False, joint=partial(_plain, "stribeck"), plant={"gravity": 12.0}),
    "inertia_varies": _Unlike(
        sensor=False, plant={"pose_inertia": 1.2}, joint=partial(_plain, "stribeck:gravity=free")
    ),
    "load_friction": _Unlike(plant={"load_friction": 0.15}),
    "slow_motion": _Unlike(
        joint=lambda: jid.thesis_joint().replace(model=jid.Model("coulomb_viscous"))
    ),
    "presliding": _Unlike(degrees=20.0, plant={"bristle_stiffness": 2e4, "bristle_damping": 200.0}),
    "stribeck_exponent": _Unlike(plant={"exponent": 1.0}),
    "drift": _Unlike(plant={"viscous_drift": -0.3}),
    "harmonic": _Unlike(plant={"harmonic_torque": 1.5}),
    "disturbance": _Unlike(plant={"bump": 10.0, "bump_time": 4.0, "bump_width": 0.3}),
    "asymmetry": _Unlike(
        sensor=False,
        plant={"viscous_asymmetry": 0.3, "gravity": 0.0},
        joint=partial(_plain, "stribeck"),
    ),
    "structured_residual": _Unlike(plant={"bump": 2.0, "bump_time": 4.0, "bump_width": 0.3}),
    "model_too_rich": _Unlike(plant={"static": 0.0}),
    "undetermined": _Unlike(degrees=4.0),
    "noisy_velocity": _Unlike(log={"velocity_noise": 0.03}),
    "load_scale": _Unlike(
        sensor=False, joint=lambda: None, identify={"model": "stribeck:load_friction=drive"}
    ),
    "undivided_offset": _Unlike(
        sensor=False,
        plant={"gravity": 0.0},
        joint=lambda: None,
        identify={"model": "coulomb_viscous:asymmetric"},
    ),
    "offset": _Unlike(
        sensor=False,
        plant={"constant": 4.0, "gravity": 0.0},
        joint=partial(_plain, "stribeck", torque_offset=False),
    ),
    "smooth_friction": _Unlike(
        plant={"static": -20.0, "stribeck": 20.0},
        joint=lambda: jid.thesis_joint().replace(model=jid.Model("coulomb_viscous")),
    ),
}


def _mismatched() -> dict[str, Case]:
    """Return joints that differ from their model, simulated in parallel."""
    benches = [
        Bench(
            motion=thesis(np.radians([each.degrees]))
            if each.sensor
            else sines([[0.6, 0.3, 0.1]], [[1.3, 2.9, 5.1]], [[0.0, 1.0, 2.0]]),
            law=Law(
                **{"stiffness": 40.0, "feedback": 1.5 if each.sensor else 0.0, "on_reference": 1.0}
                | dict(each.law)
            ),
            plant=Plant(**each.plant),
            log=Log(
                **{"sensor": float(each.sensor), "torque_noise": 0.0 if each.sensor else 0.3}
                | dict(each.log)
            ),
        )
        for each in _UNLIKE.values()
    ]
    runs = simulate(Bench.stack(benches), duration=DURATION, seed=3, finer=10)
    return {
        code: Case(recording=run, joint=each.joint(), identify=each.identify)
        for (code, each), run in zip(_UNLIKE.items(), runs, strict=True)
    }


def _unlike(good: jid.Recording) -> dict[str, Case]:
    """Return other causes, from formulas."""
    time = np.arange(0.0, 8.0, 1e-3)
    noise = np.random.default_rng(7).normal(size=(2, time.size))
    position = 0.8 * np.sin(2.1 * time) + 0.3 * np.sin(5.3 * time + 1.0)
    velocity = 1.68 * np.cos(2.1 * time) + 1.59 * np.cos(5.3 * time + 1.0)
    acceleration = -0.8 * 2.1**2 * np.sin(2.1 * time) - 0.3 * 5.3**2 * np.sin(5.3 * time + 1.0)
    weight = 15.0 * np.cos(position)
    torque = 2.5 * acceleration + 12.0 * np.sign(velocity) + 6.0 * velocity + noise[0]
    given = jid.Recording(
        time=time,
        position=position,
        velocity=velocity,
        torque=torque + weight,
        extra={"tau": weight + 4.0 * noise[1]},
    )
    tiny = np.round(1e-3 * np.sin(20.0 * time) / 1e-4) * 1e-4
    hardly = jid.Recording(
        time=time, position=tiny, torque=25.0 * np.sign(np.cos(20.0 * time)) + 0.5 * noise[0]
    )
    foreign = jid.Recording(
        time=time, position=position, velocity=velocity, torque=50.0 + 5.0 * noise[0]
    )
    degrees = 25.0 + 3.0 * np.sign(np.sin(1.7 * time)) + 2.0 * np.sin(0.9 * time)
    warm = jid.Recording(
        time=time,
        position=position,
        velocity=velocity,
        torque=torque - 1.5 * (degrees - 25.0),
        temperature=degrees,
    )
    other = jid.Recording(time=time, position=position, velocity=velocity, torque=torque)
    halved = 0.5 * np.asarray(other.crop(4.0, 8.0).torque)
    late = np.zeros(len(good), dtype=int)
    late[2000:9000:350] = 3
    return {
        "noisy_signal": Case(
            recording=given,
            joint=None,
            identify={"model": jid.Model("coulomb_viscous", terms={"tau": "scaled"})},
        ),
        "no_friction": Case(recording=_behind_the_friction(good), joint=None),
        "cross_check": Case(recording=defects.wrong_gear_ratio(good)),
        "hardly_moves": Case(recording=hardly, joint=None, identify={"search": None}),
        "other_signal": Case(recording=warm, joint=None, identify={"model": "coulomb_viscous"}),
        "other_run": Case(
            recording=other.crop(0.0, 4.0),
            others=(defects.changed(other.crop(4.0, 8.0), torque=halved),),
            joint=None,
        ),
        "unsigned_torque": Case(
            recording=defects.changed(other, torque=np.abs(torque)), joint=None
        ),
        "held_torque": Case(recording=commanded_torque.log(2), joint=None),
        "poor_fit": Case(recording=foreign, joint=None),
        "late_samples": Case(recording=defects.changed(good, late=late)),
        "motor_side": Case(
            recording=defects.changed(given, metadata={"side": "motor"}), joint=None
        ),
        "torque_side": Case(
            recording=defects.changed(
                given, metadata={"gear_ratio": 101.0, "assumed_side": "torque"}
            ),
            joint=None,
        ),
        "long_shift": Case(recording=good, identify={"shift": {"torque": 0.5}}),
    }


def _behind_the_friction(good: jid.Recording) -> jid.Recording:
    """Return the torque of only the link."""
    link = 0.3 * np.gradient(good.velocity, good.time) + 5.0 * np.sin(good.position)
    return jid.Recording(
        time=good.time, position=good.position, velocity=good.velocity, torque=link
    )


def _of_files(good: jid.Recording, folder: Path) -> dict[str, Case]:
    """Return files with too little or too much information."""
    assert good.torque is not None
    table = {
        name: getattr(good, name) for name in ("time", "position", "velocity", "torque", "sensor")
    }
    headers = {
        "time": "time_s",
        "position": "position_rad",
        "velocity": "velocity_rad_s",
        "torque": "torque_Nm",
        "sensor": "sensor_raw",
    }
    found = {}
    for code, changes, more in (
        ("assumed_units", {"torque": "torque"}, {}),
        ("left_out", {}, {"motor_current_raw": np.round(good.torque / 0.02)}),
    ):
        columns = {(headers | changes)[name]: values for name, values in table.items()} | more
        path = folder / f"{code}.csv"
        lines = [
            ",".join(f"{value:.7g}" for value in row) for row in zip(*columns.values(), strict=True)
        ]
        text = "\n".join([",".join(columns), *lines])
        path.write_text(text + "\n", encoding="utf-8")
        found[code] = Case(recording=jid.load(path), text="\n".join(text.splitlines()[:4]))
    path = folder / "scope.csv"
    lines = _scope(good)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    scope = Case(
        recording=jid.load(path),
        joint=None,
        identify={"model": "stribeck"},
        text="\n".join(lines[:12]),
    )
    return found | {"interpolated": scope, "message_log": scope}


def _scope(good: jid.Recording) -> list[str]:
    """Return an export of TwinCAT Scope with a torque of four times the period of the position."""
    assert good.torque is not None
    rows = len(good)
    head = ["Name\tScope Project", "File\tC:\\run.svdx", "", ""]
    keys = {
        "Name": ("ActPos", "ActTorque"),
        "SampleTime[ms]": ("1", "4"),
        "SymbolName": ("Axes.Axis 1.ActPos", "Axes.Axis 1.ActTorque"),
        "Unit": ("°", "Nm"),
    }
    head += [f"{key}\t{first}\t{key}\t{second}" for key, (first, second) in keys.items()]
    position, torque = np.degrees(good.position), good.torque[::4]
    lines = []
    for k in range(rows):
        slow = f"{4 * k}\t{torque[k]:.6g}" if k < len(torque) else "\t"
        lines.append(f"{k}\t{position[k]:.9g}\t{slow}")
    return [*head, "", *lines, "EOF"]
