"""All parameters of a robot's fit in one order, with their derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid.robot.decays import DecaySolution
from jointid.robot.inertia import InertiaColumns

Array = NDArray[np.float64]

_SIGNED = ("torque_offset", "inertia_scale")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Fit:
    """Values of all parameters.

    Attributes
    ----------
    labels : tuple of (int or None, str)
        Joint and name; of a base parameter None and the combination.
    units : tuple of str
        Of base parameters.
    values : ndarray
    bounds : tuple of (float, float)
    at_bound : ndarray of bool
    jacobian : ndarray, shape (rows, parameters)
    residual : ndarray, shape (rows,)
    columns : InertiaColumns
    inertial : ndarray, shape (10 n,)
        Inertial parameters of all links.
    """

    labels: tuple[tuple[int | None, str], ...]
    units: tuple[str, ...]
    values: Array
    bounds: tuple[tuple[float, float], ...]
    at_bound: NDArray[np.bool_]
    jacobian: Array
    residual: Array
    columns: InertiaColumns
    inertial: Array

    @classmethod
    def of(
        cls,
        found: DecaySolution,
        labels: Sequence[tuple[int, str]],
        columns: InertiaColumns,
        matrix: Array,
        stribeck: Sequence[int],
        ranges: Sequence[tuple[float, float]],
    ) -> Self:
        """Return the fit of a solution.

        Parameters
        ----------
        found : DecaySolution
        labels : sequence of (int, str)
            Of the first columns of the matrix.
        columns : InertiaColumns
            The others.
        matrix : ndarray
        stribeck : sequence of int
            Joints with static friction.
        ranges : sequence of (float, float)
            Of their decays.
        """
        solution = found.solution
        inertial: list[tuple[int | None, str]] = [
            (joint, "inertia_scale") if columns.scales else (None, name)
            for joint, name in zip(columns.joints, columns.names, strict=True)
        ]
        every = [
            *labels,
            *inertial,
            *((joint, "static") for joint in stribeck),
            *((joint, "stribeck") for joint in stribeck),
        ]
        linear = len(every) - len(stribeck)
        positive = [joint is not None and name not in _SIGNED for joint, name in every[:linear]]
        return cls(
            labels=tuple(every),
            units=("",) * len(labels) + columns.units + ("",) * (2 * len(stribeck)),
            values=np.append(solution.values, found.decays),
            bounds=(
                *((0.0 if each else -np.inf, np.inf) for each in positive),
                *ranges,
            ),
            at_bound=np.append(solution.at_bound, found.at_bound),
            jacobian=np.hstack([matrix, found.columns, found.jacobian]),
            residual=solution.residual,
            columns=columns,
            inertial=columns.inertial(solution.values[len(labels) : len(labels) + len(inertial)]),
        )
