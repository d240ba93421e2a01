"""Whether position, velocity, time stamps and sensor tell the same motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.findings import Warned
from jointid.estimate.wording import percent
from jointid.identification.facts import Facts
from jointid.identification.signal_checks import repeated_share
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_DEGREE = np.pi / 180.0
_LAG = 0.4  # sample periods between position and velocity; a backward difference has 0.5
_SENSOR_LAG = 1.0  # sample periods between motion and sensor
_SURE = 8.0  # standard errors
_SURE_OF_SENSOR = 20.0  # ripple of the sensor is not white: be surer
_JITTER = 0.02  # sample periods
_MOTOR_SPEED = 2000.0  # [rad/s]: beyond any geared servo motor
_SWING = 25.0  # [rad] back and forth: four turns


@dataclass(frozen=True, slots=True, kw_only=True)
class _Agreement:
    """position change = scale · integrated velocity + lag · velocity change."""

    scale: float
    lag: float
    lag_error: float


def _blocks(recording: Recording, length: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First and last samples of blocks that no gap crosses."""
    first = np.arange(0, len(recording) - length, length)
    last = first + length
    usual = 1.5 * length * recording.sample_period
    kept = recording.time[last] - recording.time[first] < usual
    return first[kept], last[kept]


def _running_integral(time: Array, signal: Array) -> Array:
    middle = 0.5 * (signal[1:] + signal[:-1])
    return np.concatenate([[0.0], np.cumsum(middle * np.diff(time))])


def _agreement(recording: Recording) -> _Agreement | None:
    first, last = _blocks(recording, 8)
    if first.size < 20:
        return None
    path = _running_integral(recording.time, recording.velocity)
    moved = recording.position[last] - recording.position[first]
    regressors = np.column_stack(
        [path[last] - path[first], recording.velocity[last] - recording.velocity[first]]
    )
    kept = np.ones(first.size, dtype=np.bool_)
    for _ in range(3):  # a spike or a jump must not look like a lag
        found, *_rest = np.linalg.lstsq(regressors[kept], moved[kept], rcond=None)
        miss = moved - regressors @ found
        kept = np.abs(miss) <= 9.0 * float(np.median(np.abs(miss[kept]))) + 1e-300
    rows = regressors[kept]
    if rows.shape[0] < 20 or np.linalg.matrix_rank(rows) < 2:
        return None
    variance = float(miss[kept] @ miss[kept]) / (rows.shape[0] - 2)
    error = float(np.sqrt(variance * np.linalg.inv(rows.T @ rows)[1, 1]))
    return _Agreement(scale=float(found[0]), lag=float(found[1]), lag_error=error)


def velocity_disagrees(facts: Facts) -> Iterator[Warned]:
    """A velocity column that is late, of another unit or of another sign than the position."""
    for recording in facts.recordings:
        found = None if recording.velocity_derived else _agreement(recording)
        if found is None:
            continue
        late = found.lag / recording.sample_period
        if found.scale < 0.0:
            yield Warned(
                code="reversed_sign",
                parameters=(),
                message="the velocity has the opposite sign of the position's change: turn one of the two round",
            )
        elif _near(found.scale, _DEGREE) or _near(found.scale, 1.0 / _DEGREE):
            which = "velocity" if found.scale < 1.0 else "position"
            yield Warned(
                code="implausible_units",
                parameters=(),
                message=(
                    f"position and velocity differ by a factor of 57.3: the {which} seems to be in degrees; "
                    f"load with units={{'{which}': '{'deg/s' if which == 'velocity' else 'deg'}'}}"
                ),
            )
        elif abs(found.scale - 1.0) > 0.03:
            yield Warned(
                code="velocity_mismatch",
                parameters=(),
                message=(
                    f"the position moves by {found.scale:.4g} times the integral of the velocity: check their units, "
                    "or leave the velocity column out (columns={'velocity': None})"
                ),
            )
        elif abs(late) > _LAG and abs(found.lag) > _SURE * found.lag_error:
            side = "lags" if late > 0.0 else "leads"
            yield Warned(
                code="signal_lag",
                parameters=(),
                message=(
                    f"the velocity {side} the position by {1e3 * abs(found.lag):.3g} ms ({abs(late):.1f} sample "
                    "periods), as a filter or a backward difference does, which biases inertia and static friction: "
                    "leave the column out (columns={'velocity': None}); it is then derived centrally"
                ),
            )


def _near(value: float, wanted: float) -> bool:
    return 0.8 < value / wanted < 1.25


def sensor_lags(facts: Facts) -> Iterator[Warned]:
    """A sensor that reads what the link's motion asked for some milliseconds ago."""
    for recording in facts.recordings:
        if recording.sensor is None or recording.kind == "prismatic":
            continue
        velocity = None if recording.velocity_derived else _agreement(recording)
        if velocity is not None and abs(velocity.lag) > _LAG * recording.sample_period:
            continue  # told already: the velocity is what lags
        lag, error = _sensor_lag(recording)
        periods = abs(lag) / recording.sample_period
        if periods > _SENSOR_LAG and abs(lag) > _SURE_OF_SENSOR * error:
            late, early = ("sensor", "motion") if lag > 0.0 else ("motion", "sensor")
            yield Warned(
                code="signal_lag",
                parameters=("sensor_gain",) if "sensor_gain" in facts.parameters else (),
                message=(
                    f"the {late} lags the {early} by about {1e3 * abs(lag):.2g} ms ({periods:.1f} sample periods): "
                    "a filter or a slower bus delays it; take the filter out, or shift the column by that much"
                ),
            )


