"""Static friction above Coulomb friction, and how fast it decays with speed: the only nonlinear parameters.

All linear parameters are eliminated (variable projection: Golub and Pereyra 1973; its derivative as by Kaufman 1975).
Each joint's decay starts where a grid of decays explains most of what the other terms leave.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.identification.search.computed_bounds import shape_bounds
from jointid.robot.balance import Balance
from jointid.robot.solving import Known, Solution, bounded, scatter_of, solved

Array = NDArray[np.float64]

_GRID = 16  # decays, from the fastest to the slowest
_STEPS = 12
_SETTLED = 1e-5  # of the misfit, and of the logarithm of a decay
_LONGEST = 1.0  # step of a logarithm
_HALVINGS = 6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Decays:
    """Columns of the static friction of some joints.

    Attributes
    ----------
    balance : Balance
    joints : tuple of int
    """

    balance: Balance
    joints: tuple[int, ...]

    def column(self, joint: int, decay: float) -> tuple[Array, Array]:
        """Integrals of ``sgn(v) exp(-decay v²)`` in a joint's rows, and their derivative by the decay."""
        rows = self.balance.rows
        value, slope = np.zeros((2, rows.joint.size))
        for number, summing in enumerate(self.balance.summings):
            mine = np.flatnonzero((rows.joint == joint) & (rows.recording == number))
            speed = summing.motion.velocity[joint]
            squared = speed * speed
            excess = np.sign(speed) * np.exp(-decay * squared)
            value[mine] = self._sums(joint, number, excess)[rows.window[mine]]
            slope[mine] = self._sums(joint, number, -squared * excess)[rows.window[mine]]
        return value, slope

    def _sums(self, joint: int, number: int, signal: Array) -> Array:
        """Sums over the windows; within a reversal by the share of time on each side, as `direction_integrals`."""
        summing = self.balance.summings[number]
        speed = np.abs(summing.motion.velocity[joint])
        before, after = signal[:-1], signal[1:]
        total = speed[:-1] + speed[1:]
        share = speed[:-1] / np.where(total > 0.0, total, 1.0)
        reversed_ = before * after < 0.0
        mean = np.where(reversed_, share * before + (1.0 - share) * after, 0.5 * (before + after))
        return summing(joint, mean * summing.step)

    def bounds(self, joint: int) -> tuple[float, float]:
        """Slowest and fastest decay that the joint's speeds show."""
        peak = max(
            float(np.abs(summing.motion.velocity[joint]).max()) for summing in self.balance.summings
        )
        return shape_bounds("stribeck", peak)

    def columns(self, decays: Array) -> tuple[Array, Array]:
        """The columns of all its joints, and their derivatives."""
        found = [self.column(*each) for each in zip(self.joints, decays.tolist(), strict=True)]
        empty = np.zeros((self.balance.rows.joint.size, 0))
        if not found:
            return empty, empty
        return np.column_stack([a for a, _ in found]), np.column_stack([b for _, b in found])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DecaySolution:
    """A solution with decays.

    Attributes
    ----------
    solution : Solution
        Its values: the fixed columns', then the static friction of each joint.
    decays : ndarray
    at_bound : ndarray of bool
        Decays at a bound of their range, or of no static friction.
    columns : ndarray, shape (rows, decays)
        Of the static friction.
    jacobian : ndarray, shape (rows, decays)
        Derivatives of the model by the decays.
    """

    solution: Solution
    decays: Array
    at_bound: NDArray[np.bool_]
    columns: Array
    jacobian: Array


