"""A servo bench with known truth: a pendulum on a servo whose log is late, coarse and not simultaneous.

The plant is the core's at a tenth of a millisecond, with a supply that sags under the motor's current; what is logged
is read from it one value after the other, rounded, and with a velocity that lags.
"""

from dataclasses import dataclass, replace

import numpy as np

import jointid as jid
from jointid import _core

TORQUE_CONSTANT, RESISTANCE, SUPPLY = 0.36, 4.0, 7.4
VISCOUS, COULOMB, LOAD_FRICTION, INERTIA = 0.006, 0.01, 0.15, 0.0017
MASS, LENGTH = 0.49, 0.1
LAG, ROW, PERIOD = 0.020, 0.0025, 0.0052
COUNT = 2.0 * np.pi / 4096
SAG = 0.15  # Ω, of the supply and its leads
LOOP_GAIN = 0.0028774


@dataclass(frozen=True)
class Truth:
    """What a simulated servo is."""

    torque_constant: float = TORQUE_CONSTANT
    resistance: float = RESISTANCE
    viscous: float = VISCOUS
    coulomb: float = COULOMB
    load_friction: float = LOAD_FRICTION
    inertia: float = INERTIA

    @property
    def values(self) -> dict[str, float]:
        """By the names of an estimate."""
        return {
            "torque_per_voltage": self.torque_constant / self.resistance,
            "back_emf": self.torque_constant**2 / self.resistance,
            "viscous": self.viscous,
            "coulomb": self.coulomb,
            "load_friction": self.load_friction,
            "inertia": self.inertia,
            "torque_constant": self.torque_constant,
            "resistance": self.resistance,
        }


@dataclass(frozen=True)
class Bench:
    """How the bench is built and read; what an identification may wrongly assume."""

    sag: float = SAG
    row: float = ROW  # s, by which a row's position is older than its duty
    play: float = (
        0.0  # rad, between the load and the sensor, which is on the motor's side of the gear
    )
    mass: float = MASS
    delay: float = 0.0  # s, of the position loop
    friction: tuple[tuple[str, float, float, tuple[float, ...]], ...] = ()
    """Of the core's joint, beyond the truth's: basis, both directions' coefficients, shapes."""


def servo_joint(*, supply: float | None = None, resistance: float | None = None) -> jid.Joint:
    """What is known of the bench before an identification."""
    return jid.Joint(
        name="servo",
        link=jid.Link(mass=MASS, centre_of_mass=LENGTH, angle=-np.pi / 2),
        voltage=jid.VoltageDrive(
            supply=supply, resistance=resistance, position_loop=jid.PositionLoop(gain=LOOP_GAIN)
        ),
    )


