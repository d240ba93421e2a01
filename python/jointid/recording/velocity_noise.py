"""Noise of a recording's velocity, derived or recorded."""

from __future__ import annotations

import numpy as np

from jointid import _core
from jointid.recording.order_statistics import median
from jointid.recording.recording import Recording


def follows_position(recording: Recording) -> bool:
    """Whether the velocity is the derivative of the position."""
    return recording.velocity_derived and np.array_equal(
        recording.velocity, recording.derived.velocity
    )


def noise_of_velocity(recording: Recording) -> float:
    """Return the standard deviation of the velocity's noise, a median over the samples [rad/s or m/s].

    For a derived velocity it follows from the position's noise. For a recorded velocity it follows from its own
    quantization steps and differences. These do not show a delay or a filter.
    """
    if follows_position(recording):
        return median(recording.derived.noise)
    after = [gap.index for gap in recording.gaps]
    return _core.position_noise(
        recording.time, recording.velocity, after, recording.sample_period
    ).sigma
