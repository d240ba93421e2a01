"""Breakaway: the torque from zero, slowly, until the joint moves."""

from __future__ import annotations

from dataclasses import dataclass

from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.proof.axis import Axis
from jointid.hardware.proof.refusal import RefusedBenchError

_WIND_UP = 0.1  # [s] that the torque is held after the first counts: what still moves then slides
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
    axis: Axis, direction: float, cap: float, options: FirstMotionOptions
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

    Raises
    ------
    RefusedBenchError
        No motion up to the cap, or a bound of the axis.
    """
    start = place = axis.sample.position
    torque, held = 0.0, -1.0  # held: since when, if not negative
    few, more = options.counts * axis.resolution, options.more_counts * axis.resolution
    quiet = place
    while True:
        position = axis.read().position
        if held < 0.0 and abs(position - place) > (1.0 - 1e-6) * few:
            held, place, quiet = axis.now, position, position
        elif held >= 0.0:
            if abs(position - place) > (1.0 - 1e-6) * more:
                moved = position - start
                axis.rest()
                return Breakaway(torque, (moved > 0.0) == (direction > 0.0), abs(place - start))
            if abs(position - quiet) > 1.5 * axis.resolution:
                quiet, held = position, axis.now
            elif axis.now - held > _WIND_UP:
                held, place = -1.0, position
        if held < 0.0:
            torque += axis.period / options.growth_time * (torque + cap / _FLOOR)
            if torque > cap:
                axis.command(0.0)
                raise RefusedBenchError(
                    "no_motion_up_to_torque_cap",
                    f"nothing moved up to {cap:.4g} N·m by the joint file's constants: no torque (phases, "
                    "commutation, current limit), a brake that is closed, a blocked joint, an encoder that "
                    "hangs, or a torque constant or gear ratio that are too large in the joint file",
                )
        axis.command(direction * torque)
