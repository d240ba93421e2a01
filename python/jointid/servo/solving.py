"""The servo's parameters from the products of its table's columns: many sets of products at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.servo.pivoting import not_negative
from jointid.servo.windows import (
    CHANGE,
    COLUMNS,
    DRIVEN,
    KNOWN,
    LATE,
    LOAD,
    LOAD_DRIVEN,
    LOAD_LATE,
    LOAD_VOLTAGE,
    SIGN,
    TURNED,
    VOLTAGE,
)

Array = NDArray[np.float64]

NAMES = ("torque_per_voltage", "back_emf", "viscous", "coulomb", "load_friction", "inertia")
"""What is sought, in the order of a solution."""

HELD = len(NAMES)
"""Behind them: how far the command is held from row to row, from 0 (it moves evenly) to 1."""

SIZE = HELD + 1

_PASSES = 4
_SETTLED = 1e-9  # relative change


@dataclass(frozen=True, slots=True, kw_only=True)
class Sought:
    """What is sought, and what is known of it.

    Attributes
    ----------
    separable : bool
        Whether some windows are driven and some are not, which divides back-EMF from viscous friction.
    load_friction : bool
        Whether friction grows with the gear's torque.
    held : bool
        Whether it is sought how the command moves between rows; else it moves evenly.
    torque_constant : float or None
        k_t at the output [N·m/A], if it is known.
    resistance : float or None
        [Ω], if it is known.
    fixed : mapping of str to float
        Known values of parameters.
    share : float
        Of the back-EMF in what brakes in proportion to speed, where nothing divides the two. Default: a half.
    """

    separable: bool
    load_friction: bool
    held: bool
    torque_constant: float | None
    resistance: float | None
    fixed: Mapping[str, float]
    share: float = 0.5

    @property
    def divided(self) -> bool:
        """Whether anything divides back-EMF from viscous friction."""
        facts = self.torque_constant is not None or self.resistance is not None
        return self.separable or facts or "viscous" in self.fixed or "back_emf" in self.fixed


def solved(products: Array, sought: Sought, start: Array) -> Array:
    """Return the parameters that minimise the squared residual, shape (m, SIZE).

    Parameters
    ----------
    products : ndarray, shape (m, COLUMNS, COLUMNS)
        Of m tables' columns, with the signs of the gear's torque held.
    sought : Sought
    start : ndarray, shape (m, SIZE)
        Some columns are products of parameters: these are formed with the last solution.
    """
    found = start
    for _ in range(_PASSES if _turns(sought) else 1):
        last, found = found, _linear(products, sought, found)
        if np.allclose(found, last, rtol=_SETTLED, atol=0.0):
            break
    return found


def fixed_point(
    side_of: Callable[[Array], Array],
    products_of: Callable[[Array | None], Array],
    sought: Sought,
    start: Array | None = None,
) -> Array:
    """Return the parameters, once the signs of the gear's torque have settled, shape (SIZE,).

    Parameters
    ----------
    side_of : callable
        The side of the gear's torque, for parameters.
    products_of : callable
        Products of the columns for a side; without columns of the load's friction for None.
    sought : Sought
    start : ndarray, shape (SIZE,), optional
        A solution of nearly the same. Default: the one without friction of the load.
    """
    if start is None:
        start = _without_load(products_of(None)[None], sought)
    found = start[None]
    if not sought.load_friction and "load_friction" not in sought.fixed:
        return np.asarray(solved(products_of(None)[None], sought, found)[0])
    last = None
    for _ in range(_PASSES):
        side = side_of(found[0])
        if last is not None and np.array_equal(side, last):
            break
        last = side
        found = solved(products_of(side)[None], sought, found)
    return np.asarray(found[0])


def _without_load(products: Array, sought: Sought) -> Array:
    """Return the parameters without friction of the load, whose column needs the motor's torque."""
    fixed = {name: value for name, value in sought.fixed.items() if name != "load_friction"}
    plain = replace(sought, load_friction=False, held=False, fixed=fixed)
    return np.asarray(solved(products, plain, np.zeros((1, SIZE)))[0])


def weights(values: Array) -> Array:
    """Return the factors by which a table's columns make up the balance, shape (COLUMNS,): what is left is their sum.

    Parameters
    ----------
    values : ndarray, shape (SIZE,)
    """
    k, b, viscous, coulomb, load, inertia, held = values
    found = np.zeros(COLUMNS)
    found[[VOLTAGE, LATE, DRIVEN, TURNED]] = k, k * held, -b, -viscous
    found[[SIGN, CHANGE, KNOWN]] = -coulomb, -inertia, -1.0
    found[[LOAD, LOAD_VOLTAGE, LOAD_LATE, LOAD_DRIVEN]] = -load * np.array([1.0, k, k * held, -b])
    return found


def _turns(sought: Sought) -> bool:
    """Whether a column depends on what is sought."""
    load = sought.load_friction or "load_friction" in sought.fixed
    return load or sought.held or sought.resistance is not None


def _linear(products: Array, sought: Sought, last: Array) -> Array:
    """One solution of each, with the columns that depend on the parameters formed with the last ones."""
    count = len(products)
    columns = np.zeros((count, COLUMNS, SIZE))
    columns[:, VOLTAGE, 0] = 1.0
    for column, index in ((DRIVEN, 1), (TURNED, 2), (SIGN, 3), (CHANGE, 5), (LOAD, 4)):
        columns[:, column, index] = -1.0
    columns[:, LOAD_VOLTAGE, 4], columns[:, LOAD_DRIVEN, 4] = -last[:, 0], last[:, 1]
    columns[:, LOAD_LATE, 4] = -last[:, 0] * last[:, HELD]
    columns[:, LATE, HELD] = last[:, 0]
    target = np.zeros((count, COLUMNS))
    target[:, KNOWN] = 1.0
    fixed = dict(sought.fixed)
    if not sought.load_friction:
        fixed.setdefault("load_friction", 0.0)
    k_t, resistance = sought.torque_constant, sought.resistance
    if k_t is not None and resistance is not None:
        fixed |= {"torque_per_voltage": k_t / resistance, "back_emf": k_t * k_t / resistance}
    free = [index for index, name in enumerate(NAMES) if name not in fixed]
    tied = None  # back-EMF per k_t / R
    if resistance is not None and k_t is None:
        tied = last[:, 0] * resistance
    elif k_t is not None and resistance is None:
        tied = np.full(count, k_t)
    if tied is not None:
        columns[:, :, 0] += tied[:, None] * columns[:, :, 1]
        free.remove(1)
    elif not sought.divided:
        free.remove(1)  # one column for both; divided below
    for name, value in fixed.items():
        target -= value * columns[:, :, NAMES.index(name)]
    if sought.held:
        free.append(HELD)
    found = np.zeros((count, SIZE))
    found[:, free] = _chosen(products, columns[:, :, free], target)
    for name, value in fixed.items():
        found[:, NAMES.index(name)] = value
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
        found[:, 1] = found[:, 0] * (tied if resistance is None else found[:, 0] * resistance)
    elif not sought.divided:
        found[:, 1] = sought.share * found[:, 2]
        found[:, 2] -= found[:, 1]
    return found


def _chosen(products: Array, columns: Array, target: Array) -> Array:
    """Least squares with some of the columns."""
    turned = columns.transpose(0, 2, 1) @ products
    return not_negative(turned @ columns, (turned @ target[:, :, None])[:, :, 0])
