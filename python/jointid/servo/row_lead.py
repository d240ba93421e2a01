"""Rows with values that were read one after the other: find the age of the position relative to the duty."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.joint.joint import Joint
from jointid.servo.signals import ServoSignals

_FARTHEST, _STEP = 0.012, 1e-3  # [s]
_UNSATURATED = 0.98  # of the saturation: largest duty that is used
_EVERY = 4  # samples: neighbours carry the same information


def lead_of(runs: Sequence[ServoSignals], joint: Joint) -> float | None:
    """Return the lead [s] with which the position loop fits the logged duty best; None if it is not determined.

    A positive lead means that the position is older than the duty.
    """
    drive = joint.voltage
    loop = None if drive is None else drive.position_loop
    usable = [run for run in runs if run.logged and run.closed and run.driven.any()]
    if loop is None or not usable:
        return None
    leads = np.arange(-_FARTHEST, _FARTHEST + 0.5 * _STEP, _STEP)
    misfit = np.zeros(len(leads))
    for run in usable:
        inner = np.abs(run.duty) < _UNSATURATED * loop.saturation
        inner &= run.driven > 0.5
        if not inner.any() or run.reference is None:
            continue
        wanted = run.duty[inner] / run.gain
        wanted = wanted[::_EVERY]
        at, reference = run.time[inner][::_EVERY], run.reference[inner][::_EVERY]
        for k, lead in enumerate(leads):
            position = np.interp(at + lead - loop.delay, run.time, run.position)
            # The duty's own unit would give nearly all weight to the stiffest runs.
            misfit[k] += float(np.mean(np.abs(reference - position - wanted)))
    best = int(np.argmin(misfit))
    if not 0 < best < len(leads) - 1:
        return None
    return float(leads[best] + _STEP * _vertex(misfit[best - 1 : best + 2]))


def _vertex(three: NDArray[np.float64]) -> float:
    """Return the minimum of a valley with straight sides, in steps from the middle."""
    left, middle, right = three
    rise = max(left, right) - middle
    return 0.0 if rise <= 0.0 else float(0.5 * (left - right) / rise)
