"""Small slow motions under control, each a little wider than the one before."""

from __future__ import annotations

import math

from jointid.hardware.proof.axis import Axis
from jointid.hardware.proof.refusal import RefusedBenchError
from jointid.hardware.session.velocity_estimator import VelocityEstimator

_TIME = 1.5  # [s] there, and as long back
_STIFFNESSES = (50.0, 80.0, 120.0)  # [rad/s] of the joint's inertia on the controller's spring
_STUCK = 1.0 / 6.0  # of the amplitude: the error at which the spring moves a joint that sticks
_DAMPING = 1.0
_HELPED = 0.9  # share of the breakaway that is commanded ahead
_MOST = 1.2  # of the breakaway
_WITHIN = 0.6  # of the amplitude: the largest error, beside some counts
_COUNTS = 20.0


def small_move(
    axis: Axis,
    amplitude: float,
    breakaway: tuple[float, float],
    inertia: float,
    wind_up: float = 0.0,
) -> float:
    """Move by an amplitude and back, under control; returns the largest tracking error [rad].

    The torque is kept within 1.2 times the breakaway, so that a loop that goes the wrong way cannot go far.

    Parameters
    ----------
    axis : Axis
        At rest, motor on.
    amplitude : float
        With its sign [rad].
    breakaway : tuple of float
        In the positive and in the negative direction [N·m].
    inertia : float
        [kg·m²]
    wind_up : float
        Angle by which the joint yields before it slides [rad]: the error may be so much larger. Default 0.

    Raises
    ------
    RefusedBenchError
        The error is too large, or a bound of the axis.
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
                f"the joint is {worst:.5f} rad away from the reference of a motion of {abs(amplitude):.5f} rad, more "
                f"than {allowed:.5f} rad",
            )
        side = breakaway[0] if pace > 0.0 else breakaway[1]
        torque = stiffness * error + damping * (pace - speed_of(sample.time, sample.position))
        torque += math.copysign(_HELPED * side, pace)
        axis.command(max(-_MOST * breakaway[1], min(_MOST * breakaway[0], torque)))
    axis.rest()
    return worst
