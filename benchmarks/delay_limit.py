"""The Cramér-Rao bound: how accurately a recording can determine the delay of its sensor's reading."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import jointid as jid

Array = NDArray[np.float64]

NORMAL = 1.96  # standard errors in half a 95 % interval
_REFUTED = (
    3.0  # standard errors: then the other reading is 20 times less likely, anywhere in its sample
)
_STEP = 1e-6  # [s]
_JUMP = 6.0  # medians of the size of the reading's rate


@dataclass(frozen=True, kw_only=True)
class Limit:
    """Least standard errors of a reading's delay, from one recording [s].

    Attributes
    ----------
    smooth : float
        Error from the motion without its jumps.
    whole : float
        Error from the whole motion, if it is known whether the reading is interpolated between samples.
    apart : float
        Distance from the delay to the next whole sample.
    """

    smooth: float
    whole: float
    apart: float

    @property
    def error(self) -> float:
        """Return the least standard error: jumps count where they separate an interpolated reading from an instant."""
        return self.whole if _REFUTED * self.whole <= self.apart else self.smooth

    def determinable(self, near: float) -> bool:
        """Return whether an unbiased estimate can have a 95 % interval within that [s], and know which delay it is."""
        return NORMAL * self.error <= near or NORMAL * self.smooth <= near


def limit(quiet: jid.Recording, noise: float, delay: float) -> Limit:
    """Return the Cramér-Rao bound of the delay of one recording.

    Parameters
    ----------
    quiet : Recording
        The sensor's reading without noise and without delay; no controller feeds it back.
    noise : float
        Standard deviation of a reading [N·m].
    delay : float
        Delay [s]; the signal is interpolated between samples.

    Notes
    -----
    The bound is the noise over the root of the summed squares of the reading's rate, without the part that a changed
    inertia, gravity or offset of the link explains. The motion counts as exact, so the true error is not below the
    bound. Jumps give most information. But if a jump falls on a whole sample, and it is unknown whether the reading is
    interpolated, the jump only shows between which samples the delay is. Then the smooth part decides.
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
    """Return a delayed signal, interpolated between samples."""
    return np.asarray(np.interp(recording.time - delay, recording.time, getattr(recording, signal)))
