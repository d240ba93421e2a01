"""Runs of the simulated arm of seven joints, and errors of the identified values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from simulated_arm import JOINTS, URDF, Arm, Run, Sensors, random_arm, random_motion, recorded, run

import jointid as jid
from arms import classical
from arms.classical import Array

FRICTION = ("coulomb", "viscous")
NAMES = tuple(f"joint_{number}" for number in range(1, JOINTS + 1))
SLOW = 0.2  # slower rows are left out of the filtered least squares [rad/s]

__all__ = ["FRICTION", "JOINTS", "NAMES", "URDF", "Arm", "Sensors", "random_arm", "recorded"]


def simulated(
    seeds: Iterable[int], *, coupled: bool = False, heavier: float = 1.0
) -> Iterator[tuple[int, Run]]:
    """Return 20 s of a random arm in random motion, one per seed; `heavier` multiplies link 4's inertial parameters."""
    for seed in seeds:
        arm = random_arm(seed, coupled=coupled)
        yield (
            seed,
            run(arm if heavier == 1.0 else arm.with_link_scaled(4, heavier), random_motion(seed)),
        )


@dataclass(frozen=True)
class Errors:
    """By parameter, (runs, joints): relative errors, whether intervals contain the truth, errors over half-widths."""

    relative: dict[str, Array]
    inside: dict[str, Array]
    scaled: dict[str, Array]

    @staticmethod
    def of(found: list[tuple[Arm, dict[str, Array], dict[str, Array]]]) -> Errors:
        """Return the errors of runs: the arm, values and half-widths of the intervals by the parameter's name."""
        relative, inside, scaled = {}, {}, {}
        for name in FRICTION:
            truth = np.array([arm.values(name)[:JOINTS] for arm, _, _ in found])
            values = np.array([each[name] for _, each, _ in found])
            half = np.array([each[name] for _, _, each in found])
            relative[name] = values / truth - 1.0
            inside[name] = np.abs(values - truth) <= half
            scaled[name] = (values - truth) / np.where(half > 0.0, half, np.nan)
        return Errors(relative, inside, scaled)

    def within(self, share: float) -> int:
        """Return the number of runs in which every Coulomb and viscous friction has at most this error."""
        far = np.max([np.abs(each).max(axis=1) for each in self.relative.values()], axis=0)
        return int(np.sum(far <= share))

    def worst(self, name: str) -> float:
        """Return the largest relative error of a parameter."""
        return float(np.abs(self.relative[name]).max())

    @property
    def coverage(self) -> float:
        """Return the share of the intervals that contain the truth."""
        return float(np.mean([each.mean() for each in self.inside.values()]))


def of_estimate(found: jid.RobotEstimate) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return values and half-widths of the intervals; a value without an interval has one of width 0."""
    values, half = {}, {}
    for name in FRICTION:
        every = [found.joints[joint].parameters[name] for joint in NAMES]
        values[name] = np.array([each.value for each in every])
        ends = [each.interval or (0.0, 0.0) for each in every]
        half[name] = np.array([0.5 * (high - low) for low, high in ends])
    return values, half


def by_filtering(
    recording: jid.RobotRecording, cutoff: float | None, every: int = 25
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Identify by the classical method on interpolated even stamps; without a cutoff, from raw position differences."""
    import pinocchio

    assert recording.torque is not None
    count = round(recording.duration * 1e3)
    even = recording.time[0] + np.arange(count) * 1e-3
    position, torque = (
        np.column_stack([np.interp(even, recording.time, each) for each in signal.T])
        for signal in (recording.position, recording.torque)
    )
    if cutoff is None:
        velocity = np.gradient(position, 1e-3, axis=0)
        acceleration = np.gradient(velocity, 1e-3, axis=0)
        signals = classical.Signals(even, position, velocity, acceleration, torque)
    else:
        signals = classical.filtered(even, position, torque, cutoff)
    model = pinocchio.buildModelFromUrdf(str(URDF))
    sources = classical.joint_sources(JOINTS, [SLOW] * JOINTS)
    rows = classical.rows_of(model, sources, signals, every)
    fit = classical.fit(rows, np.ones(len(rows.torque), dtype=bool))
    values, half = {}, {}
    for name in FRICTION:
        each = [f"{name} {number}" for number in range(1, JOINTS + 1)]
        values[name] = np.array([fit.value[key] for key in each])
        half[name] = 1.96 * np.array([fit.error[key] for key in each])
    return values, half
