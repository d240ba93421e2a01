"""The conditions of `conditions_study.py`: recordings of random joints, clean or with one mismatch or defect.

The joints are simulated by the tests' `plants`, which share no code with the package.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import jointid as jid

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from plants import Bench, Law, Log, Motion, Plant, chirp, sines, thesis, trapezoids

DURATION = 12.0
TURN = 101.0  # motor revolutions per output revolution
Value = float | tuple[float, float]  # a pair: drawn evenly between the two for each joint


@dataclass(frozen=True, kw_only=True)
class Condition:
    """Recordings that differ in the joint, and the arguments of `identify`.

    Attributes
    ----------
    name : str
    clean : bool
        Whether the model holds and the signals have no defect.
    sensor : bool
        A torque sensor between drive and link; the drive's inertia is then given. Without one, inertia and
        gravity are identified.
    motion : {"thesis", "slow", "sines", "trapezoids", "chirp"}
    every : int
        Milliseconds between commands and samples.
    duration : float
        [s].
    model : str or None
        Model of the joint in the call; None: without a joint, `identify(recording)` chooses.
    plant, law, log : mapping
        Fields of `Plant`, `Law` and `Log` that differ from the random joint's.
    """

    name: str
    clean: bool = False
    sensor: bool = True
    motion: str = "thesis"
    every: int = 1
    duration: float = DURATION
    model: str | None = ""
    plant: Mapping[str, Value] = field(default_factory=dict)
    law: Mapping[str, Value] = field(default_factory=dict)
    log: Mapping[str, Value] = field(default_factory=dict)

    @property
    def called_with(self) -> str | None:
        """Return the model of the call's joint."""
        if self.model is None or self.model:
            return self.model
        return "stribeck" if self.sensor else "stribeck:gravity=free"

    def joint(self, recording: jid.Recording) -> jid.Joint | None:
        """Return the facts that are known before the identification."""
        if self.called_with is None:
            return None
        inertia = recording.metadata["plant"]["inertia"] if self.sensor else None
        return jid.Joint(
            inertia=inertia,
            gear_ratio=TURN,
            sensor=self.sensor,
            model=jid.Model.of(self.called_with),
            torque_hold="zoh",
        )

    def bench(self, runs: int, rng: np.random.Generator) -> Bench:
        """Return random joints under this condition."""

        def draw(value: Value) -> NDArray[np.float64]:
            low, high = value if isinstance(value, tuple) else (value, value)
            return rng.uniform(low, high, runs)

        coulomb, inertia = draw((8.0, 35.0)), np.exp(draw((np.log(0.7), np.log(4.0))))
        plant: dict[str, Any] = {
            "inertia": inertia,
            "coulomb": coulomb,
            "static": coulomb * draw((0.4, 1.0)),
            "stribeck": draw((50.0, 200.0)),
            "viscous": draw((6.0, 30.0)),
            "link_inertia": inertia * draw((0.05, 0.2)),
            "gravity": draw((4.0, 12.0)),
        } | {name: draw(value) for name, value in self.plant.items() if name != "gear_frequency"}
        if "gear_frequency" in self.plant:
            rate = 2.0 * np.pi * draw(self.plant["gear_frequency"])
            plant["gear_stiffness"] = rate**2 * plant["link_inertia"]
            plant["gear_damping"] = 0.1 * rate * plant["link_inertia"]
        log: dict[str, Any] = {
            "every": float(self.every),
            "sensor": float(self.sensor),
            "gain": draw((1.0, 4.0)),
            "offset": draw((-20.0, 20.0)),
            "sensor_noise": 0.2,
            "torque_noise": 0.0 if self.sensor else 0.2,
        } | {name: draw(value) for name, value in self.log.items()}
        law: dict[str, Any] = {
            "every": float(self.every),
            "inertia": inertia * draw((0.8, 1.2)),
            "stiffness": 60.0,
            "on_reference": 1.0,
            "coulomb": coulomb * draw((0.5, 1.2)),
            "static": coulomb * draw((0.0, 1.0)),
            "viscous": draw((5.0, 25.0)),
            "feedback": log["gain"] * draw((0.5, 1.0)) * self.sensor,
            "gravity": plant["gravity"] * draw((0.5, 1.2)) * (not self.sensor),
            "limit": 1000.0,
        } | {name: draw(value) for name, value in self.law.items()}
        return Bench(
            motion=_motion(self.motion, runs, rng),
            plant=Plant(**plant),
            law=Law(**law),
            log=Log(**log),
        )


def _motion(name: str, runs: int, rng: np.random.Generator) -> Motion:
    def draw(low: float, high: float) -> NDArray[np.float64]:
        return rng.uniform(low, high, runs)

    if name in ("thesis", "slow"):
        degrees = draw(50.0, 70.0) if name == "thesis" else draw(15.0, 25.0)
        return thesis(np.radians(degrees), draw(2.5, 4.0))
    if name == "sines":
        spread = rng.uniform(0.8, 1.2, (2, runs, 3))
        amplitude, rate = np.array([0.6, 0.3, 0.1]), np.array([1.3, 2.9, 5.1])
        return sines(amplitude * spread[0], rate * spread[1], rng.uniform(0.0, 6.28, (runs, 3)))
    if name == "trapezoids":
        return trapezoids(draw(0.5, 1.0), draw(0.6, 1.5), draw(3.0, 8.0), 0.1)
    return chirp(draw(0.6, 1.0), draw(0.08, 0.15), draw(0.6, 1.2), DURATION)


