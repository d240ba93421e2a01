"""Check whether a recording shows load friction, or another effect that its term absorbs.

Many errors of a model increase the coefficient of load friction: every torque that grows with the load and has the sign
of the velocity. The term is accepted only if its coefficient remains with other causes in the fit: drift, a torque over
the angle, a delay, a wrong inertia, another law of slow motion, pre-sliding, a nonlinear sensor. The balance is linear
at the estimate, so this is one more regression. Its error comes from omitting stretches of the recording in turn.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.estimate.estimate import Estimate
from jointid.identification.follow_up import EstimateSource
from jointid.problem.problem import Problem
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_NAME = "load_friction"
_NEAR_ONE = 0.9
_BLOCKS = 10
_SURE = 4.0  # standard errors
_SMALLEST = 0.01  # below it, noise of the reading has the same effect if the reading gives the load
_KEPT = 0.6  # smallest share of the coefficient that remains with the other causes
_RIDGE = 1e-11
# Prior: each other cause adds about this share of the torque. Without it, many columns that nearly cancel could
# replace load friction with very large coefficients.
_EXPECTED = 0.03
# Decays of friction with the speed and with the travel since a reversal, as shares of peak speed and range.
_SPEEDS = (0.02, 0.1, 0.4)
_WAYS = (0.003, 0.01, 0.03)


def load_refusal(estimate: Estimate) -> str | None:
    """Return why the data do not show load friction, or None if they do, or if the model has none."""
    found = estimate.parameters.get(_NAME)
    if found is None or not found.vary or found.at_bound is not None:
        return None  # a value at a bound is refused by another check
    if found.value > _NEAR_ONE:
        return f"{_NAME} is {found.value:.3g}; a value near 1 fits any torque"
    if found.value < _SMALLEST:
        return f"{_NAME} is {found.value:.2g}, too small to separate from noise"
    source = estimate.follow_up
    if not isinstance(source, EstimateSource):
        return None
    choice = source.problem.choice
    if not choice.sensor and choice.model.resolved.gravity == "none":
        return (
            f"{_NAME} needs a known load in addition to the drive's torque, from a sensor or from gravity; without "
            "this load, a scale of all other terms has the same effect"
        )
    value, error = _beside_other_causes(estimate, source.problem)
    if not value > _SURE * error or not _KEPT < value / found.value < 1.0 / _KEPT:
        return (
            f"{_NAME} is {found.value:.2g}, but {value:.2g} ± {error:.1g} in a fit with other causes (drift, torque "
            "over the angle, delay, slow motion): the motion does not separate load friction from these causes"
        )
    return None


def _beside_other_causes(estimate: Estimate, problem: Problem) -> tuple[float, float]:
    """Return the coefficient with the other causes in the balance, and its error."""
    penalty = problem.penalty(_core.WindowOptions(duration=estimate.settings["windows"]))
    known = estimate.parameters
    theta = np.array([known[name].value for name in penalty.names])
    _, residual, jacobian = penalty.linearised(theta)
    free = [
        place
        for place, name in enumerate(penalty.names)
        if known[name].vary and known[name].at_bound is None
    ]
    matrix = np.column_stack([jacobian[:, free], *_other_causes(problem, penalty), -residual])
    sizes = np.sqrt(np.einsum("ij,ij->j", matrix, matrix))
    matrix = matrix[:, sizes > 0.0] / sizes[sizes > 0.0]
    edges = np.linspace(0, len(matrix), _BLOCKS + 1).astype(int)
    parts = np.array(
        [np.einsum("ki,kj->ij", matrix[a:b], matrix[a:b]) for a, b in itertools.pairwise(edges)]
    )
    whole = parts.sum(axis=0)
    sums = np.concatenate([whole[None], whole - parts])
    ridge = np.full(matrix.shape[1] - 1, _RIDGE)
    level = float(np.linalg.norm(penalty.target))
    if penalty.residual == _core.Residual.sensor:
        level /= abs(known["sensor_gain"].value) or 1.0
    expected = _EXPECTED * level / sizes[-1]
    ridge[len(free) :] += _noise(whole, len(matrix)) / expected**2
    square = sums[:, :-1, :-1] + np.diag(ridge)
    place = free.index(penalty.names.index(_NAME))
    solved = np.linalg.solve(square, sums[:, :-1, -1:])[:, place, 0] * sizes[-1] / sizes[place]
    left = solved[1:] - solved[1:].mean()
    error = float(np.sqrt((_BLOCKS - 1) / _BLOCKS * np.einsum("i,i->", left, left)))
    return known[_NAME].value + float(solved[0]), error


def _noise(products: Array, rows: int) -> float:
    """Return the variance of the last column that no other column explains."""
    square, target = products[:-1, :-1], products[:-1, -1]
    found = np.linalg.solve(square + _RIDGE * np.eye(len(target)), target)
    left = products[-1, -1] - 2.0 * found @ target + found @ square @ found
    return float(max(left, 1e-12)) / max(1, rows - len(target))


def _other_causes(problem: Problem, penalty: _core.Penalty) -> list[Array]:
    """Return the window integrals of other possible errors of a model."""
    bounds, run = np.asarray(penalty.windows), np.asarray(penalty.recording_of)
    duration = np.asarray(penalty.usable_duration)
    columns: list[list[Array]] = []
    for number, recording in enumerate(problem.recordings):
        mine = slice(*np.searchsorted(run, (number, number + 1)))
        first, last = bounds[mine, 0], bounds[mine, 1]
        share = duration[mine] / (recording.time[last] - recording.time[first])
        steps = np.diff(recording.time)
        found = []
        for signal in _signals(recording, problem.choice.sensor):
            sums = np.concatenate([[0.0], np.cumsum(0.5 * (signal[1:] + signal[:-1]) * steps)])
            found.append((sums[last] - sums[first]) * share)
        found.append(recording.velocity[last] - recording.velocity[first])
        columns.append(found)
    joined = [np.concatenate(parts) for parts in zip(*columns, strict=True)]
    joined.append(np.asarray(penalty.torque_steps(*problem.masked)))
    return joined


def _signals(recording: Recording, sensor: bool) -> Iterator[Array]:
    """Yield the torques of other causes, without their coefficients."""
    time, angle, velocity = recording.time, recording.position, recording.velocity
    sign = np.sign(velocity)
    late = 2.0 * (time - time[0]) / (time[-1] - time[0]) - 1.0
    peak = max(float(np.abs(velocity).max()), 1e-300)
    spread = max(float(np.ptp(angle)), 1e-300)
    turn = angle if recording.kind == "revolute" else angle * (np.pi / spread)
    yield np.ones(time.size)
    yield np.abs(velocity)
    yield velocity * np.abs(velocity)
    for friction in (sign, velocity, np.ones(time.size)):
        yield late * friction
    for order in (1.0, 2.0, 3.0):
        yield np.cos(order * turn)
        yield np.sin(order * turn)
    for speed in _SPEEDS:
        yield sign * np.exp(-np.abs(velocity) / (speed * peak))
    way = _way_since_reversal(angle, sign)
    for length in _WAYS:
        yield sign * np.exp(-way / (length * spread))
    if sensor and recording.sensor is not None:
        reading = recording.sensor - recording.sensor.mean()
        reading /= max(float(np.abs(reading).max()), 1e-300)
        yield reading**2
        yield reading**3


def _way_since_reversal(angle: Array, sign: Array) -> Array:
    """Return the travel of the joint since the last change of the velocity's sign."""
    turned = np.concatenate([[True], sign[1:] * sign[:-1] <= 0.0])
    last = np.maximum.accumulate(np.where(turned, np.arange(angle.size), 0))
    return np.abs(angle - angle[last])
