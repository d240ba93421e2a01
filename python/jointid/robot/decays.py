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
from jointid.robot.products import Products, powers, weighted
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
        """Integrals of ``sgn(v) exp(-decay v²)`` over a joint's rows, and their derivative by the decay's logarithm."""
        found = []
        for number, summing in enumerate(self.balance.summings):
            mine = self.balance.windows_of(joint, number)
            speed = summing.velocity[joint]
            exponent = decay * speed * speed
            excess = np.sign(speed) * np.exp(-exponent)
            parts = [
                summing(joint, _between(each, speed) * summing.step)[mine]
                for each in (excess, -exponent * excess)
            ]
            found.append(np.array(parts))
        value, slope = np.concatenate(found, axis=1)
        return value, slope

    def bounds(self, joint: int) -> tuple[float, float]:
        """Slowest and fastest decay that the joint's speeds show."""
        peak = max(
            float(np.abs(summing.velocity[joint]).max()) for summing in self.balance.summings
        )
        return shape_bounds("stribeck", peak or 1.0)  # a joint that never moves shows none

    @property
    def norms(self) -> Array:
        """Lengths by which the columns are divided: those of the joints' durations."""
        rows = self.balance.rows
        return np.array(
            [
                float(np.linalg.norm(rows.duration[self.balance.places[joint]])) or 1.0
                for joint in self.joints
            ]
        )


def _between(signal: Array, velocity: Array) -> Array:
    """Means over the intervals; within a reversal by the share of time on each side, as `direction_integrals`."""
    speed = np.abs(velocity)
    before, after = signal[:-1], signal[1:]
    total = speed[:-1] + speed[1:]
    share = speed[:-1] / np.where(total > 0.0, total, 1.0)
    turned = before * after < 0.0
    return np.where(turned, share * before + (1.0 - share) * after, 0.5 * (before + after))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DecaySolution:
    """A solution with decays.

    Attributes
    ----------
    solution : Solution
        Its values: the fixed columns', then the static friction of each joint, as scaled.
    logs : ndarray
        Logarithms of the decays.
    at_bound : ndarray of bool
        Decays at a bound of their range, or of no static friction.
    sums : ndarray
        Products with the columns of static friction, by stretch and joint.
    """

    solution: Solution
    logs: Array
    at_bound: NDArray[np.bool_]
    sums: Array