def _clean(name: str, **fields: Any) -> Condition:
    return Condition(name=name, clean=True, **fields)


MEASURED: Mapping[str, Value] = {"on_reference": 0.0, "stiffness": 40.0}
LAGGING: Mapping[str, Value] = {"differenced": 1.0, "counts": 8000 * TURN}
LUGRE: Mapping[str, Value] = {"bristle_stiffness": 1e5, "bristle_damping": 300.0}
POSE: Mapping[str, Value] = {"pose_inertia": (0.2, 0.5), "link_inertia": (1.0, 1.5)}
NO_STRIBECK: Mapping[str, Value] = {"static": 0.0}


def encoder(counts: float) -> dict[str, Any]:
    """Record only positions, in counts per output revolution; control uses their backward difference."""
    return {"law": MEASURED, "log": {"counts": counts, "velocity": 0.0, "differenced": 1.0}}


CONDITIONS = (
    _clean("sensor"),
    _clean("sensor, no noise", log={"sensor_noise": 0.0}),
    _clean("sensor, noise 0.5 N·m", log={"sensor_noise": 0.5}),
    _clean("sensor, noise 2 N·m", log={"sensor_noise": 2.0}),
    _clean("sensor, sample period 2 ms", every=2),
    _clean("sensor, sample period 4 ms", every=4),
    _clean("sensor, recording of 4 s", duration=4.0),
    _clean("sensor, sum of sines", motion="sines"),
    _clean("sensor, trapezoids", motion="trapezoids"),
    _clean("sensor, chirp", motion="chirp"),
    _clean("sensor, slow motion", motion="slow"),
    _clean("sensor, encoder 808,000 counts/rev", **encoder(8000 * TURN)),
    _clean("sensor, call without a joint", model=None),
    _clean("no sensor", sensor=False),
    _clean("no sensor, sum of sines", sensor=False, motion="sines"),
    _clean("no sensor, trapezoids, sample period 2 ms", sensor=False, motion="trapezoids", every=2),
    _clean("no sensor, chirp, noise 0.5 N·m", sensor=False, motion="chirp", log={"torque_noise": 0.5}),
    _clean("no sensor, no gravity", sensor=False, model="stribeck", plant={"gravity": 0.0}),
    _clean("no sensor, Coulomb and viscous", sensor=False, plant=NO_STRIBECK,
           model="coulomb_viscous:gravity=free"),
    _clean("no sensor, encoder 202,000 counts/rev", sensor=False, **encoder(2000 * TURN)),
    _clean("no sensor, call without a joint", sensor=False, model=None),
    Condition(name="no sensor, encoder 50,500 counts/rev, sample period 2 ms", sensor=False, every=2,
              **encoder(500 * TURN)),
    Condition(name="sensor, encoder 20,000 counts/rev", **encoder(20000.0)),
    Condition(name="velocity noise 0.02 rad/s", log={"velocity_noise": 0.02}),
    Condition(name="torque 1 ms late", log={"torque_delay": 1e-3}),
    Condition(name="torque 3 ms late", log={"torque_delay": 3e-3}),
    Condition(name="sensor 3 ms late", log={"sensor_delay": 3e-3}),
    Condition(name="velocity 3 ms late", log={"velocity_delay": 3e-3}),
    Condition(name="velocity by backward difference, sample period 4 ms", every=4, law=MEASURED, log=LAGGING),
    Condition(name="viscous friction drifts by -10 %", plant={"viscous_drift": -0.1}),
    Condition(name="viscous friction drifts by -30 %", plant={"viscous_drift": -0.3}),
    Condition(name="Coulomb friction drifts by -20 %, no sensor", sensor=False, plant={"coulomb_drift": -0.2}),
    Condition(name="presliding stiffness 1e5 N·m/rad", plant=LUGRE),
    Condition(name="presliding stiffness 1e5 N·m/rad, no sensor", sensor=False, plant=LUGRE),
    Condition(name="load friction, coefficient 0.03", plant={"load_friction": 0.03}),
    Condition(name="load friction, coefficient 0.1, no sensor", sensor=False, plant={"load_friction": 0.1}),
    Condition(name="friction asymmetry 20 %", plant={"asymmetry": 0.2}),
    Condition(name="friction asymmetry 20 %, no sensor", sensor=False,
              plant={"asymmetry": 0.2, "constant": (-20.0, 20.0)}),
    Condition(name="torque 0.3 N·m · sin 3q", plant={"harmonic_torque": 0.3}),
    Condition(name="sensor ripple 2.6 N·m", log={"ripple": 2.6}),
    Condition(name="torque constant wrong by 10 %", plant={"torque_scale": 1.1}),
    Condition(name="Stribeck exponent 1 instead of 2", plant={"exponent": 1.0}),
    Condition(name="elastic gear, natural frequency 20 to 80 Hz, no sensor", sensor=False,
              plant={"gear_frequency": (20.0, 80.0)}),
    Condition(name="inertia varies by 20 %, no sensor", sensor=False, plant=POSE),
    Condition(name="disturbance 5 N·m for 1 s", plant={"bump": 5.0}),
    Condition(name="10 % of the rows repeated", log={"repeated": 0.1}),
)  # fmt: skip
