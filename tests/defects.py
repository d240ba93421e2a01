"""Copies of a good recording, each with one defect of the kind that real logs have."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

import jointid as jid

Array = NDArray[np.float64]
LATE = 3e-3  # [s]


def changed(recording: jid.Recording, **signals: Any) -> jid.Recording:
    """The recording with some signals replaced."""
    kept = {name: getattr(recording, name) for name in recording.signals}
    kept |= {"torque_hold": recording.torque_hold, "name": recording.name}
    return jid.Recording(**(kept | signals))


def rows(recording: jid.Recording, index: NDArray[np.intp]) -> dict[str, Array]:
    """Every signal but time at these samples."""
    return {name: getattr(recording, name)[index] for name in recording.signals if name != "time"}


def _late(recording: jid.Recording, signal: Array) -> Array:
    return np.interp(recording.time - LATE, recording.time, signal)


def late_velocity(r: jid.Recording) -> jid.Recording:
    return changed(r, velocity=_late(r, r.velocity))


def late_sensor(r: jid.Recording) -> jid.Recording:
    assert r.sensor is not None
    return changed(r, sensor=_late(r, r.sensor))


def saturated_torque(r: jid.Recording) -> jid.Recording:
    assert r.torque is not None
    limit = float(np.quantile(np.abs(r.torque), 0.9))
    return changed(r, torque=np.clip(r.torque, -limit, limit))


def stuck(r: jid.Recording) -> jid.Recording:
    """40 % of the samples at a standstill put in at a stop, the torque held."""
    middle = int(np.argmin(np.abs(r.velocity[4000:8000]))) + 4000
    more = int(len(r) * 0.4 / 0.6)
    index = np.concatenate(
        [np.arange(middle), np.full(more, middle), np.arange(middle, len(r))]
    ).astype(np.intp)
    signals = rows(r, index)
    signals["velocity"][middle : middle + more] = 0.0
    rng = np.random.default_rng(1)
    signals["sensor"][middle : middle + more] += rng.normal(0.0, 0.08, more)
    return changed(r, time=np.arange(len(index)) * r.sample_period, **signals)


def reversed_torque(r: jid.Recording) -> jid.Recording:
    assert r.torque is not None
    return changed(r, torque=-r.torque)


def degrees(r: jid.Recording) -> jid.Recording:
    return changed(r, position=np.degrees(r.position), velocity=np.degrees(r.velocity))


def jittered_samples(r: jid.Recording) -> jid.Recording:
    """Taken at jittered times (standard deviation 0.2 ms), stamped evenly."""
    rng = np.random.default_rng(2)
    true = r.time + np.clip(rng.normal(0.0, 0.2 * r.sample_period, len(r)), -4e-4, 4e-4)
    moved = {
        name: np.interp(true, r.time, getattr(r, name))
        for name in ("position", "velocity", "sensor")
    }
    return changed(r, **moved)


def jittered_stamps(r: jid.Recording) -> jid.Recording:
    """Taken evenly, stamped late and early (standard deviation 0.2 ms)."""
    rng = np.random.default_rng(3)
    error = np.clip(rng.normal(0.0, 0.2 * r.sample_period, len(r)), -4e-4, 4e-4)
    return changed(r, time=r.time + error)


def clipped_sensor(r: jid.Recording) -> jid.Recording:
    assert r.sensor is not None
    low, high = np.quantile(r.sensor, (0.04, 0.96))
    return changed(r, sensor=np.clip(r.sensor, low, high))


def repeated_samples(r: jid.Recording) -> jid.Recording:
    """Every fifth sample is a copy of the one before."""
    index = np.arange(len(r), dtype=np.intp)
    index[4::5] -= 1
    return changed(r, **rows(r, index))


def repeated_sensor(r: jid.Recording) -> jid.Recording:
    """Every fifth reading is a copy of the one before."""
    assert r.sensor is not None
    index = np.arange(len(r), dtype=np.intp)
    index[4::5] -= 1
    return changed(r, sensor=r.sensor[index])


def wrapped_angle(r: jid.Recording) -> jid.Recording:
    """An angle between 0 and a turn, whose zero lies within the motion."""
    return changed(r, position=np.mod(r.position, 2.0 * np.pi))


def gap(r: jid.Recording) -> jid.Recording:
    index = np.concatenate([np.arange(5000), np.arange(5400, len(r))]).astype(np.intp)
    return changed(r, time=r.time[index], **rows(r, index))


def spike(r: jid.Recording) -> jid.Recording:
    assert r.sensor is not None
    sensor = r.sensor.copy()
    sensor[7000] += 60.0
    return changed(r, sensor=sensor)


def wrong_gear_ratio(r: jid.Recording) -> jid.Recording:
    """Torque computed with a gear of 121 instead of 101."""
    assert r.torque is not None
    return changed(r, torque=r.torque * 121.0 / 101.0)


def constant_sensor(r: jid.Recording) -> jid.Recording:
    return changed(r, sensor=np.full(len(r), 1.5))


# The defect, and the code that must name it.
DEFECTS: Mapping[str, tuple[Callable[[jid.Recording], jid.Recording], str]] = {
    "velocity 3 ms late": (late_velocity, "delay_removed"),
    "sensor 3 ms late": (late_sensor, "delay_removed"),
    "torque saturated in 10 %": (saturated_torque, "torque_saturated"),
    "stuck for 40 %": (stuck, "standing"),
    "torque reversed": (reversed_torque, "reversed_sign"),
    "degrees for radians": (degrees, "implausible_units"),
    "samples jittered, stamps even": (jittered_samples, "time_jitter"),
    "stamps jittered, samples even": (jittered_stamps, "time_jitter"),
    "sensor clipped": (clipped_sensor, "sensor_clipped"),
    "samples repeated": (repeated_samples, "held_rows"),
    "sensor repeated": (repeated_sensor, "repeated_samples"),
    "angle wrapped": (wrapped_angle, "unwrapped"),
    "gap": (gap, "gaps"),
    "spike": (spike, "spikes"),
    "wrong gear ratio": (wrong_gear_ratio, "wrong_scale"),
    "constant sensor": (constant_sensor, "constant_signal"),
}