def solved_with_decays(
    decays: Decays,
    products: Products,
    least: Array,
    known: Known,
    start: Sequence[float] | None = None,
) -> DecaySolution:
    """Return the best values of linear parameters and decays.

    Parameters
    ----------
    decays : Decays
    products : Products
        Of the fixed columns.
    least : ndarray, shape (parameters,)
    known : Known
        Of the fixed columns' parameters beforehand.
    start : sequence of float, optional
        Logarithms of the decays to begin with. Default: from a grid.
    """
    plain = solved(products, least, known)
    if not decays.joints:
        nothing = np.zeros(0)
        return DecaySolution(
            solution=plain, logs=nothing, at_bound=nothing.astype(bool), sums=products.sums
        )
    search = _Search(
        decays=decays,
        products=products,
        norms=decays.norms,
        bounds=np.log([decays.bounds(joint) for joint in decays.joints]).reshape(-1, 2),
        least=np.append(least, np.zeros(len(decays.joints))),
        known=known.padded(len(decays.joints)).scaled(
            np.concatenate([products.norms[:-1], decays.norms, products.norms[-1:]])
        ),
    )
    low, high = search.bounds.T
    logs = search.from_grid(plain) if start is None else np.clip(np.asarray(start), low, high)
    scatter = plain.scatter
    for _ in range(3):
        logs, at = search.searched(logs, scatter)
        before, scatter = scatter, at.scatter
        if np.all(np.abs(scatter - before) <= 0.01 * before):
            break
    ended = (logs <= low) | (logs >= high) | at.held[products.columns :]
    return DecaySolution(
        solution=Solution(values=at.values, at_bound=at.held, scatter=scatter),
        logs=logs,
        at_bound=ended,
        sums=search.sums(logs, slopes=False),
    )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _At:
    """The fit at some decays."""

    misfit: float
    values: Array
    held: NDArray[np.bool_]
    scatter: Array
    slope: Array  # of the misfit's half, negative
    curvature: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Search:
    """Gauss-Newton on the logarithms of the decays, all linear parameters eliminated."""

    decays: Decays
    products: Products
    norms: Array
    bounds: Array
    least: Array
    known: Array

    def sums(self, logs: Array, *, slopes: bool) -> Array:
        """Products with the columns of static friction; their slopes, if asked for, stand behind all of them."""
        count, first = len(self.decays.joints), self.products.columns
        added = {}
        for place, joint in enumerate(self.decays.joints):
            value, slope = self.decays.column(joint, float(np.exp(logs[place])))
            both = (value, slope) if slopes else (value,)
            added[joint] = np.column_stack(both) / self.norms[place]
        found = self.products.with_columns(added)
        if not slopes:
            return found
        order = np.concatenate(
            [
                np.arange(first),
                first + 2 * np.arange(count),
                first + 2 * np.arange(count) + 1,
                [first + 2 * count],
            ]
        )
        return found[:, :, order[:, None], order]

    def from_grid(self, plain: Solution) -> Array:
        """The decay of each joint that explains most of the residual of everything else."""
        whole = self.products.sums.sum(axis=0)
        gram = weighted(whole, plain.scatter)[:-1, :-1]
        inverse = np.linalg.pinv(gram, rcond=1e-12, hermitian=True)
        logs = np.empty(len(self.decays.joints))
        for place, joint in enumerate(self.decays.joints):
            grid = np.linspace(self.bounds[place, 0], self.bounds[place, 1], _GRID)
            columns = np.column_stack(
                [self.decays.column(joint, float(np.exp(each)))[0] for each in grid]
            )
            block, size = self.products.blocks[joint], plain.scatter[joint] ** 2
            across = block[:, :-1].T @ columns / size
            pushed = block[:, -1] @ columns / size - plain.values @ across
            power = np.einsum("ij,ij->j", columns, columns) / size
            power = power - np.einsum("ij,ij->j", across, inverse @ across)
            gains = np.where(power > 0.0, pushed * np.abs(pushed) / np.maximum(power, 1e-300), 0.0)
            logs[place] = grid[int(np.argmax(gains))]
        return logs

    def at(self, logs: Array, scatter: Array) -> _At:
        """The fit at some decays, and how the misfit changes with them."""
        count, first = len(self.decays.joints), self.products.columns
        by_joint = self.sums(logs, slopes=True).sum(axis=0)
        linear = np.append(np.arange(first + count), by_joint.shape[-1] - 1)
        slopes = first + count + np.arange(count)
        whole = weighted(by_joint, scatter)
        product = whole[np.ix_(linear, linear)] + self.known
        values, held = bounded(product, self.least)
        full = np.append(values, -1.0)
        static = values[first:]
        # The residual's products with the derivatives, and what of these the linear parameters cannot follow.
        pushed = -(whole[np.ix_(slopes, linear)] @ full) * static
        free = np.flatnonzero(~held)
        across = whole[np.ix_(slopes, free)] * static[:, None]
        curvature = whole[np.ix_(slopes, slopes)] * np.outer(static, static)
        inverse = np.linalg.pinv(product[np.ix_(free, free)], rcond=1e-12, hermitian=True)
        return _At(
            misfit=float(full @ product @ full),
            values=values,
            held=held,
            scatter=scatter_of(
                powers(by_joint[:, linear[:, None], linear], values), self.products.counts
            ),
            slope=pushed,
            curvature=curvature - across @ inverse @ across.T,
        )

    def searched(self, logs: Array, scatter: Array) -> tuple[Array, _At]:
        """The best decays with these weights."""
        low, high = self.bounds.T
        now = self.at(logs, scatter)
        for _ in range(_STEPS):
            outward = ((logs <= low) & (now.slope < 0.0)) | ((logs >= high) & (now.slope > 0.0))
            power = np.diag(now.curvature)
            free = ~outward & (power > 1e-12 * max(float(power.max(initial=0.0)), 1e-300))
            if not free.any():
                break
            step = np.zeros_like(logs)
            part = now.curvature[np.ix_(free, free)]
            step[free] = np.linalg.lstsq(part, now.slope[free], rcond=1e-10)[0]
            step = np.clip(step, -_LONGEST, _LONGEST)
            for _ in range(_HALVINGS):
                trial = np.clip(logs + step, low, high)
                found = self.at(trial, scatter)
                if found.misfit < now.misfit:
                    break
                step *= 0.5
            else:
                break
            moved, gained = float(np.abs(trial - logs).max()), now.misfit - found.misfit
            logs, now = trial, found
            if moved < _SETTLED or gained < _SETTLED * now.misfit:
                break
        return logs, now
