"""Breakaway: the torque grows slowly from zero until the joint moves."""

from __future__ import annotations

import math
from dataclasses import dataclass

from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.proof.axis import Axis
from jointid.hardware.proof.refusal import RefusedBenchError
from jointid.hardware.proof.sensor_watch import SensorWatch

_QUIET = 0.2  # [s] at zero torque, to average the sensor
_WIND_UP = 0.1  # [s], hold of the torque after the first counts; a joint that moves on slides
_SWING = 0.1  # [s], period of a slow oscillation
_FLOOR = 300.0  # the growth begins as if the torque were the cap divided by this


@dataclass(frozen=True, slots=True)
class Breakaway:
    """Start of a joint's motion.

    Attributes
    ----------
    torque : float
        Magnitude of the breakaway torque [N·m], by the joint file's constants.
    along : bool
        Whether the joint moved in the direction of the torque.
    wind_up : float
        Elastic angle before the joint slides [rad].
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
    """Raise the torque until the joint slides, set it to zero in the same cycle, and wait until the joint is at rest.

    The torque grows by a constant share in each cycle. It is held at the first counts. An elastic gear then comes to
    rest, and the torque grows again. A sliding joint goes on.

    Parameters
    ----------
    axis : Axis
        Axis at rest, motor on.
    direction : float
        1 or -1.
    cap : float
        Largest torque [N·m].
    options : FirstMotionOptions
    deviation : float
        Standard deviation of the torque sensor's readings at rest. Default: NaN, the sensor is not used.

    Raises
    ------
    RefusedBenchError
        No motion up to the cap, a motion that only the sensor shows, or an exceeded bound of the axis.
    """
    watch = _watch(axis, deviation)
    start = place = axis.sample.position
    torque, held, swing = 0.0, -1.0, 0.0  # held: begin of the hold, or negative
    few, more = axis.sizes.few, axis.sizes.more
    quiet, since = place, axis.now
    while True:
        sample = axis.read()
        position = sample.position
        if watch.left(sample.reading) and held < 0.0:
            axis.command(0.0)
            raise RefusedBenchError(
                "sensor_moves_alone",
                f"at {torque:.4g} N·m the torque sensor's reading has changed ({watch}), but the encoder does not "
                "count: the encoder hangs or is not connected, or the joint is blocked; if the sensor shows the "
                "motor's torque, set watch_sensor = false in [session.first_motion]",
            )
        if held < 0.0 and abs(position - place) > (1.0 - 1e-6) * few:
            # An elastic gear may swing on, by its speed times the period of a slow oscillation.
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
                    f"the joint did not move at torques up to {cap:.4g} N·m by the joint file's constants; likely: "
                    "no torque (phases, commutation, current limit), a closed brake, a blocked joint, an encoder that "
                    "hangs, or too large a torque constant or gear ratio in the joint file",
                )
        axis.command(direction * torque)


def _watch(axis: Axis, deviation: float) -> SensorWatch:
    """Return the watch of the sensor, with its mean at the present position and zero torque."""
    readings, end = [], axis.now + _QUIET
    while axis.now < end:
        readings.append(axis.read().reading)
        axis.command(0.0)
    return SensorWatch(sum(readings) / len(readings), deviation)
