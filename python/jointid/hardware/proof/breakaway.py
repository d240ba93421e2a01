"""Breakaway: the torque from zero, slowly, until the joint moves."""

from __future__ import annotations

import math
from dataclasses import dataclass

from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.proof.axis import Axis
from jointid.hardware.proof.refusal import RefusedBenchError
from jointid.hardware.proof.sensor_watch import SensorWatch

_QUIET = 0.2  # [s] at no torque, in which the sensor's mean is taken
_WIND_UP = 0.1  # [s] that the torque is held after the first counts: what still moves then slides
_SWING = 0.1  # [s]
_FLOOR = 300.0  # the torque begins to grow like the cap over this


@dataclass(frozen=True, slots=True)
class Breakaway:
    """Where a joint began to move.

    Attributes
    ----------
    torque : float
        Magnitude [N·m], by the joint file's constants.
    along : bool
        It moved the way that the torque pushes.
    wind_up : float
        Angle by which it had yielded before, without sliding [rad].
    """

    torque: float
    along: bool
    wind_up: float


def find_breakaway(
    axis: Axis,
    direction: float,
    cap: float,
    options: FirstMotionOptions,
    deviation: float = math.nan,
) -> Breakaway:
    """Raise the torque until the joint slides, cut it in the same cycle, and wait until the joint stands.

    The torque grows by a constant share in each cycle. With the first counts it is held: a gear that winds up
    comes to rest and the torque goes on; a joint that slides goes on by itself.

    Parameters
    ----------
    axis : Axis
        At rest, motor on.
    direction : float
        1 or -1.
    cap : float
        Largest torque [N·m].
    options : FirstMotionOptions
    deviation : float
        Deviation of the torque sensor's readings at rest. Default: NaN, no sensor to watch.

    Raises
    ------
    RefusedBenchError
        No motion up to the cap, a sensor that shows one that the encoder does not, or a bound of the axis.
    """
    watch = _watch(axis, deviation)
    start = place = axis.sample.position
    torque, held, swing = 0.0, -1.0, 0.0  # held: since when, if not negative
    few, more = axis.sizes.few, axis.sizes.more
    quiet, since = place, axis.now
    while True:
        sample = axis.read()
        position = sample.position
        if watch.left(sample.reading) and held < 0.0:
            axis.command(0.0)
            raise RefusedBenchError(
                "sensor_moves_alone",
                f"at {torque:.4g} N·m the torque sensor has left its reading at rest ({watch}), but the encoder "
                "stands: it hangs or is not connected, or the joint is blocked; if the sensor shows the motor's "
                "torque, set watch_sensor = false in [session.first_motion]",
            )
        if held < 0.0 and abs(position - place) > (1.0 - 1e-6) * few:
            # A gear that has been winding up swings on for as far as it goes in the time of a slow oscillation.
            swing = few / max(axis.now - since, axis.period) * _SWING
            held, place, quiet = axis.now, position, position
        elif held >= 0.0:
            if abs(position - place) > (1.0 - 1e-6) * more + swing:
                moved = position - start
                axis.rest()
                yielded = max(0.0, abs(place - start) - few)
                return Breakaway(torque, (moved > 0.0) == (direction > 0.0), yielded)
            if abs(position - quiet) > 1.5 * axis.resolution:
                quiet, held = position, axis.now
            elif axis.now - held > _WIND_UP:
                held, place, since = -1.0, position, axis.now
                watch.begin()
        if held < 0.0:
            torque += axis.period / options.growth_time * (torque + cap / _FLOOR)
            if torque > cap:
                axis.command(0.0)
                raise RefusedBenchError(
                    "no_motion_up_to_torque_cap",
                    f"nothing moved up to {cap:.4g} N·m by the joint file's constants; likely: no torque (phases, "
                    "commutation, current limit), a closed brake, a blocked joint, an encoder that hangs, or a "
                    "torque constant or gear ratio in the joint file that is too large",
                )
        axis.command(direction * torque)


def _watch(axis: Axis, deviation: float) -> SensorWatch:
    """The sensor's mean where the joint stands now, at no torque."""
    readings, end = [], axis.now + _QUIET
    while axis.now < end:
        readings.append(axis.read().reading)
        axis.command(0.0)
    return SensorWatch(sum(readings) / len(readings), deviation)
