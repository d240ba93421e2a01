"""Travel of a joint after its host dies, simulated: the torque is held until the drive's time-out, then it is 0."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.moving_joint import MovingJoint
from jointid.joint.joint import Joint
from jointid.simulation.plant import Values, simulated_joint
from jointid.simulation.trajectory import FloatArray, Trajectory

_MOMENTS = 20_000  # number of moments of a motion; only the worst are simulated
_ALIKE = 0.01  # share of the largest torque; moments that differ by less count as one
_PLACES = 4  # parts of the range, if torque depends on the angle; the worst of each are kept
_STEP = 2e-3  # [s], longest step of the simulation; a shorter hold has 20 steps
_STEPS = 20
_FIRST, _LONGEST = 0.25, 64.0  # [s], coasting: first and longest; doubled until rest
_STANDS = 1e-3  # [rad/s]
IndexArray = npt.NDArray[np.intp]
_HELD = _core.Trajectory.step(distance=1.0, time=0.0, duration=1e9)


@dataclass(frozen=True, slots=True)
class Moments:
    """Instants of a motion at which the host may die.

    Parameters
    ----------
    position, velocity, torque : ndarray
        Position [rad] and velocity [rad/s]; torque that the drive holds from then on [N·m].
    """

    position: FloatArray
    velocity: FloatArray
    torque: FloatArray


class DeadHost:
    """Simulation of a joint after the death of its host.

    Parameters
    ----------
    joint : Joint or None
        The stated values are used. Without a stated friction, the friction torque is assumed to stay constant.
        Without a stated inertia, the acceleration is assumed to stay constant.
    largest_torque : float
        Limit of the commands [N·m].

    Attributes
    ----------
    coasts : bool
        Whether no friction is stated. The travel after the time-out is then unknown, and only the travel before counts.
    """

    def __init__(self, joint: Joint | None, largest_torque: float) -> None:
        self._joint, self.coasts = _believed(joint)
        self._limit = min(largest_torque, self._joint.torque_limit)
        self._turns = bool(self._joint.weights or self._joint.harmonics)

    def worst_moments(self, *motions: Moments) -> Moments:
        """Return the moments of some motions with the longest possible travel."""
        position, velocity, torque = (
            np.concatenate([getattr(motion, name) for motion in motions])
            for name in ("position", "velocity", "torque")
        )
        kept = self._worst(position, velocity, torque)
        return Moments(position[kept], velocity[kept], torque[kept])

    def _worst(self, position: FloatArray, velocity: FloatArray, push: FloatArray) -> IndexArray:
        """Return the moments with no other moment as fast and with as much torque, to 1 %, in either direction.

        A joint goes farther with a larger velocity and a larger torque, whatever its friction.
        """
        place = np.zeros(len(position))
        if self._turns and np.ptp(position) > 0.0:
            place = np.floor(_PLACES * (position - position.min()) / np.ptp(position))
        steps = np.round(push / (_ALIKE * np.abs(push).max() or 1.0))
        kept = []
        for direction in (1.0, -1.0):
            for each in np.unique(place):
                here = np.flatnonzero(place == each)
                speed, pushed = direction * velocity[here], direction * steps[here]
                order = np.lexsort((-pushed, -speed))
                strongest = np.maximum.accumulate(pushed[order])
                kept.append(here[order[np.diff(strongest, prepend=-np.inf) > 0.0]])
        return np.unique(np.concatenate(kept))

    def moments(self, trajectory: Trajectory, period: float, *, offset: float = 0.0) -> Moments:
        """Return the worst moments of a motion that the joint follows exactly, with the torque that it needs there.

        Parameters
        ----------
        trajectory : Trajectory
        period : float
            Period of the commands [s].
        offset : float
            Added to the trajectory's positions [rad].
        """
        apart = max(period, trajectory.duration / _MOMENTS)
        motion = trajectory.sample(np.arange(0.0, trajectory.duration, apart))
        # If friction falls with speed, an omitted moment may need a little more torque.
        kept = self._worst(*motion)
        position, velocity, wanted = (each[kept] for each in motion)
        position = position + offset
        free = self._run(Moments(position, velocity, np.zeros_like(position)), 1, _STEP)
        mass = self._joint.inertia + self._joint.link_inertia
        torque = mass * (wanted - free["true_acceleration"][:, 0])
        return Moments(position, velocity, np.clip(torque, -self._limit, self._limit))

    def commanded(
        self, trajectory: Trajectory, period: float, position: float, limits: SessionLimits
    ) -> Moments:
        """Return the moments of a motion under a torque trajectory, from rest at `position` [rad] until a limit."""
        steps = max(1, round(trajectory.duration / period))
        begin = Moments(np.full(1, position), np.zeros(1), np.ones(1))
        found = self._run(begin, steps, period, trajectory.core)
        names = ("true_position", "true_velocity", "torque")
        places, speeds, torques = (found[name][0, :: max(1, steps // _MOMENTS)] for name in names)
        low, high = limits.position
        beyond = (places < low) | (places > high) | (np.abs(speeds) > limits.velocity)
        kept = slice(None, int(np.argmax(beyond)) if beyond.any() else None)
        return Moments(places[kept], speeds[kept], torques[kept])

    def travel(self, moments: Moments, time: float) -> float:
        """Return the longest travel of a joint from its position at the death of its host [rad].

        Parameters
        ----------
        moments : Moments
        time : float
            Time until the drive cuts the torque [s]. A drive that also damps, holds or brakes only shortens the travel.
            The amount is not declared.
        """
        start = moments.position[:, np.newaxis]
        farthest = 0.0
        if time > 0.0:
            steps = max(_STEPS, math.ceil(time / _STEP))
            held = self._run(moments, steps + 1, time / steps)
            farthest = float(np.abs(held["true_position"] - start).max())
            moments = _last(held, moments)
        duration = _FIRST
        while not self.coasts and duration <= _LONGEST:
            if not (np.abs(moments.velocity) > _STANDS).any():
                break
            freed = self._run(
                replace(moments, torque=np.zeros_like(moments.torque)),
                round(duration / _STEP),
                _STEP,
            )
            farthest = max(farthest, float(np.abs(freed["true_position"] - start).max()))
            moments = _last(freed, moments)
            duration *= 2.0
        return farthest

    def _run(
        self,
        begin: Moments,
        steps: int,
        step: float,
        torque: _core.Trajectory = _HELD,
    ) -> dict[str, FloatArray]:
        """Return the signals of a joint from each moment on, one row for each moment."""
        scenario = _core.Scenario(
            duration=steps * step,
            control_period=step,
            integration_step=step,
            sample_every=1,
            settling=0.0,
            sensors=_core.Sensors(),
        )
        setups = [
            _core.Setup(
                joint=self._joint,
                controller=_core.OpenLoop(gain=gain),
                gear_ratio=1.0,
                sensor_gain=1.0,
                sensor_offset=0.0,
                position=position,
                velocity=velocity,
                seed=0,
            )
            for position, velocity, gain in zip(
                begin.position.tolist(), begin.velocity.tolist(), begin.torque.tolist(), strict=True
            )
        ]
        outcomes = _core.simulate_runs(scenario, torque, setups, signals=True, threads=1)
        names = ("true_position", "true_velocity", "true_acceleration", "torque")
        signals = [each.signals for each in outcomes]  # computed again at each access
        return {name: np.array([each[name] for each in signals]) for name in names}


def _last(found: dict[str, FloatArray], before: Moments) -> Moments:
    """Return the state at the end of each run."""
    return Moments(found["true_position"][:, -1], found["true_velocity"][:, -1], before.torque)


def _believed(joint: Joint | None) -> tuple[_core.SimulatedJoint, bool]:
    """Return the joint to simulate, and whether its friction is left out because it is not stated."""
    moving = MovingJoint.of(joint)
    if joint is not None and moving is not None:
        known = {name for name, each in joint.parameters.items() if each.value is not None}
        model = joint.model.resolved
        stated = joint.model.replace(
            ripple=_both(known, "ripple", model.ripple),
            harmonics=_both(known, "position", model.harmonics),
            terms={},
        )
        try:
            whole = joint.replace(model=stated)
            return simulated_joint(whole, Values(whole), 0.0, None), False
        except InputError:
            pass  # a value that a simulation needs is not stated
    return _core.SimulatedJoint(inertia=1.0 if moving is None else moving.inertia), True


def _both(known: set[str], name: str, orders: tuple[float, ...]) -> tuple[float, ...]:
    """Return the orders with a stated sine and cosine."""
    return tuple(
        order for order in orders if {f"{name}_sin_{order:g}", f"{name}_cos_{order:g}"} <= known
    )
