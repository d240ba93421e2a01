"""Systematic errors from the choice of windows, the sensor's sampling instant, and the motion between samples."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.covariance import Triangle
from jointid.base.errors import InputError
from jointid.identification.inference.added_noise import Shifts
from jointid.identification.search.domain import SearchDomain
from jointid.problem.constant_torque import with_fixed_offset
from jointid.problem.problem import Problem
from jointid.problem.windows import Windows
from jointid.recording.recording import Recording

Array = NDArray[np.float64]


# Share of noise in the variance of the velocity's change over a window. Over half a window it is four times as large.
_SHARE = 2.5e-4


def other_windows(
    problem: Problem, penalty: _core.Penalty, domain: SearchDomain, windows: Windows, best: Array
) -> Shifts:
    """Return the changes of the minimum with halved and doubled windows; None if such windows are impossible."""
    lower, upper = with_fixed_offset(domain.names, domain.lower, domain.upper, best)
    if penalty.cumulative or not penalty.is_linear:  # their rows are not sums of shorter windows
        return _refitted(problem, penalty, windows, lower, upper, best)
    halved, doubled = _core.window_shifts(
        penalty,
        lower=lower,
        upper=upper,
        best=best,
        **problem.in_arguments,
    )
    return (
        None if halved is None else halved - best,
        None if doubled is None else doubled - best,
    )


def _refitted(
    problem: Problem,
    penalty: _core.Penalty,
    windows: Windows,
    lower: Array,
    upper: Array,
    best: Array,
) -> Shifts:
    """Return the same changes from newly cut windows."""
    options = problem.window_options(windows)
    changes: list[Array | None] = []
    for factor in (0.5, 2.0):
        try:
            other = problem.parts(options.replace(factor=options.factor * factor))
        except InputError:  # fewer windows than parameters, or longer than the recording
            changes.append(None)
            continue
        if other.window_count == penalty.window_count:
            changes.append(None)
            continue
        found = other.refit(lower, upper, best, threads=problem.threads)
        changes.append(found - best)
    return changes[0], changes[1]


def admissible_shifts(
    penalty: _core.Penalty, shifts: tuple[Array | None, Array | None]
) -> tuple[Array | None, Array | None]:
    """Return the shifts to other windows, without the shift to windows that are too short for the noise.

    Windows are chosen so that noise has at most a thousandth of the variance of the velocity's change over a window.
    In shorter windows, the effects of noise and of the smoothing of a derived velocity grow with this share.
    """
    halved, doubled = shifts
    return (None if doubled is not None and penalty.noise_share > _SHARE else halved), doubled


def lacking_torques(problem: Problem, penalty: _core.Penalty, best: Array) -> dict[str, Array]:
    """Return the torque that the residuals may lack in each window, by the name of the cause.

    Returns
    -------
    mapping of str to ndarray, shape (windows,)
        Integrals of torque; causes that do not apply are missing.
    """
    lacking = {
        "sampling": _of_sampling(problem, penalty, best),
        "curvature": _of_curvature(problem, penalty, best),
    }
    return {name: torque for name, torque in lacking.items() if torque is not None}


def systematic_errors(
    free: list[int],
    count: int,
    triangle: Triangle,
    lacking: Collection[str],
    shifts: tuple[Array | None, Array | None],
    instant: float = 1.0,
) -> dict[str, Array]:
    """Return the errors that do not decrease with the recording's length, by the name of their cause.

    Parameters
    ----------
    free : list of int
        Indices of the free parameters.
    count : int
        Number of all parameters.
    triangle : Triangle
        Triangle of the residuals' derivatives by the free parameters, then by the missing terms.
    lacking : collection of str
        Causes of the missing terms, in the order of the triangle.
    shifts : tuple of ndarray or None
        Admissible changes of each parameter when the windows are halved and doubled.
    instant : float
        Share of half a step that the reading may lack, because the sampling instant is uncertain. Default 1.

    Returns
    -------
    mapping of str to ndarray, shape (p,)
        Errors in the parameters' units; causes that do not apply are missing.
    """
    parts: dict[str, Array] = {}
    moved = [shift[free] for shift in shifts if shift is not None]
    if moved:
        parts["windows"] = np.sqrt(sum(shift * shift for shift in moved) / len(moved))
    own = list(range(len(free)))
    for place, name in enumerate(lacking if free else ()):
        moves = np.abs(triangle.solve(own, len(free) + place, rcond=1e-10)[0])
        parts[name] = instant * moves if name == "sampling" else moves
    return {name: _everywhere(sizes, free, count) for name, sizes in parts.items()}


def _everywhere(sizes: Array, free: list[int], count: int) -> Array:
    """Return an array for all parameters, with 0 for those that are not free."""
    result = np.zeros(count)
    result[free] = sizes
    return result


def _of_sampling(problem: Problem, penalty: _core.Penalty, best: Array) -> Array | None:
    """Return the torque that is missing if the sensor is sampled before or after a command's step.

    A held torque steps at the samples. The step accelerates drive and link together, and the link's share is a step
    in the sensor reading. A reading before the step instead of in its middle lacks half of that share at
    every sample. Smooth signals are not affected.
    """
    names = list(penalty.names)
    if not {"sensor_gain", "inertia"} <= set(names):
        return None
    holds = [held(problem, recording) for recording in problem.recordings]
    if not any(holds) or penalty.window_count < 50:
        return None
    periods = [
        recording.sample_period if holds[number] else 0.0
        for number, recording in enumerate(problem.recordings)
    ]
    slow = 1.0  # affects only a column that is not used here
    motion = penalty.link_motion(*problem.masked, periods, slow)
    link, stepped = motion[:, [0, 1, 2, 3, 9]], motion[:, 4]
    for number in range(len(holds)):
        if not holds[number]:  # this recording does not show the link's share of a step
            of = np.asarray(penalty.recording_of) == number
            link[of, 0] = link[of, 2] = 0.0
            link[of, 1] = link[of, 3]
    if not np.any(stepped):
        return None
    gain = float(best[names.index("sensor_gain")])
    # `share` is the link's inertia over the gain.
    triangle = Triangle(np.asfortranarray(link), problem.threads)
    share = float(triangle.solve([0, 1, 2, 3], 4, rcond=1e-10)[0][0])
    both = float(best[names.index("inertia")]) + share * gain
    if both <= 0.0 or share * gain <= 0.0:
        return None
    lacking = 0.5 * share / both * stepped
    if penalty.residual != _core.Residual.sensor:
        lacking = lacking * gain
    return np.asarray(lacking)


def _of_curvature(problem: Problem, penalty: _core.Penalty, best: Array) -> Array | None:
    """Return the torque that is missing because the trapezoidal rule treats friction as linear between samples."""
    names = list(penalty.names)
    if not any(term.shapes for term in penalty.terms):
        return None
    if penalty.cumulative:
        return None
    lacking = np.asarray(penalty.bending(*problem.masked, best))
    if penalty.residual == _core.Residual.sensor:
        lacking = lacking / float(best[names.index("sensor_gain")])
    return lacking


def held(problem: Problem, recording: Recording) -> bool:
    """Return whether the torque is held between samples."""
    hold = problem.settings.torque_hold or recording.torque_hold
    if hold is None and problem.joint is not None:
        hold = problem.joint.torque_hold
    return hold == "zoh"
