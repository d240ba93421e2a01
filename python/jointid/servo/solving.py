"""Parameters of a servo from the products of its table's columns, for many sets of products at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.balance.least_squares import bounded_minima
from jointid.base.values import dataclass
from jointid.servo.layout import BACK_EMF, HELD, LINEAR, LOAD_FRICTION, TORQUE, Layout, balance

Array = NDArray[np.float64]

_PASSES = 4
_SETTLED = 1e-9  # relative change


@dataclass(frozen=True, slots=True, kw_only=True)
class Unknowns:
    """The parameters to identify, and known values."""

    layout: Layout
    # True if some windows are driven and some are not; this separates back-EMF from viscous friction
    separable: bool
    load_friction: bool  # True if friction grows with the gear's torque
    held: bool  # True if the command's course between rows is identified; otherwise it is interpolated linearly
    torque_constant: float | None  # k_t at the output [N·m/A]
    resistance: float | None  # [Ω]
    fixed: Mapping[str, float]  # known values of parameters
    # share of back-EMF in the sum of back-EMF and viscous friction, if the data do not separate the two
    share: float = 0.5

    @property
    def divided(self) -> bool:
        """Whether the data or known values separate back-EMF from viscous friction."""
        linear = self.layout.linear
        fixed = linear in self.fixed or "back_emf" in self.fixed
        return not linear or self.separable or self.motor_known or fixed

    @property
    def motor_known(self) -> bool:
        """Whether torque constant or resistance is known."""
        return self.torque_constant is not None or self.resistance is not None

    @property
    def loaded(self) -> bool:
        """Whether friction of the load is identified or known."""
        return self.load_friction or LOAD_FRICTION.name in self.fixed


def solved(products: Array, unknowns: Unknowns, start: Array) -> Array:
    """Return the parameters that minimise the squared residual, shape (m, size); `products` is (m, columns, columns).

    The signs of the gear's torque are fixed. Columns that are products of parameters are formed with `start`, (m,
    size).
    """
    found = start
    for _ in range(_PASSES if _turns(unknowns) else 1):
        last, found = found, _linear(products, unknowns, found)
        if np.allclose(found, last, rtol=_SETTLED, atol=0.0):
            break
    return found


def fixed_point(
    side_of: Callable[[Array], Array],
    products_of: Callable[[Array | None], Array],
    unknowns: Unknowns,
    start: Array | None = None,
) -> Array:
    """Return the parameters, once the signs of the gear's torque have settled, shape (size,).

    `products_of` gives the products of the columns for a side; for None, the products without the load's friction.
    Without `start`, the iteration begins at the solution without friction of the load.
    """
    if start is None:
        start = _without_load(products_of(None)[None], unknowns)
    found = start[None]
    if not unknowns.loaded:
        return np.asarray(solved(products_of(None)[None], unknowns, found)[0])
    last = None
    for _ in range(_PASSES):
        side = side_of(found[0])
        if last is not None and np.array_equal(side, last):
            break
        last = side
        found = solved(products_of(side)[None], unknowns, found)
    return np.asarray(found[0])


def _without_load(products: Array, unknowns: Unknowns) -> Array:
    """Return the parameters without friction of the load; its column needs the motor's torque."""
    fixed = {name: value for name, value in unknowns.fixed.items() if name != LOAD_FRICTION.name}
    plain = replace(unknowns, load_friction=False, held=False, fixed=fixed)
    return np.asarray(solved(products, plain, np.zeros((1, len(unknowns.layout.names) + 1)))[0])


def weights(values: Array) -> Array:
    """Return the factors of a table's columns in the balance, (columns,); the residual is the weighted sum."""
    columns, target = balance(values[None])
    return np.asarray(columns[0] @ values - target[0])


def _turns(unknowns: Unknowns) -> bool:
    """Return whether a column depends on unknowns."""
    return unknowns.loaded or unknowns.held or unknowns.resistance is not None


def _linear(products: Array, unknowns: Unknowns, last: Array) -> Array:
    """Return one solution of each problem; columns that depend on parameters are formed with the last values."""
    names, found = unknowns.layout.names, np.zeros(last.shape)
    columns, target = balance(last)
    fixed = dict(unknowns.fixed)
    if not unknowns.load_friction:
        fixed.setdefault(LOAD_FRICTION.name, 0.0)
    k_t, resistance = unknowns.torque_constant, unknowns.resistance
    if k_t is not None and resistance is not None:
        fixed |= {"torque_per_voltage": k_t / resistance, "back_emf": k_t * k_t / resistance}
    free = [index for index, name in enumerate(names) if name not in fixed]
    tied = None  # back-EMF over k_t / R
    if resistance is not None and k_t is None:
        tied = last[:, TORQUE] * resistance
    elif k_t is not None and resistance is None:
        tied = np.full(len(last), k_t)
    if tied is not None:
        columns[:, :, TORQUE] += tied[:, None] * columns[:, :, BACK_EMF]
        free.remove(BACK_EMF)
    elif not unknowns.divided:
        free.remove(BACK_EMF)  # one column for both; separated below
    for name, value in fixed.items():
        target -= value * columns[:, :, names.index(name)]
    if unknowns.held:
        free.append(HELD)
    found[:, free] = _chosen(products, columns[:, :, free], target)
    for name, value in fixed.items():
        found[:, names.index(name)] = value
    beyond = found[:, HELD] > 1.0
    if beyond.any():
        free.remove(HELD)
        target[beyond] -= columns[beyond, :, HELD]
        rows = np.flatnonzero(beyond)
        found[rows[:, None], free] = _chosen(
            products[rows], columns[rows][:, :, free], target[rows]
        )
        found[beyond, HELD] = 1.0
    if tied is not None:
        torque = found[:, TORQUE]
        found[:, BACK_EMF] = torque * (tied if resistance is None else torque * resistance)
    elif not unknowns.divided:
        found[:, BACK_EMF] = unknowns.share * found[:, LINEAR]
        found[:, LINEAR] -= found[:, BACK_EMF]
    return found


def _chosen(products: Array, columns: Array, target: Array) -> Array:
    """Return the least-squares solution with some of the columns."""
    turned = columns.transpose(0, 2, 1) @ products
    right = (turned @ target[:, :, None])[:, :, 0]
    return bounded_minima(turned @ columns, -right, 0.0, np.inf)
