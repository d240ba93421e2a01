"""Sampling instant of a sensor with a low sampling rate, from its single samples.

Sums over windows show a torque step only at their two ends. At each sample, the reading is the sum of four parts: the
link's inertia times the acceleration around the sample, gravity, an offset, and a share of the torque step at that
sample. A controller with sensor feedback puts the noise of the reading into this step and the following acceleration.
Both are therefore predicted from earlier samples, which are independent of that noise (instrumental variables).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.problem.problem import Problem

Array = NDArray[np.float64]

_COARSE = 1.5e-3  # [s] shortest sample period; below it, half a step hardly changes the gain
_BEFORE = 3  # number of earlier steps and accelerations that predict the next ones
_SLOW = 0.02  # share of the peak speed; slower motion may stick within a sample
_FEWEST = 200  # samples
_SAME = 1e-10  # weakest used direction of the instruments, relative to the strongest
_REFUTED = 4.0  # standard deviations of the Sargan test from its mean


def by_samples(problem: Problem, half: float) -> tuple[float, float] | None:
    """Return the share of half a step that the reading lacks, and its standard error.

    Parameters
    ----------
    problem : Problem
        Problem. Only recordings with a held torque, a recorded velocity and a low sampling rate are used.
    half : float
        Change of the reading by half a step of 1 N·m; it contains the link's inertia.

    Returns
    -------
    tuple of float, or None
        None if there are too few samples or the Sargan test (1958) rejects the equation. The test rejects it if earlier
        samples explain more of the reading than acceleration and step allow.
    """
    rows = list(_rows(problem))
    count = sum(map(len, rows))
    if count < _FEWEST:
        return None
    table = np.concatenate(rows)
    triangle = np.asarray(_core.triangle(np.asfortranarray(table)))
    size = np.linalg.norm(triangle, axis=0)
    if not np.all(size > 0.0):
        return None
    triangle = triangle / size
    instruments = triangle[:, [*range(_KNOWN), *range(_KNOWN + 2, triangle.shape[1] - 1)]]
    regressors, reading = triangle[:, : _KNOWN + 2], triangle[:, -1]
    # Motion in one direction makes some instruments equal, so directions that contain only rounding are removed.
    left, strength, _ = np.linalg.svd(instruments, full_matrices=False)
    basis = left[:, strength > _SAME * strength[0]]
    more = basis.shape[1] - regressors.shape[1]
    if more < 1:
        return None
    projected = basis.T @ regressors
    found = np.linalg.lstsq(projected, basis.T @ reading, rcond=1e-10)[0]
    missed = reading - regressors @ found
    variance = float(missed @ missed) / count
    told = float(np.sum((basis.T @ missed) ** 2))
    if variance == 0.0 or told / variance > more + _REFUTED * np.sqrt(2.0 * more):
        return None
    spread = np.linalg.pinv(projected.T @ projected)[-1, -1]
    scale = float(size[-1] / size[_KNOWN + 1]) / half
    return -float(found[-1]) * scale, float(np.sqrt(variance * spread)) * abs(scale)


_KNOWN = 3  # columns without noise of the reading: offset and gravity


def _rows(problem: Problem) -> Iterator[Array]:
    """Yield one row per sample: known columns, acceleration and step, their instruments, and the reading."""
    for number, recording in enumerate(problem.recordings):
        coarse = recording.sample_period > _COARSE and not recording.velocity_derived
        if not coarse or problem.hold(number) != "zoh":
            continue
        velocity, time = recording.velocity, recording.time
        usable = problem.usable(number)
        at = np.arange(_BEFORE + 1, len(time) - 1)
        kept = np.abs(velocity[at]) > _SLOW * problem.peak_speed
        for near in range(-_BEFORE - 1, 1):
            kept &= usable[at + near] > 0
        for near in range(-_BEFORE - 1, 2):
            kept &= velocity[at + near] * velocity[at] > 0.0
        at = at[kept]
        if not at.size:
            continue
        faster = np.diff(velocity) / np.diff(time)
        step = np.diff(problem.output_torque(number), prepend=0.0)
        angle = recording.position[at]
        yield np.column_stack(
            [
                *(np.ones(at.size), np.cos(angle), np.sin(angle)),
                *(0.5 * (faster[at - 1] + faster[at]), step[at]),
                *(faster[at - 1 - near] for near in range(_BEFORE + 1)),
                *(step[at - 1 - near] for near in range(_BEFORE)),
                *(velocity[at], np.sign(velocity[at])),
                np.asarray(recording.sensor)[at],
            ]
        )