def solved_with_decays(
    decays: Decays,
    matrix: Array,
    wanted: Array,
    least: Array,
    known: Known,
    start: Sequence[float] | None = None,
) -> DecaySolution:
    """Return the best values of linear parameters and decays.

    Parameters
    ----------
    decays : Decays
    matrix : ndarray, shape (rows, parameters)
        Fixed columns.
    wanted : ndarray, shape (rows,)
    least : ndarray, shape (parameters,)
    known : Known
        Of the fixed columns' parameters beforehand.
    start : sequence of float, optional
        Decays to begin with. Default: from a grid.
    """
    rows, joints = decays.balance.rows, decays.balance.standing.size
    least = np.append(least, np.zeros(len(decays.joints)))
    bounds = np.log([decays.bounds(joint) for joint in decays.joints]).reshape(-1, 2)
    plain = solved(matrix, wanted, rows.joint, joints, least[: matrix.shape[1]], known)
    if not decays.joints:
        nothing = np.zeros(0)
        return DecaySolution(
            solution=plain,
            decays=nothing,
            at_bound=nothing.astype(bool),
            columns=np.zeros((wanted.size, 0)),
            jacobian=np.zeros((wanted.size, 0)),
        )
    logs = (
        _from_grid(decays, bounds, matrix, plain)
        if start is None
        else np.clip(np.log(np.asarray(start)), bounds[:, 0], bounds[:, 1])
    )
    scatter, known = plain.scatter, known.padded(len(decays.joints))
    for _ in range(3):
        weight = 1.0 / scatter[rows.joint]
        logs = _searched(decays, logs, bounds, matrix, wanted, least, known, weight)
        value, slope = decays.columns(np.exp(logs))
        found = np.hstack([matrix, value])
        values, held = bounded(found * weight[:, None], wanted * weight, least, known)
        residual = wanted - found @ values
        before, scatter = scatter, scatter_of(residual, rows.joint, joints)
        if np.all(np.abs(scatter - before) <= 0.01 * before):
            break
    static = values[matrix.shape[1] :]
    ended = (logs <= bounds[:, 0]) | (logs >= bounds[:, 1]) | held[matrix.shape[1] :]
    return DecaySolution(
        solution=Solution(values=values, at_bound=held, residual=residual, scatter=scatter),
        decays=np.exp(logs),
        at_bound=ended,
        columns=value,
        jacobian=slope * static,
    )


def _from_grid(decays: Decays, bounds: Array, matrix: Array, plain: Solution) -> Array:
    """The decay of each joint that explains most of the residual of everything else."""
    rows = decays.balance.rows
    weight = 1.0 / plain.scatter[rows.joint]
    basis = np.linalg.qr(_scaled(matrix * weight[:, None]))[0]
    residual = plain.residual * weight
    logs = np.empty(len(decays.joints))
    for place, joint in enumerate(decays.joints):
        grid = np.linspace(bounds[place, 0], bounds[place, 1], _GRID)
        gains = []
        for each in grid:
            column = decays.column(joint, float(np.exp(each)))[0] * weight
            column -= basis @ (basis.T @ column)
            product, power = float(column @ residual), float(column @ column)
            gains.append(product * abs(product) / power if power > 0.0 else 0.0)
        logs[place] = grid[int(np.argmax(gains))]
    return logs


def _searched(
    decays: Decays,
    logs: Array,
    bounds: Array,
    matrix: Array,
    wanted: Array,
    least: Array,
    known: Known,
    weight: Array,
) -> Array:
    """Gauss-Newton on the logarithms of the decays, all linear parameters eliminated."""
    fixed, target = matrix * weight[:, None], wanted * weight

    def at(place: Array) -> tuple[float, Array, Array]:
        value, slope = decays.columns(np.exp(place))
        full = np.hstack([fixed, value * weight[:, None]])
        values, held = bounded(full, target, least, known)
        residual = target - full @ values
        static = values[matrix.shape[1] :]
        jacobian = slope * (static * np.exp(place)) * weight[:, None]
        basis = np.linalg.qr(_scaled(full[:, ~held]))[0]
        jacobian -= basis @ (basis.T @ jacobian)
        return float(residual @ residual) + known.misfit(values), residual, jacobian

    misfit, residual, jacobian = at(logs)
    for _ in range(_STEPS):
        outward = ((logs <= bounds[:, 0]) & (jacobian.T @ residual < 0.0)) | (
            (logs >= bounds[:, 1]) & (jacobian.T @ residual > 0.0)
        )
        power = np.einsum("ij,ij->j", jacobian, jacobian)
        free = ~outward & (power > 1e-12 * max(float(power.max(initial=0.0)), 1e-300))
        if not free.any():
            break
        step = np.zeros_like(logs)
        step[free] = np.linalg.lstsq(jacobian[:, free], residual, rcond=1e-6)[0]
        step = np.clip(step, -_LONGEST, _LONGEST)
        for _ in range(_HALVINGS):
            trial = np.clip(logs + step, bounds[:, 0], bounds[:, 1])
            found = at(trial)
            if found[0] < misfit:
                break
            step *= 0.5
        else:
            break
        moved, gained = float(np.abs(trial - logs).max()), misfit - found[0]
        logs, (misfit, residual, jacobian) = trial, found
        if moved < _SETTLED or gained < _SETTLED * misfit:
            break
    return logs


def _scaled(matrix: Array) -> Array:
    norms = np.linalg.norm(matrix, axis=0)
    return np.asarray(matrix[:, norms > 0.0] / norms[norms > 0.0])
