"""White noise of a recording's extra signals."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jointid import _core
from jointid.recording.recording import Recording

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


def extra_measured_again(
    recording: Recording, names: Collection[str], draw: int, number: int
) -> Recording:
    """Return a recording whose extra signals of these names have noise of their own size once more."""
    random = np.random.default_rng((draw, number, _APART))
    extra = dict(recording.extra)
    for name in names:
        # Uniform noise: the generator's bits are the same on every host.
        unit = np.sqrt(3.0) * (2.0 * random.random(len(recording)) - 1.0)
        extra[name] = extra[name] + noise_of_extra(recording, name) * unit
    return recording.with_signals(extra=extra)
