"""How well a recording can tell the delay of its sensor's reading at all: the Cramér-Rao bound."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import jointid as jid

Array = NDArray[np.float64]

NORMAL = 1.96  # standard errors of half a 95 % interval
_REFUTED = 3.0  # standard errors: then the other reading is 20 times less likely, with its whole sample to choose from
_STEP = 1e-6  # [s]
_JUMP = 6.0  # medians of the size of the reading's rate


@dataclass(frozen=True, kw_only=True)
class Limit:
    """Least standard errors of a reading's delay, from one recording [s].

    Attributes
    ----------
    smooth : float
        From the motion without its jumps.
    whole : float
        From all of it, for one who knows whether the reading is interpolated between samples.
    apart : float
        From the delay to the next whole sample.
    """

    smooth: float
    whole: float
    apart: float

    @property
    def error(self) -> float:
        """The least standard error: jumps count where they tell an interpolated reading from one of an instant."""
        return self.whole if _REFUTED * self.whole <= self.apart else self.smooth

    def determinable(self, near: float) -> bool:
        """Whether any unbiased estimate has a 95 % interval within that [s], and knows which delay it is."""
        return NORMAL * self.error <= near or NORMAL * self.smooth <= near


def limit(quiet: jid.Recording, noise: float, delay: float) -> Limit:
    """Return the Cramér-Rao bound of the delay of one recording.

    Parameters
    ----------
    quiet : Recording
        What the sensor reads without noise, and not late; no controller feeds it back.
    noise : float
        Standard deviation of a reading [N·m].
    delay : float
        [s]; samples between are interpolated.

    Notes
    -----
    The bound is the noise over the root of the summed squares of the reading's rate, less what a changed inertia,
    gravity or offset of the link would do: the motion is taken as exact, so the truth is not below it. Jumps tell
    most, but a jump that falls on a whole sample says only between which samples the delay is, if the recording does
    not say whether its reading is interpolated: then the smooth part has to tell.
    """
    rate = (late(quiet, "sensor", delay + _STEP) - late(quiet, "sensor", delay - _STEP)) / (
        2.0 * _STEP
    )
    angle = np.interp(quiet.time - delay, quiet.time, quiet.position)
    columns = [late(quiet, "sensor", delay), np.cos(angle), np.sin(angle), np.ones(len(angle))]
    moving = slice(int(np.ceil(delay / quiet.sample_period)) + 2, None)
    known = np.column_stack(columns)[moving]
    informative = rate[moving] - known @ np.linalg.lstsq(known, rate[moving], rcond=None)[0]
    noise = noise / quiet.metadata["log"]["gain"]
    size = np.abs(informative)
    return Limit(
        smooth=noise / float(np.linalg.norm(informative[size < _JUMP * np.median(size)])),
        whole=noise / float(np.linalg.norm(informative)),
        apart=abs(delay - quiet.sample_period * round(delay / quiet.sample_period)),
    )


def late(recording: jid.Recording, signal: str, delay: float) -> Array:
    """A signal that is late; between samples it is interpolated."""
    return np.asarray(np.interp(recording.time - delay, recording.time, getattr(recording, signal)))
