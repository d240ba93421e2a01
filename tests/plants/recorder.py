"""From the simulated signals at every tick to recordings: late, clipped, jittered, repeated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import jointid as jid
from plants.columns import Array
from plants.log import Log
from plants.plant import Plant


@dataclass(frozen=True)
class Signals:
    """Signals of all runs at every tick, (ticks, runs)."""

    tick: float
    position: Array
    exact_velocity: Array
    velocity: Array
    torque: Array
    sensed: Array
    reference: Array
    noise: Array

    @staticmethod
    def empty(runs: int, samples: int, tick: float) -> Signals:
        return Signals(tick, *(np.empty((samples, runs)) for _ in range(7)))

    @property
    def samples(self) -> int:
        return len(self.position)

    def write(self, i: int, chosen: NDArray[np.intp], *values: Array) -> None:
        of_drive = (self.position, self.exact_velocity, self.velocity)
        for signal, value in zip(
            (*of_drive, self.torque, self.sensed, self.reference), values, strict=True
        ):
            signal[i, chosen] = value


def recordings(
    signals: Signals, plant: Plant, log: Log, rng: np.random.Generator
) -> list[jid.Recording]:
    """One recording for each run."""
    return [
        _recording(signals, run, plant.one(run), log.one(run), rng)
        for run in range(signals.position.shape[1])
    ]


def _recording(
    s: Signals, run: int, plant: dict[str, Any], log: dict[str, Any], rng: np.random.Generator
) -> jid.Recording:
    ticks = np.arange(s.samples) * s.tick
    taken = ticks[:: int(log["every"])]
    period = s.tick * int(log["every"])
    if log["sample_jitter"]:
        moved = rng.normal(0.0, log["sample_jitter"], taken.size)
        taken = taken + np.clip(moved, -0.45 * period, 0.45 * period)
        taken[0] = 0.0
    exact = not log["sample_jitter"]

    def late(signal: Array, delay: float) -> Array:
        if exact and abs(delay / s.tick - round(delay / s.tick)) < 1e-9:
            index = np.clip(np.rint((taken - delay) / s.tick).astype(int), 0, s.samples - 1)
            return np.asarray(signal[index])
        return np.asarray(np.interp(taken - delay, ticks, signal))

    sensed = s.sensed[:, run]
    if log["sensor_cutoff"]:
        sensed = _low_pass(sensed, 1.0 - np.exp(-2.0 * np.pi * log["sensor_cutoff"] * s.tick))
    if log["sensor_clip"]:
        sensed = np.clip(sensed, -log["sensor_clip"], log["sensor_clip"])
    # A held command is exact at any time.
    held = np.floor((taken - log["torque_delay"]) / s.tick + 1e-9).astype(int)
    torque = s.torque[np.clip(held, 0, s.samples - 1), run]
    torque = torque + np.interp(taken, ticks, s.noise[:, run])
    columns = {
        "position": late(s.position[:, run], 0.0),
        "velocity": late(s.velocity[:, run], log["velocity_delay"]),
        "torque": torque,
        "sensor": late((sensed - log["offset"]) / log["gain"], log["sensor_delay"]),
        "reference": late(s.reference[:, run], 0.0),
    }
    if not log["velocity"]:
        del columns["velocity"]
    if not log["sensor"]:
        del columns["sensor"]
    stamps = taken if log["jitter_known"] else np.arange(taken.size) * period
    if log["stamp_jitter"]:
        stamps = np.maximum.accumulate(stamps + rng.exponential(log["stamp_jitter"], stamps.size))
        stamps = stamps + np.arange(stamps.size) * 1e-9
    if log["repeated"]:
        index = np.arange(stamps.size)
        index[1:] -= rng.random(stamps.size - 1) < log["repeated"]
        columns = {name: values[index] for name, values in columns.items()}
    if log["dropped"]:
        kept = rng.random(stamps.size) >= log["dropped"]
        stamps, columns = stamps[kept], {name: v[kept] for name, v in columns.items()}
    return jid.Recording(
        time=stamps,
        **columns,
        torque_hold="zoh",
        metadata={"plant": plant, "log": log},
        truth=truth_of(plant, log),
    )


def truth_of(plant: dict[str, Any], log: dict[str, Any]) -> dict[str, float]:
    """The joint's parameters by the package's names; of what drifts, the mean over the run."""
    truth = {name: plant[name] for name in ("inertia", "static", "stribeck")}
    for name in ("coulomb", "viscous"):
        truth[name] = plant[name] * (1.0 + 0.5 * plant[f"{name}_drift"])
    if log["sensor"]:
        return truth | {"sensor_gain": log["gain"], "sensor_offset": log["offset"]}
    truth["inertia"] = plant["inertia"] + plant["link_inertia"]
    truth["gravity_cos"] = plant["gravity"] * np.cos(plant["gravity_angle"])
    truth["gravity_sin"] = -plant["gravity"] * np.sin(plant["gravity_angle"])
    truth["torque_offset"] = plant["constant"]
    # The cosine of 90° is not quite 0.
    return {name: 0.0 if abs(value) < 1e-12 else float(value) for name, value in truth.items()}


def _low_pass(signal: Array, follow: float) -> Array:
    from scipy.signal import lfilter

    begin = [(1.0 - follow) * signal[0]]
    return np.asarray(lfilter([follow], [1.0, follow - 1.0], signal, zi=begin)[0])
