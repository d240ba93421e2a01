"""Random joints for `faulty_logs.py`: drawn, simulated by the tests' `plants`, sampled, and written as text files."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

import jointid as jid

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from plants import Bench, Law, Log, Motion, Plant, chirp, simulate, sines, thesis, trapezoids

T = TypeVar("T")
Array = NDArray[np.float64]
Table = dict[str, Array]
"""Signal → samples in SI units; the order is that of the columns."""

TURN = 2.0 * np.pi
DURATION = 12.0
FINER = 5  # integration steps of 0.2 ms in a millisecond
RATES = (1, 2, 4, 5, 10)  # ms between samples


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """A random joint and its motions, before the simulation.

    Attributes
    ----------
    motions : sequence of Motion
        One run each.
    every : int
        Milliseconds between samples.
    held : bool
        Whether the torque is a command that is held between samples, not a measured one.
    plant : dict
        Fields of `Plant`.
    noise : float
        Standard deviation of the recorded torque [N·m].
    limit : float
        Limit of the commanded torque [N·m].
    """

    motions: Sequence[Motion]
    every: int
    held: bool
    plant: Mapping[str, float]
    noise: float
    limit: float = 1e6

    @property
    def bench(self) -> Bench:
        """Return the simulated bench: without noise, at each millisecond."""
        p = self.plant
        command = self.every if self.held else 1
        law = Law(
            every=command,
            inertia=p["inertia"] + p["link_inertia"],
            stiffness=min(30.0, 300.0 / command),
            on_reference=1.0,
            coulomb=0.9 * p["coulomb"],
            static=0.0,
            viscous=p["viscous"],
            gravity=p["gravity"],
            limit=self.limit,
        )
        log = Log(gain=1.0, offset=0.0, sensor_noise=0.0)
        motion = Motion.stack(self.motions)
        return Bench(motion=motion, plant=Plant(**p), law=law, log=log)

    @property
    def truth(self) -> dict[str, float]:
        """Return the joint's parameters by the package's names, without a torque sensor."""
        p = self.plant
        truth = {
            "inertia": p["inertia"] + p["link_inertia"],
            "coulomb": p["coulomb"],
            "viscous": p["viscous"],
            "torque_offset": p["constant"],
            "gravity_cos": 0.0,
            "gravity_sin": p["gravity"],
        }
        if p["static"]:  # without it its shape has no meaning
            truth |= {"static": p["static"], "stribeck": p["stribeck"]}
        return truth


def simulated(drawn: Sequence[Drawn], duration: float = DURATION) -> list[list[Table]]:
    """Return exact runs of each joint at each millisecond, simulated together; `link` is the torque behind the gear."""
    benches = [each.bench for each in drawn]
    runs = iter(simulate(Bench.stack(benches), duration=duration, finer=FINER))
    return [[_table(next(runs)) for _ in each.motions] for each in drawn]


def _table(run: jid.Recording) -> Table:
    assert run.torque is not None
    assert run.sensor is not None
    assert run.velocity is not None
    return {
        "time": run.time,
        "position": run.position,
        "velocity": run.velocity,
        "torque": run.torque,
        "link": run.sensor,
    }


@dataclass(frozen=True)
class Draw:
    """Random values of one log.

    Attributes
    ----------
    rng : Generator
    turn : int
        Number of earlier logs of this kind, by which `variant` takes turns.
    """

    rng: np.random.Generator
    turn: int = 0

    def between(self, low: float, high: float) -> float:
        """Draw evenly."""
        return float(self.rng.uniform(low, high))

    def scale(self, low: float, high: float) -> float:
        """Draw evenly on a logarithmic scale."""
        return float(np.exp(self.rng.uniform(np.log(low), np.log(high))))

    def whole(self, low: int, high: int) -> int:
        """Draw an integer, both ends included."""
        return int(self.rng.integers(low, high + 1))

    def one(self, values: Sequence[T]) -> T:
        """Draw one of these."""
        return values[int(self.rng.integers(len(values)))]

    def variant(self, values: Sequence[T]) -> T:
        """Return one of these, in turn."""
        return values[self.turn % len(values)]

    def chance(self, share: float) -> bool:
        """Draw whether an event of this probability happens."""
        return bool(self.rng.random() < share)

    def motion(self, amplitude: float) -> Motion:
        """Return one run of about this travel [rad]: three sines, the thesis, a chirp, or trapezoids."""
        name = self.one(("sines", "sines", "thesis", "chirp", "trapezoids"))
        if name == "sines":
            sizes = amplitude * np.array([0.6, 0.3, 0.1]) * self.rng.uniform(0.8, 1.2, 3)
            rates = np.array([1.1, 2.7, 5.3]) * self.rng.uniform(0.8, 1.2, 3)
            return sines(sizes[None], rates[None], self.rng.uniform(0.0, TURN, (1, 3)))
        if name == "thesis":
            return thesis([amplitude], self.between(2.5, 4.0))
        if name == "chirp":
            low, high = self.between(0.1, 0.2), self.between(0.7, 1.2)
            return chirp([amplitude], low, high, DURATION)
        speed = amplitude * self.between(1.0, 2.0)
        return trapezoids([amplitude], speed, speed * self.between(3.0, 6.0), 0.1)

    def joint(
        self,
        motions: Sequence[Motion],
        every: int,
        *,
        gravity: bool | None = None,
        stribeck: bool | None = None,
        offset: bool | None = None,
        held: bool = False,
        limit: float = 1e6,
    ) -> Drawn:
        """Draw a joint of any size with friction, inertia and weight in proportion to its motions.

        Parameters
        ----------
        motions : sequence of Motion
        every : int
            Milliseconds between samples.
        gravity, stribeck, offset : bool, optional
            Whether it has them. Default: by chance (1/2, 1/6 where 5 ms or less show it, 1/3).
        held : bool
            Whether the torque is a command that is held between samples.
        limit : float
            Limit of the torque without Coulomb friction and weight, as a share of the need. Default: none.
        """
        times = np.arange(0.0, DURATION, 0.01)
        moves = [motion.at(times) for motion in motions]
        speed = float(np.median([np.quantile(np.abs(v), 0.98) for _, v, _ in moves]))
        rise = float(np.median([2.0 * np.sqrt(np.mean(a**2)) for _, _, a in moves]))
        coulomb = self.scale(0.3, 30.0)
        inertia = coulomb * self.between(0.4, 2.0) / rise
        weight = coulomb * self.between(0.5, 3.0)
        static = coulomb * self.between(0.3, 0.8)
        decay = speed * self.between(0.1, 0.25)
        constant = coulomb * self.between(-0.3, 0.3)
        share = self.between(0.05, 0.2)
        plant = {
            "inertia": inertia * (1.0 - share),
            "link_inertia": inertia * share,
            "coulomb": coulomb,
            "viscous": coulomb * self.between(0.2, 1.0) / speed,
            "static": static if self._has(stribeck, 1 / 6 if every <= 5 else 0.0) else 0.0,
            "stribeck": decay**-2,
            "gravity": weight if self._has(gravity, 1 / 2) else 0.0,
            "constant": constant if self._has(offset, 1 / 3) else 0.0,
        }
        most = coulomb + plant["gravity"] + limit * (plant["viscous"] * speed + inertia * rise)
        noise = coulomb * self.between(0.005, 0.02)
        return Drawn(
            motions=motions,
            every=every,
            held=held,
            plant=plant,
            noise=noise,
            limit=most,
        )

    def _has(self, given: bool | None, share: float) -> bool:
        by_chance = self.chance(share)  # always drawn, so that later draws do not depend on it
        return by_chance if given is None else given

    def sampled(
        self, run: Table, joint: Drawn, every: int = 0, *, velocity: bool = True, fine: float = 1.0
    ) -> Table:
        """Return a good drive's recording of a run: a fine encoder, little noise.

        Parameters
        ----------
        run : Table
        joint : Drawn
        every : int
            Milliseconds between samples. Default: the joint's.
        velocity : bool
            Whether it is recorded.
        fine : float
            Factor on the resolution of the encoder.
        """
        chosen = slice(None, None, every or joint.every)
        table = {name: values[chosen].copy() for name, values in run.items()}
        size = table["time"].size
        travel = max(float(np.ptp(run["position"])), 1e-6)
        step = travel / (self.scale(2e4, 2e5) * fine)
        table["position"] = step * np.round(table["position"] / step)
        fast = float(np.abs(run["velocity"]).max())
        table["velocity"] += self.rng.normal(0.0, 0.0005 * fast, size)
        for name in ("torque", "link"):
            table[name] += self.rng.normal(0.0, joint.noise, size)
        if not velocity:
            del table["velocity"]
        return table


@dataclass(frozen=True, kw_only=True)
class Layout:
    """Format of a table: header and factor from SI of each signal, and the separator of cells."""

    headers: Mapping[str, str]
    factors: Mapping[str, float] = field(default_factory=dict)
    separator: str = ","

    def text(self, table: Table, *, header: bool = True) -> str:
        """Return the file's text; signals without a header are left out."""
        names = [name for name in self.headers if name in table]
        columns = [table[name] * self.factors.get(name, 1.0) for name in names]
        cells = [
            np.char.mod("%.9g" if name == "time" else "%.7g", values)
            for name, values in zip(names, columns, strict=True)
        ]
        lines = [self.separator.join(row) for row in zip(*cells, strict=True)]
        first = [self.separator.join(self.headers[name] for name in names)] if header else []
        return "\n".join([*first, *lines, ""])


def layout(time: str, position: str, velocity: str, torque: str, **more: object) -> Layout:
    """Return one of four layouts; the factors are those of the units in the headers."""
    headers = {"time": time, "position": position, "velocity": velocity, "torque": torque}
    factors = {name: _factor(header) for name, header in headers.items()}
    return Layout(headers=headers, factors=factors, separator=str(more.get("separator", ",")))


def _factor(header: str) -> float:
    for word, factor in _UNITS.items():
        if word in header:
            return factor
    return 1.0


_UNITS = {"ms]": 1e3, "_ms": 1e3, "deg": 360.0 / TURN, "rpm": 60.0 / TURN, "mNm": 1e3}

LAYOUTS = (
    layout("time_s", "position_rad", "velocity_rad_s", "torque_Nm"),
    layout("time [s]", "position [rad]", "velocity [rad/s]", "torque [Nm]", separator=";"),
    layout("time_s", "position_deg", "velocity_deg_s", "torque_Nm"),
    layout("time [ms]", "position [deg]", "velocity [rpm]", "torque [Nm]", separator="\t"),
    layout("timestamp_ms", "actual_position_deg", "actual_velocity_deg_s", "actual_torque_mNm"),
)