def references(
    time: np.ndarray, kind: int, generator: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """One of four wanted motions, each a little different every time, and when the motor is driven."""
    a, b = generator.uniform(0.9, 1.1, 2)
    driven = np.ones(len(time))
    if kind == 0:
        wanted = a * np.sin(2.6 * b * time) + 0.5 * np.sin(7.1 * time + b)
    elif kind == 1:
        wanted = np.where(time < 2.0, -1.6 * a, 0.0) * np.clip(time / 0.4, 0.0, 1.0)
        driven = np.where(time < 1.5 * b, 1.0, 0.0)
    elif kind == 2:
        wanted = 1.5 * a * (1.0 - np.cos(1.05 * b * time)) / 2.0
    else:
        wanted = 1.5 * np.sin(0.9 * a * time**2)
    return wanted, driven


def bench_runs(
    truth: Truth | None = None,
    *,
    seed: int = 0,
    runs: int = 16,
    free: bool = True,
    bench: Bench | None = None,
) -> list[jid.Recording]:
    """Record runs of the bench.

    Parameters
    ----------
    truth : Truth, optional
    seed : int
        Of motions, jitter of the rows and noise of the supply.
    runs : int
    free : bool
        Whether some runs let the motor turn freely.
    bench : Bench, optional
    """
    truth, bench = truth or Truth(), bench or Bench()
    generator = np.random.default_rng(seed)
    fine = np.arange(0.0, 6.0, 1e-3)
    gains = (100.0, 200.0, 400.0, 800.0)
    loops, logs, plans = [], [], []
    for number in range(runs):
        wanted, driven = references(fine, number % 4, generator)
        gain = LOOP_GAIN * gains[(number // 4) % 4]
        if not free:
            driven = np.ones(len(fine))
        plans.append((wanted, driven, gain))
        loops.append(_loop(truth, gain, bench))
        logs.append((fine, wanted, np.full(len(fine), SUPPLY), driven))
    # A sagging supply depends on the duty, which depends on the motion: two passes settle it.
    for _ in range(2):
        motions = _core.roll_out_servos(loops, logs, step=1e-4)
        for k, ((position, velocity), (wanted, driven, gain)) in enumerate(
            zip(motions, plans, strict=True)
        ):
            duty = np.clip(gain * (wanted - position), -1.0, 1.0) * driven
            current = np.abs(duty) * np.abs(duty * SUPPLY - truth.torque_constant * velocity)
            supply = SUPPLY - bench.sag * current / truth.resistance
            logs[k] = (fine, wanted, supply, driven)
    motions = _core.roll_out_servos(loops, logs, step=1e-4)
    return [
        _logged(
            fine,
            (_sensed(truth, bench, motion, log, plan[2]), motion[1]),
            log,
            (plan[2], gains[(k // 4) % 4], bench.row, bench.delay),
            generator,
            k,
        )
        for k, (motion, log, plan) in enumerate(zip(motions, logs, plans, strict=True))
    ]


def _sensed(
    truth: Truth,
    bench: Bench,
    motion: tuple[np.ndarray, np.ndarray],
    log: tuple[np.ndarray, ...],
    gain: float,
) -> np.ndarray:
    """Position on the motor's side of the gear's play, whose teeth touch on the side of the torque through them."""
    position, velocity = motion
    if bench.play == 0.0:
        return position
    _, wanted, supply, driven = log
    k_t, resistance = truth.torque_constant, truth.resistance
    volts = np.clip(gain * (wanted - position), -1.0, 1.0) * supply
    motor = k_t / resistance * (volts - k_t * velocity) * driven
    through = motor - bench.mass * 9.80665 * LENGTH * np.sin(position)
    return np.asarray(position + 0.5 * bench.play * np.tanh(through / 0.01))


def _loop(truth: Truth, gain: float, bench: Bench) -> _core.ServoLoop:
    sides = [("constant", truth.coulomb), ("linear", truth.viscous)]
    plant = _core.SimulatedJoint(
        inertia=truth.inertia + bench.mass * LENGTH**2,
        friction=[*((basis, value, value, ()) for basis, value in sides), *bench.friction],
        weights=[(bench.mass * 9.80665 * LENGTH, -np.pi / 2)],
    )
    k_t = truth.torque_constant
    return _core.ServoLoop(
        joint=plant,
        torque_per_voltage=k_t / truth.resistance,
        back_emf=k_t * k_t / truth.resistance,
        load_friction=truth.load_friction,
        gain=gain,
        delay=bench.delay,
    )


def _logged(
    fine: np.ndarray,
    motion: tuple[np.ndarray, np.ndarray],
    log: tuple[np.ndarray, ...],
    loop: tuple[float, float, float, float],
    generator: np.random.Generator,
    number: int,
) -> jid.Recording:
    """Read the signals one after the other: position at the row's time, duty and supply later."""
    position, velocity = motion
    _, wanted, supply, driven = log
    gain, unit, row, delay = loop
    stamps = np.cumsum(generator.uniform(0.97, 1.03, int(5.95 / PERIOD)) * PERIOD)
    stamps = stamps[stamps < fine[-1] - 0.01]
    later = stamps + row
    at = np.interp(stamps, fine, position)
    held = wanted[np.searchsorted(fine, later, side="right") - 1]  # as the loop has it
    acted = wanted[np.searchsorted(fine, later - delay, side="right") - 1]
    duty = np.clip(gain * (acted - np.interp(later - delay, fine, position)), -1.0, 1.0)
    on = driven[np.searchsorted(fine, stamps)]
    volts = np.interp(later, fine, supply) + generator.normal(0.0, 0.1, len(stamps))
    return jid.Recording(
        time=stamps,
        position=np.round(at / COUNT) * COUNT,
        velocity=np.round(np.interp(stamps - LAG, fine, velocity) / 0.024) * 0.024,
        reference=held,
        extra={
            "duty": np.round(duty * 885.0) / 885.0 * on,
            "supply": np.round(volts, 1),
            "driven": on,
            "gain": np.full(len(stamps), unit),
        },
        name=f"run {number}",
    )


def without_free_runs(runs: list[jid.Recording]) -> list[jid.Recording]:
    """The runs in which the motor is driven throughout."""
    return [run for run in runs if np.asarray(run.extra["driven"]).min() > 0.5]


def with_truth(truth: Truth, joint: jid.Joint) -> jid.Joint:
    """The joint with the true values."""
    assert joint.voltage is not None
    return joint.replace(
        torque_constant=truth.torque_constant,
        inertia=truth.inertia,
        voltage=replace(joint.voltage, resistance=truth.resistance),
    ).with_parameters(
        {
            "viscous": truth.viscous,
            "coulomb": truth.coulomb,
            "load_friction": truth.load_friction,
        }
    )


def changed(run: jid.Recording, **fields: object) -> jid.Recording:
    """Return a run with some of its signals changed."""
    kept: dict[str, object] = {
        name: getattr(run, name) for name in ("time", "position", "velocity", "reference", "extra")
    }
    return jid.Recording(**(kept | fields), name=run.name)  # type: ignore[arg-type]
