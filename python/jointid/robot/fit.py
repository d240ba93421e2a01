"""All parameters of a robot's fit in one order, with their derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid.identification.inference.covariance import Covariance, parameter_covariance
from jointid.robot.balance import Balance
from jointid.robot.decays import Decays, DecaySolution
from jointid.robot.inertia import InertiaColumns
from jointid.robot.products import Products
from jointid.robot.solving import time_segments

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
    scatter : ndarray, shape (joints,)
        Root mean square of each joint's residuals.
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
    scatter: Array
    columns: InertiaColumns
    inertial: Array

    @classmethod
    def of(
        cls,
        balance: Balance,
        columns: InertiaColumns,
        kept: Sequence[int],
        products: Products,
        decays: Decays,
        found: DecaySolution,
    ) -> Self:
        """Return the fit of a solution.

        Parameters
        ----------
        balance : Balance
        columns : InertiaColumns
        kept : sequence of int
            Columns of the balance that are used, before those of the inertia.
        products : Products
            Of these two.
        decays : Decays
        found : DecaySolution
        """
        labels = [balance.labels[place] for place in kept]
        inertial: list[tuple[int | None, str]] = [
            (joint, "inertia_scale") if columns.scales else (None, name)
            for joint, name in zip(columns.joints, columns.names, strict=True)
        ]
        stribeck, decay = decays.joints, np.exp(found.logs)
        every = [
            *labels,
            *inertial,
            *((joint, "static") for joint in stribeck),
            *((joint, "stribeck") for joint in stribeck),
        ]
        linear = len(every) - len(stribeck)
        positive = [joint is not None and name not in _SIGNED for joint, name in every[:linear]]
        lengths = np.append(products.norms[:-1], decays.norms)
        values = found.solution.values * (products.norms[-1] / lengths)
        first = len(labels) + len(inertial)
        jacobian = np.zeros((balance.rows.joint.size, len(every)))
        jacobian[:, : len(labels)] = balance.matrix[:, kept]
        jacobian[:, len(labels) : first] = columns.columns(balance)
        for number, joint in enumerate(stribeck):
            mine = balance.places[joint]
            value, slope = decays.column(joint, float(decay[number]))
            jacobian[mine, first + number] = value
            static = values[first + number]
            jacobian[mine, linear + number] = static * slope / decay[number]
        wanted = balance.rows.torque - columns.known(balance)
        return cls(
            labels=tuple(every),
            units=("",) * len(labels) + columns.units + ("",) * (2 * len(stribeck)),
            values=np.append(values, decay),
            bounds=(
                *((0.0 if each else -np.inf, np.inf) for each in positive),
                *(decays.bounds(joint) for joint in stribeck),
            ),
            at_bound=np.append(found.solution.at_bound, found.at_bound),
            jacobian=jacobian,
            residual=wanted - jacobian[:, :linear] @ values,
            scatter=found.solution.scatter * products.norms[-1],
            columns=columns,
            inertial=columns.inertial(values[len(labels) : first]),
        )

    def covariance(self, balance: Balance) -> Covariance:
        """Return the covariance of the free parameters, clustered over segments of motion."""
        rows = balance.rows
        weight = 1.0 / self.scatter[rows.joint]
        return parameter_covariance(
            self.jacobian[:, ~self.at_bound] * weight[:, None],
            self.residual * weight,
            None,
            segments=time_segments(rows.start, rows.stop, rows.piece),
        )
