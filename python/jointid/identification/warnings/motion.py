"""Whether position, velocity, time stamps and sensor tell the same motion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from jointid.estimate.statistics import Warned
from jointid.estimate.wording import percent
from jointid.identification.warnings.evidence import Facts
from jointid.identification.warnings.inspection import inspect
from jointid.identification.warnings.units import degrees_advice
from jointid.recording.recording import Recording

_DEGREE = np.pi / 180.0
_MISMATCH = 0.03  # of the position's rate
_LAG = 0.4  # sample periods between position and velocity; a backward difference has 0.5
_SENSOR_LAG = 1.0  # sample periods between motion and sensor
_SURE = 8.0  # standard errors
_SURE_OF_SENSOR = 20.0  # ripple of the sensor is not white: be surer
_JITTER = 0.02  # sample periods
_MOTOR_SPEED = 2000.0  # [rad/s]: beyond any geared servo motor
_SWING = 25.0  # [rad] back and forth: four turns


def velocity_disagrees(facts: Facts) -> Iterator[Warned]:
    """A velocity column that is late, of another unit or of another sign than the position."""
    for inspected in facts.inspections:
        recording, found = inspected.recording, inspected.found.agreement
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
                    f"{degrees_advice(recording, (which,))}"
                ),
            )
        elif abs(found.scale - 1.0) > _MISMATCH:
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
    for inspected in facts.inspections:
        recording, velocity = inspected.recording, inspected.found.agreement
        if velocity is not None and abs(velocity.lag) > _LAG * recording.sample_period:
            continue  # told already: the velocity is what lags
        lag, error = inspected.found.sensor_lag
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
    """How late the sensor reads the torque of a free link, and the error of that [s]."""
    return inspect(recording).found.sensor_lag


def time_jitter(facts: Facts) -> Iterator[Warned]:
    """Time stamps that are not when the samples were taken."""
    for inspected in facts.inspections:
        recording = inspected.recording
        if inspected.stale_share("position") > 0.03:
            continue  # copies have no time of their own, and that is told already
        as_stamped, as_uniform = inspected.found.timing_errors
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
    """Scatter of the samples' true times about the stamps, and about an even grid [s]; 0 where it cannot be seen."""
    return inspect(recording).found.timing_errors


def too_fast(facts: Facts) -> Iterator[Warned]:
    """A motion that no joint makes: degrees taken for radians, most likely."""
    gear = abs(facts.joint.gear_ratio) if facts.joint is not None else 1.0
    for inspected in facts.inspections:
        recording, peak = inspected.recording, inspected.found.peak_speed
        agreement = inspected.found.agreement
        if recording.kind == "prismatic" or (
            agreement is not None and abs(agreement.scale - 1.0) > _MISMATCH
        ):
            continue  # what contradicts itself has no speed, and that is told already
        if gear > 1.0 and peak * gear > _MOTOR_SPEED:  # a single wild sample is no speed
            peak = float(np.percentile(np.abs(recording.velocity), 99.0))
        swing = inspected.found.swing
        travel = abs(float(recording.position[-1] - recording.position[0]))
        if gear > 1.0 and peak * gear > _MOTOR_SPEED:
            told = f"the motor would turn at {peak * gear * 60.0 / (2.0 * np.pi):.0f} rpm"
        elif swing > _SWING and travel < 0.5 * swing:
            told = f"the joint would swing through {swing / (2.0 * np.pi):.0f} turns and back"
        else:
            continue
        signals = ("position",) if recording.velocity_derived else ("position", "velocity")
        yield Warned(
            code="implausible_units",
            parameters=(),
            message=(
                f"{told}: are these degrees? Then {degrees_advice(recording, signals)}; else correct the gear ratio"
            ),
        )
