"""Simulate many joints side by side, and record them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

import jointid as jid
from plants.columns import Array
from plants.law import Law
from plants.log import Log
from plants.motion_of_plants import MovingPlants
from plants.motions import Motion
from plants.plant import Plant
from plants.recorder import Signals, recordings

_BLOCK = 500  # ticks of a block of references and noise
COUNTS = 2.0 * np.pi


@dataclass(frozen=True, kw_only=True)
class Bench:
    """Runs to simulate: plants, their motions and controllers, and what is recorded of them.

    The number of runs is the motion's; other values hold for all runs, or are arrays with one for each.
    """

    motion: Motion
    plant: Plant = field(default_factory=Plant)
    law: Law = field(default_factory=Law)
    log: Log = field(default_factory=Log)

    @property
    def runs(self) -> int:
        return self.motion.runs

    @staticmethod
    def stack(benches: Sequence[Bench]) -> Bench:
        """Runs of several benches, one after the other."""
        return Bench(
            motion=Motion.stack([b.motion for b in benches]),
            plant=Plant.stack([b.plant.spread(b.runs) for b in benches]),
            law=Law.stack([b.law.spread(b.runs) for b in benches]),
            log=Log.stack([b.log.spread(b.runs) for b in benches]),
        )


def simulate(
    bench: Bench, *, duration: float = 10.0, seed: int = 0, tick: float = 1e-3, finer: int = 20
) -> list[jid.Recording]:
    """Simulate all runs; each recording has the truth, and the mismatches in its metadata.

    Parameters
    ----------
    bench : Bench
    duration : float
        [s].
    seed : int
        Of all noise.
    tick : float
        The shortest time between commands or samples [s]; `every` of a law or a log counts them.
    finer : int
        Integration steps a tick.
    """
    plant, law, log = (x.spread(bench.runs) for x in (bench.plant, bench.law, bench.log))
    signals = Signals.empty(bench.runs, round(duration / tick) + 1, tick)
    elastic = plant.gear_stiffness > 0.0
    for number, chosen in enumerate((np.flatnonzero(~elastic), np.flatnonzero(elastic))):
        if chosen.size:
            _run(
                *(bench.motion, chosen, plant.of(chosen), law.of(chosen), log.of(chosen)),
                *(signals, duration, finer, np.random.default_rng([seed, number])),
            )
    return recordings(signals, plant, log, np.random.default_rng([seed, 2]))


def _run(
    motion: Motion,
    chosen: NDArray[np.intp],
    plant: Plant,
    law: Law,
    log: Log,
    signals: Signals,
    duration: float,
    finer: int,
    rng: np.random.Generator,
) -> None:
    """The loop over ticks, of runs that are all rigid or all elastic; writes their columns of the signals."""
    runs, tick, samples = chosen.size, signals.tick, signals.samples
    start = [x[0, chosen] for x in motion.at(np.zeros(1))]
    moving = MovingPlants(plant, start[0], start[1], duration)
    period = law.every * tick
    cutoff = np.where(log.velocity_cutoff > 0.0, log.velocity_cutoff, 1.0)
    follow = np.where(log.velocity_cutoff > 0.0, 1.0 - np.exp(-COUNTS * cutoff * period), 1.0)
    quantum = np.where(log.counts > 0.0, COUNTS / np.maximum(log.counts, 1.0), 1.0)
    command, integral = np.zeros(runs), np.zeros(runs)
    measured, measured_velocity = start[0].copy(), start[1].copy()
    for block in range(0, samples, _BLOCK):
        ticks = np.arange(block, min(block + _BLOCK, samples))
        references = [x[:, chosen] for x in motion.at(ticks * tick)]
        noises = rng.standard_normal((4, ticks.size, runs))
        noises *= np.array(
            [log.sensor_noise, log.velocity_noise, log.position_noise, log.torque_noise]
        )[:, None, :]
        for k, i in enumerate(ticks):
            q, v, link = moving.position, moving.velocity, moving.link_torque
            wanted, wanted_velocity, wanted_acceleration = (x[k] for x in references)
            torque_sensed = link + noises[0, k]
            torque_sensed = torque_sensed + log.ripple * np.sin(
                log.ripple_order * q + log.ripple_phase
            )
            torque_sensed += (
                log.nonlinearity * log.full_scale * (torque_sensed / log.full_scale) ** 3
            )
            seen = q + noises[2, k]
            seen = np.where(log.counts > 0.0, quantum * np.floor(seen / quantum), seen)
            now = i % law.every == 0
            if now.any():
                raw = np.where(log.differenced > 0.0, (seen - measured) / period, v + noises[1, k])
                if i == 0:
                    raw = v
                held = measured_velocity + follow * (raw - measured_velocity)
                measured_velocity = np.where(now, held, measured_velocity)
                measured = np.where(now, seen, measured)
                error, error_rate = seen - wanted, measured_velocity - wanted_velocity
                integral = np.where(now, integral + period * error, integral)
                slip = np.where(law.on_reference > 0.0, wanted_velocity, measured_velocity)
                friction = law.coulomb + law.static * np.exp(-law.stribeck * slip**2)
                pulled = wanted_acceleration - law.stiffness * (
                    2.0 * error_rate + law.stiffness * error
                )
                torque = law.inertia * pulled - law.integral * integral
                torque += friction * np.sign(slip) + law.viscous * slip
                reading = (torque_sensed - log.offset) / log.gain
                torque += law.feedback * reading + law.feedback_offset
                torque += law.gravity * np.cos(wanted + law.gravity_angle)
                command = np.where(now, np.clip(torque, -law.limit, law.limit), command)
            signals.write(i, chosen, seen, v, measured_velocity, command, torque_sensed, wanted)
            signals.noise[i, chosen] = noises[3, k]
            moving.advance(i * tick, command * plant.torque_scale, tick / finer, finer)
