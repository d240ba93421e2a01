"""Build the core's judge of motions from a joint, its prior, its controller and its limits."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.excitation.balance_noise import noise_of_balance
from jointid.excitation.motion_limits import MotionLimits
from jointid.excitation.prior import Ranges
from jointid.excitation.request import Request
from jointid.excitation.simulated_friction import largest_other, largest_viscous
from jointid.joint.joint import Joint
from jointid.simulation.arguments import Controller
from jointid.simulation.batch import setup_of

Array = NDArray[np.float64]

SINES = 8
_ALIKE = 0.2  # relative difference of errors that the search ignores
_FADE = 0.5  # [s], for a motion of 10 s or more
_WINDOW = 0.01  # [s]
_MARGIN = 0.01  # share of each limit that the reference leaves to the joint
_TORQUE_MARGIN = 0.03  # the same for the torque, which noise changes
_FASTEST = 8.0  # [Hz]
_UNLIMITED = 1e300


def fade_of(duration: float) -> float:
    """Return the time in which a motion fades in and out [s]."""
    return min(_FADE, 0.05 * duration)


@dataclass(frozen=True, kw_only=True)
class Situation:
    """All data that judge a motion, except the motion itself."""

    joint: Joint
    request: Request
    ranges: Ranges
    limits: MotionLimits
    controller: Controller
    sensors: _core.Sensors
    duration: float  # [s]
    control_period: float  # [s]
    criterion: str
    known: Array  # prior information about the free parameters, shape (p, p)

    def judge(
        self, values: list[dict[str, float]], *, coarse: int = 1, believed: bool = False
    ) -> _core.Excitation:
        """Return the judge for joints with these values. The control period is `coarse` times as long.

        If `believed`, the prior's ranges count as information.
        """
        period = self.control_period * coarse
        scenario = _core.Scenario(
            duration=self.duration,
            control_period=period,
            integration_step=period if coarse > 1 else 0.5 * period,
        )
        return _core.Excitation(
            family=self._family(values),
            scenario=scenario,
            joints=[self._drawn(each, scenario, believed) for each in values],
            held=self._held(),
            criterion=self.criterion,
            window=max(1, round(max(_WINDOW, self.duration / 5000.0) / period)),
        )

    def with_values(self, values: Mapping[str, float]) -> Joint:
        """Return the joint with the torque limit of the motion and these values, without bounds."""
        return self._free.with_parameters(values)

    @functools.cached_property
    def _free(self) -> Joint:
        """Joint with the torque limit of the motion, without its free parameters."""
        torque = self.limits.torque
        limited = self.joint
        if torque is not None:
            limited = limited.replace(limits=replace(limited.limits, torque=torque, current=None))
        names = self.request.names
        kept = {name: own for name, own in limited.parameters.items() if name not in names}
        return limited.replace(parameters=kept)

    def setup(
        self, values: Mapping[str, float], scenario: _core.Scenario, seed: int = 0
    ) -> _core.Setup:
        """Return the simulation run of one joint."""
        return setup_of(self.with_values(values), self.controller, seed, 0.0, None, scenario)[0]

    def _drawn(
        self, values: dict[str, float], scenario: _core.Scenario, believed: bool
    ) -> _core.DrawnJoint:
        names = self.request.names
        setup = self.setup(values, scenario)
        scale = np.array([self.ranges.scale(name, values[name]) for name in names])
        width = np.array([high - low for low, high in (self.ranges.ranges[n] for n in names)])
        own = np.diag(1.0 / np.maximum(width, 1e-3 * scale) ** 2)
        inertia = setup.joint.inertia
        if not self.joint.sensor:
            inertia += setup.joint.link_inertia
        return _core.DrawnJoint(
            setup=setup,
            columns=self.request.columns(values),
            noise=noise_of_balance(
                self.joint,
                setup,
                self.sensors,
                period=scenario.control_period,
                sampled=self.control_period,
                torque=self.torque,
                velocity=self.limits.velocity,
            ),
            scale=scale,
            weight=np.array([float(name in self.request.wanted) for name in names]),
            # The information of listed joints is in `known`. A range adds its own information.
            known=self.known + own if believed and not self.ranges.drawn else self.known,
            inertia=inertia,
            viscous=largest_viscous(setup.joint),
        )

    @property
    def torque(self) -> float:
        """Largest torque of the drive [N·m]."""
        assert self.limits.torque is not None  # `MotionLimits.of` ensures it
        return self.limits.torque

    def _held(self) -> _core.HeldLimits:
        limits = self.limits
        return _core.HeldLimits(
            lowest=limits.position[0],
            highest=limits.position[1],
            velocity=limits.velocity,
            acceleration=_UNLIMITED,
            torque=(1.0 - 0.5 * _TORQUE_MARGIN) * self.torque,
            link_torque=limits.sensor_range or _UNLIMITED,
        )

    def _family(self, values: list[dict[str, float]]) -> _core.MotionFamily:
        limits = self.limits
        low, high = limits.position
        inside = _MARGIN * (high - low)
        velocity = (1.0 - _MARGIN) * limits.velocity
        inertia, viscous, dry = self._needs(values)
        torque = (1.0 - _TORQUE_MARGIN) * self.torque
        if dry >= torque:
            raise InputError(
                f"friction, load and gravity alone may need a torque of {dry:.3g}, so no motion is possible",
                argument="torque",
                value=self.torque,
                place="limits",
                remedy="narrow the prior, or allow more torque",
            )
        room = max(torque - dry, 0.0) / inertia
        acceleration = min(room, limits.acceleration or _UNLIMITED)
        slowest = 2.0 * math.pi * 0.5 / self.duration
        fastest = min(2.0 * math.pi * _FASTEST, 2.0 * acceleration / velocity)
        fastest = min(fastest, 0.1 / self.control_period)
        return _core.MotionFamily(
            sines=SINES,
            duration=self.duration,
            fade=fade_of(self.duration),
            slowest=slowest,
            fastest=max(fastest, 4.0 * slowest),
            bounds=_core.MotionBounds(
                lowest=low + inside,
                highest=high - inside,
                velocity=velocity,
                acceleration=(1.0 - _MARGIN) * limits.acceleration
                if limits.acceleration is not None
                else 1e12,
                torque=torque,
                inertia=inertia,
                viscous=viscous,
                dry=dry,
            ),
        )

    def _needs(self, values: list[dict[str, float]]) -> tuple[float, float, float]:
        """Return inertia, viscous friction, and dry friction with load, each of the joint that needs most."""
        scenario = _core.Scenario(
            duration=self.duration,
            control_period=self.control_period,
            integration_step=self.control_period,
        )
        inertia = viscous = dry = 0.0
        for each in values:
            made = self.setup(each, scenario).joint
            inertia = max(inertia, made.inertia + made.link_inertia)
            viscous = max(viscous, largest_viscous(made))
            load = sum(abs(torque) for torque, _ in made.weights)
            load += sum(math.hypot(cos, sin) for _, cos, sin in made.harmonics)
            friction = largest_other(made, self.limits.velocity)
            dry = max(dry, friction + load + abs(made.torque_offset) + abs(made.load))
        return inertia, viscous, dry


def alike(
    fine: list[_core.MotionJudgement] | None, coarse: list[_core.MotionJudgement] | None
) -> bool:
    """Return whether the judgements of a motion at two control periods hardly differ, for every joint."""
    if fine is None or coarse is None:
        return fine is None and coarse is None
    ratios = [np.abs(np.log(a.errors / b.errors)) for a, b in zip(fine, coarse, strict=True)]
    return bool(np.max(ratios) < _ALIKE)
