"""White noise of a recording's extra signals."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jointid import _core
from jointid.recording.recording import Recording
from jointid.recording.signals import FloatArray

_APART = 1_000_003  # offset of the seeds, to differ from those of the velocity's noise


def noise_of_extra(recording: Recording, name: str) -> float:
    """Return the standard deviation of an extra signal's noise, quantization included, in the signal's unit.

    It follows from the signal's quantization steps and differences. These do not show a delay or a filter.
    """
    after = [gap.index for gap in recording.gaps]
    with np.errstate(all="ignore"):
        found = _core.position_noise(
            recording.time, recording.extra[name], after, recording.sample_period
        )
    return float(found.sigma)


def noise_unit(random: np.random.Generator, count: int, draw: int) -> FloatArray:
    """Return white noise of unit size; an odd draw is the previous draw with opposite sign."""
    # Uniform noise: the generator gives the same bits on every computer.
    unit = np.sqrt(3.0) * (2.0 * random.random(count) - 1.0)
    return np.asarray(-unit if draw % 2 else unit)


def extra_measured_again(
    recording: Recording, names: Collection[str], draw: int, number: int
) -> Recording:
    """Return a recording with additional noise on these extra signals, of the size that each already has.

    An odd draw's noise is the previous draw's noise with opposite sign.
    """
    random = np.random.default_rng((draw // 2, number, _APART))
    extra = dict(recording.extra)
    for name in names:
        unit = noise_unit(random, len(recording), draw)
        extra[name] = extra[name] + noise_of_extra(recording, name) * unit
    return recording.with_signals(extra=extra)