def _sensor_lag(recording: Recording) -> tuple[float, float]:
    """How late the sensor reads the torque of a free link, which the motion alone tells, and its error [s].

    The link's torque is inertia and gravity, wherever friction is; so also the breaks of a sticking
    joint, the sharpest events there are, can be used.
    """
    sensor = recording.sensor
    first, last = _blocks(recording, 4)
    if sensor is None or first.size < 50 or np.ptp(sensor) == 0.0:
        return 0.0, np.inf
    time = recording.time

    def over_blocks(signal: Array) -> Array:
        total = _running_integral(time, signal)
        return np.asarray(total[last] - total[first])

    duration = time[last] - time[first]
    motion = np.column_stack(
        [
            recording.velocity[last] - recording.velocity[first],
            over_blocks(np.cos(recording.position)),
            over_blocks(np.sin(recording.position)),
            duration,
        ]
    )
    reading = over_blocks(sensor)
    found, *_ = np.linalg.lstsq(motion, reading, rcond=None)
    level = motion @ found / duration
    spread = reading - reading.mean()
    if np.sum((reading - level * duration) ** 2) > 0.5 * float(spread @ spread):
        return 0.0, np.inf  # the link is not free: its motion does not tell its torque
    middle = 0.5 * (time[first] + time[last])
    inner = slice(1, -1)
    rate = (level[2:] - level[:-2]) / (middle[2:] - middle[:-2])
    rows = np.column_stack([motion[inner], -rate * duration[inner]])
    found, *_ = np.linalg.lstsq(rows, reading[inner], rcond=None)
    miss = reading[inner] - rows @ found
    variance = float(miss @ miss) / (rows.shape[0] - rows.shape[1])
    error = float(np.sqrt(variance * np.linalg.pinv(rows.T @ rows)[-1, -1]))
    return float(found[-1]), error


def time_jitter(facts: Facts) -> Iterator[Warned]:
    """Time stamps that are not when the samples were taken."""
    for recording in facts.recordings:
        if repeated_share(recording, "position") > 0.03:
            continue  # copies have no time of their own, and that is told already
        as_stamped, as_uniform = _timing_errors(recording)
        period = recording.sample_period
        if as_stamped < _JITTER * period:
            continue
        advice = (
            "the samples themselves look evenly spaced: give them even time stamps"
            if as_uniform < 0.3 * as_stamped
            else "the samples were not taken when the stamps say: stamp them where they are taken"
        )
        yield Warned(
            code="time_jitter",
            parameters=(),
            message=(
                f"position and time stamps disagree by {1e6 * as_stamped:.3g} µs a sample "
                f"({percent(as_stamped / period)} of the sample period), as stamps of a busy computer do; {advice}"
            ),
        )


def _timing_errors(recording: Recording) -> tuple[float, float]:
    """Scatter of the samples' true times about the stamps, and about an even grid [s]; 0 where it cannot be seen.

    An error of time is an error of position in proportion to speed. Third differences leave nothing
    of a smooth motion; medians keep spikes and breaks out.
    """
    time, position, period = recording.time, recording.position, recording.sample_period
    intervals = np.diff(time)
    steps = np.diff(position)
    reach = 4
    if steps.size < 40:
        return 0.0, 0.0
    slope = (position[2 * reach :] - position[: -2 * reach]) / (
        time[2 * reach :] - time[: -2 * reach]
    )
    inner = slice(reach, reach + slope.size)
    speed = np.abs(slope[1:-1])
    smallest = np.abs(steps[steps != 0.0]).min(initial=np.inf)
    whole = np.abs(intervals[inner] - period) < 2.5 * period
    whole = whole[:-2] & whole[1:-1] & whole[2:]
    peak = float(speed.max(initial=0.0))
    fast, slow = whole & (speed > 0.3 * peak), whole & (speed < 0.1 * peak)
    if np.count_nonzero(fast) < 40:
        return 0.0, 0.0
    errors = []
    for even in (False, True):
        travelled = steps[inner] - (0.0 if even else 1.0) * slope * (intervals[inner] - period)
        rough = np.abs(np.diff(travelled, 2))
        error = 1.4826 * float(np.median(rough[fast] / speed[fast])) / np.sqrt(20.0)
        floor = float(np.median(rough[slow])) if np.count_nonzero(slow) > 40 else 0.0
        seen = error * float(np.median(speed[fast])) > smallest
        grows = float(np.median(rough[fast])) > 3.0 * floor
        errors.append(error if seen and grows else 0.0)
    return errors[0], errors[1]


def too_fast(facts: Facts) -> Iterator[Warned]:
    """A motion that no joint makes: degrees taken for radians, most likely."""
    gear = abs(facts.joint.gear_ratio) if facts.joint is not None else 1.0
    for recording in facts.recordings:
        if recording.kind == "prismatic":
            continue
        peak = float(np.percentile(np.abs(recording.velocity), 99.0))
        swing = float(np.ptp(recording.position))
        travel = abs(float(recording.position[-1] - recording.position[0]))
        if gear > 1.0 and peak * gear > _MOTOR_SPEED:
            told = f"the motor would turn at {peak * gear * 60.0 / (2.0 * np.pi):.0f} rpm"
        elif swing > _SWING and travel < 0.5 * swing:
            told = f"the joint would swing through {swing / (2.0 * np.pi):.0f} turns and back"
        else:
            continue
        yield Warned(
            code="implausible_units",
            parameters=(),
            message=(
                f"{told}: are these degrees? Load with units={{'position': 'deg', 'velocity': 'deg/s'}}, "
                "or correct the gear ratio"
            ),
        )
