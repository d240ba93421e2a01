"""White noise of a recording's extra signals."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jointid import _core
from jointid.recording.recording import Recording
from jointid.recording.signals import FloatArray

_APART = 1_000_003  # from the draws of the velocity's noise


def noise_of_extra(recording: Recording, name: str) -> float:
    """Return the standard deviation of an extra signal's noise, its steps included, in the signal's unit.

    It follows from the signal's steps and differences, which show neither a delay nor a filter.
    """
    after = [gap.index for gap in recording.gaps]
    with np.errstate(all="ignore"):
        found = _core.position_noise(
            recording.time, recording.extra[name], after, recording.sample_period
        )
    return float(found.sigma)


def noise_unit(random: np.random.Generator, count: int, draw: int) -> FloatArray:
    """Return white noise of unit size; an odd draw's is that of the one before with the other sign."""
    # Uniform noise: the generator's bits are the same on every host.
    unit = np.sqrt(3.0) * (2.0 * random.random(count) - 1.0)
    return np.asarray(-unit if draw % 2 else unit)


def extra_measured_again(
    recording: Recording, names: Collection[str], draw: int, number: int
) -> Recording:
    """Return a recording whose extra signals of these names have noise of their own size once more.

    An odd draw's noise is that of the one before with the other sign.
    """
    random = np.random.default_rng((draw // 2, number, _APART))
    extra = dict(recording.extra)
    for name in names:
        unit = noise_unit(random, len(recording), draw)
        extra[name] = extra[name] + noise_of_extra(recording, name) * unit
    return recording.with_signals(extra=extra)
