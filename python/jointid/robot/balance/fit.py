"""All parameters of a robot's fit in one order, with their derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid.balance.covariance import Covariance, parameter_covariance
from jointid.balance.segments import time_segments
from jointid.robot.balance.balance import Balance
from jointid.robot.balance.inertia import InertiaColumns
from jointid.robot.balance.products import Products
from jointid.robot.balance.shaped_terms import ShapedSolution, ShapedTerms

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Fit:
    """Values of all parameters."""

    models: tuple[str, ...]  # one for each joint
    # joint and name; for a base parameter None and the combination
    labels: tuple[tuple[int | None, str], ...]
    units: tuple[str, ...]  # of base parameters
    values: Array
    bounds: tuple[tuple[float, float], ...]
    at_bound: NDArray[np.bool_]
    jacobian: Array  # (rows, parameters)
    residual: Array  # (rows,)
    scatter: Array  # (joints,), root mean square of each joint's residuals
    columns: InertiaColumns
    inertial: Array  # (10 n,), inertial parameters of all links

    @classmethod
    def of(
        cls,
        balance: Balance,
        columns: InertiaColumns,
        models: Sequence[str],
        products: Products,
        shaped: ShapedTerms,
        found: ShapedSolution,
    ) -> Self:
        """Return the fit of a solution; `products` are of the balance's and the inertia's columns for these models."""
        kept = balance.columns_of(models, columns.dropped)
        labels = [balance.labels[place] for place in kept]
        inertial: list[tuple[int | None, str]] = [
            (joint, "inertia_scale") if columns.scales else (None, name)
            for joint, name in zip(columns.joints, columns.names, strict=True)
        ]
        terms, shapes = shaped.terms.items(), np.exp(found.logs)
        every = [
            *labels,
            *inertial,
            *((joint, term.name) for joint, term in terms),
            *((joint, term.shapes[0]) for joint, term in terms),
        ]
        linear = len(every) - len(shapes)
        lengths = np.append(products.norms[:-1], shaped.norms)
        values = found.solution.values * (products.norms[-1] / lengths)
        first = len(labels) + len(inertial)
        least = (*balance.least[kept], *np.full(len(inertial), -np.inf), *shaped.least)
        jacobian = np.zeros((balance.rows.joint.size, len(every)))
        jacobian[:, : len(labels)] = balance.matrix[:, kept]
        jacobian[:, len(labels) : first] = columns.columns(balance)
        for number, joint in enumerate(shaped.joints):
            mine, shape = balance.places[joint], float(shapes[number])
            jacobian[mine, first + number] = shaped.column(joint, shape)
            by_shape = values[first + number] * shaped.slope(joint, shape) / shape
            jacobian[mine, linear + number] = by_shape
        target = balance.rows.torque - columns.known(balance)
        return cls(
            models=tuple(models),
            labels=tuple(every),
            units=("",) * len(labels) + columns.units + ("",) * (2 * len(shapes)),
            values=np.append(values, shapes),
            bounds=(
                *((float(low), np.inf) for low in least),
                *(shaped.bounds(joint) for joint in shaped.joints),
            ),
            at_bound=np.append(found.solution.at_bound, found.at_bound),
            jacobian=jacobian,
            residual=target - jacobian[:, :linear] @ values,
            scatter=found.solution.scatter * products.norms[-1],
            columns=columns,
            inertial=columns.inertial(values[len(labels) : first]),
        )

    def covariance(self, balance: Balance) -> Covariance:
        """Return the covariance of the free parameters, clustered over segments of motion.

        An unknown delay of commands counts as one more parameter.
        """
        rows = balance.rows
        weight = 1.0 / self.scatter[rows.joint]
        columns = self.jacobian[:, ~self.at_bound]
        late = balance.by_delay.any()
        if late:
            columns = np.column_stack([columns, balance.by_delay])
        found = parameter_covariance(
            columns * weight[:, None],
            self.residual * weight,
            None,
            segments=time_segments(rows.start, rows.stop, rows.piece),
        )
        return found.without_last() if late else found
