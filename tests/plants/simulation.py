"""Simulate many joints side by side, and record them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

import jointid as jid
from plants.control import Controller, Sensors
from plants.law import Law
from plants.log import Log
from plants.motion_of_plants import MovingPlants
from plants.motions import Motion
from plants.plant import Plant
from plants.recorder import Signals, recordings

_BLOCK = 500  # ticks of a block of references and noise


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
    runs = bench.runs
    plant, law, log = bench.plant.spread(runs), bench.law.spread(runs), bench.log.spread(runs)
    signals = Signals.empty(runs, round(duration / tick) + 1, tick)
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
    tick = signals.tick
    position, velocity, _ = (x[0, chosen] for x in motion.at(np.zeros(1)))
    moving = MovingPlants(plant, position, velocity, duration)
    sensors = Sensors(log, law.every * tick, position, velocity)
    controller = Controller(law, tick)
    levels = np.array([log.sensor_noise, log.velocity_noise, log.position_noise, log.torque_noise])
    for block in range(0, signals.samples, _BLOCK):
        ticks = range(block, min(block + _BLOCK, signals.samples))
        references = [x[:, chosen] for x in motion.at(np.array(ticks) * tick)]
        noises = rng.standard_normal((4, len(ticks), chosen.size)) * levels[:, None, :]
        for k, i in enumerate(ticks):
            wanted = references[0][k], references[1][k], references[2][k]
            noise = noises[0, k], noises[1, k], noises[2, k]
            v, now = moving.velocity, np.asarray(i % law.every == 0)
            sensors.measure(moving.position, v, moving.link_torque, noise, now)
            command = controller.command(sensors, wanted, now)
            seen = sensors.position, v, sensors.velocity, command, sensors.torque, wanted[0]
            signals.write(i, chosen, *seen)
            signals.noise[i, chosen] = noises[3, k]
            moving.advance(i * tick, command * plant.torque_scale, tick / finer, finer)
