"""Small slow controlled motions, each a little larger than the one before."""

from __future__ import annotations

import math

from jointid.hardware.proof.axis import Axis
from jointid.hardware.proof.refusal import RefusedBenchError
from jointid.hardware.session.velocity_estimator import VelocityEstimator

_TIME = 1.5  # [s] out, and the same time back
_STIFFNESSES = (50.0, 80.0, 120.0)  # [rad/s], natural frequencies of the joint on the controller
_STUCK = 1.0 / 6.0  # of the amplitude: error at which the controller moves a joint that sticks
_DAMPING = 1.0
_HELPED = 0.9  # share of the breakaway that is fed forward
_MOST = 1.2  # largest torque over the breakaway
_WITHIN = 0.6  # largest error over the amplitude, plus some counts
_COUNTS = 20.0


def small_move(
    axis: Axis,
    amplitude: float,
    breakaway: tuple[float, float],
    inertia: float,
    wind_up: float = 0.0,
) -> float:
    """Move by an amplitude and back under control. Return the largest tracking error [rad].

    The torque is at most 1.2 times the breakaway, so that an unstable loop stays slow.

    Parameters
    ----------
    axis : Axis
        Axis at rest, motor on.
    amplitude : float
        Amplitude with its sign [rad].
    breakaway : tuple of float
        Breakaway in the positive and the negative direction [N·m].
    inertia : float
        Inertia at the output [kg·m²].
    wind_up : float
        Elastic angle before the joint slides, which is added to the allowed error [rad]. Default 0.

    Raises
    ------
    RefusedBenchError
        The error is too large, or a bound of the axis is exceeded.
    """
    sticking = (1.0 - _HELPED) * max(breakaway)
    natural = next(
        (each for each in _STIFFNESSES if sticking < _STUCK * abs(amplitude) * inertia * each**2),
        _STIFFNESSES[-1],
    )
    stiffness, damping = inertia * natural**2, 2.0 * _DAMPING * inertia * natural
    speed_of = VelocityEstimator(axis.resolution)
    start, begin = axis.sample.position, axis.now
    allowed = _WITHIN * abs(amplitude) + _COUNTS * axis.resolution + wind_up
    worst = 0.0
    while (elapsed := axis.now - begin) < 2.0 * _TIME:
        sample = axis.read()
        phase = math.pi * elapsed / _TIME
        wanted = start + 0.5 * amplitude * (1.0 - math.cos(phase))
        pace = 0.5 * amplitude * math.sin(phase) * math.pi / _TIME
        error = wanted - sample.position
        worst = max(worst, abs(error))
        if worst > allowed:
            axis.command(0.0)
            raise RefusedBenchError(
                "control",
                f"in a motion of {abs(amplitude):.5f} rad, the joint is {worst:.5f} rad away from the reference; "
                f"at most {allowed:.5f} rad is allowed",
            )
        side = breakaway[0] if pace > 0.0 else breakaway[1]
        torque = stiffness * error + damping * (pace - speed_of(sample.time, sample.position))
        torque += math.copysign(_HELPED * side, pace)
        axis.command(max(-_MOST * breakaway[1], min(_MOST * breakaway[0], torque)))
    axis.rest()
    return worst
