"""Friction with a shape parameter, such as static friction that decays with speed. Only these shapes are nonlinear.

All linear parameters are eliminated (variable projection: Golub and Pereyra 1973; derivative after Kaufman 1975).
Each joint's shape starts at the shape on a grid that explains most of the residual of the other terms.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.windows import interval_means
from jointid.identification.search.computed_bounds import shape_bounds
from jointid.robot.balance.balance import Balance
from jointid.robot.balance.products import Products, powers, weighted
from jointid.robot.balance.solving import PriorRows, Solution, above_bounds, scatter_of, solved
from jointid.robot.links.models import shaped_term
from jointid.robot.links.parameters import least_of

Array = NDArray[np.float64]

_GRID = 16  # number of shapes, from the lowest to the highest
_STEPS = 12
_SETTLED = 1e-5  # relative change of the residual, and change of the logarithm of a shape
_LONGEST = 1.0  # largest step of a logarithm
_HALVINGS = 6
_APART = 1e-5  # difference of the logarithm on both sides of a shape, for a slope


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapedTerms:
    """Columns of the terms with a shape parameter, for the joints that have them."""

    balance: Balance
    terms: Mapping[int, _core.Term]  # by joint

    @classmethod
    def of(cls, balance: Balance, models: Sequence[str]) -> Self:
        """Return the terms of joints with these models."""
        found = {joint: shaped_term(model) for joint, model in enumerate(models)}
        return cls(balance=balance, terms={j: term for j, term in found.items() if term})

    @property
    def joints(self) -> tuple[int, ...]:
        """Joints with a shaped term."""
        return tuple(self.terms)

    def column(self, joint: int, shape: float) -> Array:
        """Return the integrals of the basis over a joint's rows."""
        return self._integrals(joint, lambda velocity: self._basis(joint, velocity, shape))

    def slope(self, joint: int, shape: float) -> Array:
        """Return the derivative of the column by the shape's logarithm."""

        def of(velocity: Array) -> Array:
            low, high = (
                self._basis(joint, velocity, shape * float(np.exp(apart)))
                for apart in (-_APART, _APART)
            )
            return (high - low) / (2.0 * _APART)

        return self._integrals(joint, of)

    def _basis(self, joint: int, velocity: Array, shape: float) -> Array:
        return _core.friction_basis(self.terms[joint].key, velocity, [shape])

    def _integrals(self, joint: int, of: Callable[[Array], Array]) -> Array:
        found = []
        for number, summing in enumerate(self.balance.summings):
            velocity = summing.velocity[joint]
            whole = summing(joint, interval_means(of(velocity), velocity) * summing.step)
            found.append(whole[self.balance.windows_of(joint, number)])
        return np.concatenate(found)

    def torque(self, values: Mapping[tuple[int | None, str], float]) -> Array:
        """Return the integrals over all rows for given values of the joints' parameters."""
        total = np.zeros(self.balance.rows.torque.size)
        for joint, term in self.terms.items():
            column = self.column(joint, values[joint, term.shapes[0]])
            total[self.balance.places[joint]] += values[joint, term.name] * column
        return total

    def bounds(self, joint: int) -> tuple[float, float]:
        """Return the lowest and highest shape that can be seen at the joint's speeds."""
        peak = max(
            float(np.abs(summing.velocity[joint]).max()) for summing in self.balance.summings
        )
        # A joint that never moves shows no shape.
        return shape_bounds(self.terms[joint].shapes[0], peak or 1.0)

    @property
    def least(self) -> Array:
        """Lower bounds of the coefficients."""
        return np.array([least_of(term) for term in self.terms.values()])

    @property
    def norms(self) -> Array:
        """Divisors of the columns: the lengths of the joints' durations."""
        rows = self.balance.rows
        return np.array(
            [
                float(np.linalg.norm(rows.duration[self.balance.places[joint]])) or 1.0
                for joint in self.joints
            ]
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapedSolution:
    """A solution with shaped terms."""

    # scaled values of the fixed columns, then the scaled coefficient of each joint's shaped term
    solution: Solution
    logs: Array  # logarithms of the shapes
    # True if the shape is at a bound of its range, or its coefficient is held at 0
    at_bound: NDArray[np.bool_]
    sums: Array  # products with the columns of shaped terms, for each stretch and joint


def solved_with_shapes(
    shaped: ShapedTerms,
    products: Products,
    least: Array,
    prior: PriorRows,
    start: Sequence[float] | None = None,
) -> ShapedSolution:
    """Return the best values of linear parameters and shapes.

    `products`, `least` and `prior` are those of the fixed columns. The search begins at `start`, the logarithms of
    the shapes, or on a grid.
    """
    plain = solved(products, least, prior)
    if not shaped.joints:
        nothing = np.zeros(0)
        return ShapedSolution(
            solution=plain, logs=nothing, at_bound=nothing.astype(bool), sums=products.sums
        )
    search = _Search(
        shaped=shaped,
        products=products,
        norms=shaped.norms,
        bounds=np.log([shaped.bounds(joint) for joint in shaped.joints]).reshape(-1, 2),
        least=np.append(least, shaped.least),
        prior_product=prior.padded(len(shaped.joints)).scaled(
            np.concatenate([products.norms[:-1], shaped.norms, products.norms[-1:]])
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
    return ShapedSolution(
        solution=Solution(values=at.values, at_bound=at.held, scatter=scatter),
        logs=logs,
        at_bound=ended,
        sums=search.sums(logs, slopes=False),
    )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _At:
    """The fit at given shapes."""

    misfit: float
    values: Array
    held: NDArray[np.bool_]
    scatter: Array
    slope: Array  # negative derivative of half the squared residual
    curvature: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Search:
    """Gauss-Newton search for the logarithms of the shapes, with all linear parameters eliminated."""

    shaped: ShapedTerms
    products: Products
    norms: Array
    bounds: Array
    least: Array
    prior_product: Array

    def sums(self, logs: Array, *, slopes: bool) -> Array:
        """Return products with the columns of shaped terms; their slopes, if requested, come after all of them."""
        count, first = len(self.shaped.joints), self.products.columns
        added = {}
        for place, joint in enumerate(self.shaped.joints):
            shape = float(np.exp(logs[place]))
            both = [self.shaped.column(joint, shape)]
            if slopes:
                both.append(self.shaped.slope(joint, shape))
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
        """Return for each joint the shape that explains most of the residual of all other terms."""
        whole = self.products.sums.sum(axis=0)
        gram = weighted(whole, plain.scatter)[:-1, :-1]
        inverse = np.linalg.pinv(gram, rcond=1e-12, hermitian=True)
        logs = np.empty(len(self.shaped.joints))
        for place, joint in enumerate(self.shaped.joints):
            grid = np.linspace(self.bounds[place, 0], self.bounds[place, 1], _GRID)
            columns = np.column_stack(
                [self.shaped.column(joint, float(np.exp(each))) for each in grid]
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
        """Return the fit at given shapes, and the change of the residual with them."""
        count, first = len(self.shaped.joints), self.products.columns
        by_joint = self.sums(logs, slopes=True).sum(axis=0)
        linear = np.append(np.arange(first + count), by_joint.shape[-1] - 1)
        slopes = first + count + np.arange(count)
        whole = weighted(by_joint, scatter)
        product = whole[np.ix_(linear, linear)] + self.prior_product
        values, held = above_bounds(product, self.least)
        full = np.append(values, -1.0)
        sizes = values[first:]
        # Products of the residual with the derivatives, and the part of them that the linear parameters cannot follow.
        pushed = -(whole[np.ix_(slopes, linear)] @ full) * sizes
        free = np.flatnonzero(~held)
        across = whole[np.ix_(slopes, free)] * sizes[:, None]
        curvature = whole[np.ix_(slopes, slopes)] * np.outer(sizes, sizes)
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
        """Return the best shapes with these weights."""
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
