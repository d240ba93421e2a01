"""The servo's parameters from the products of its table's columns, without negative ones."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.servo.windows import (
    CHANGE,
    DRIVEN,
    KNOWN,
    LOAD,
    LOAD_DRIVEN,
    LOAD_VOLTAGE,
    SIGN,
    TURNED,
    VOLTAGE,
)

Array = NDArray[np.float64]

NAMES = ("torque_per_voltage", "back_emf", "viscous", "coulomb", "load_friction", "inertia")
"""What is sought, in the order of a solution."""

BACK_EMF_SHARE = 0.8
"""Share of the back-EMF in what brakes in proportion to speed, where no recording divides the two.

A geared motor's viscous friction is the smaller part; the finding says that this is an assumption."""

_PASSES = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class Sought:
    """What is sought, and what is known of it.

    Attributes
    ----------
    separable : bool
        Whether some windows are driven and some are not, which divides back-EMF from viscous friction.
    load_friction : bool
        Whether friction grows with the gear's torque.
    torque_constant : float or None
        k_t at the output [N·m/A], if it is known.
    resistance : float or None
        [Ω], if it is known.
    fixed : mapping of str to float
        Known values of parameters.
    """

    separable: bool
    load_friction: bool
    torque_constant: float | None
    resistance: float | None
    fixed: Mapping[str, float]

    @property
    def divided(self) -> bool:
        """Whether anything divides back-EMF from viscous friction."""
        facts = self.torque_constant is not None or self.resistance is not None
        return self.separable or facts or "viscous" in self.fixed


def solved(products: Array, sought: Sought, start: Array, passes: int = _PASSES) -> Array:
    """Return the parameters that minimise the squared residual, shape (6,).

    Parameters
    ----------
    products : ndarray, shape (COLUMNS, COLUMNS)
        Of the table's columns, with the signs of the gear's torque held.
    sought : Sought
    start : ndarray, shape (6,)
        Of the load's friction's column, which depends on the first two parameters.
    passes : int
        In which that column follows the parameters. Default 4.
    """
    found = np.array(start)
    for _ in range(passes if _turns(sought) else 1):
        found = _linear(products, sought, found)
    return found


def fixed_point(products_of: Callable[[float, float], Array], sought: Sought) -> Array:
    """Return the parameters, once the signs of the gear's torque have settled.

    Parameters
    ----------
    products_of : callable
        Products of the columns for a k_t/R and a k_t²/R.
    sought : Sought
    """
    products = products_of(0.0, 0.0)
    found = np.zeros(len(NAMES))
    # Without friction of the load first: its column needs the motor's torque.
    plain = Sought(
        separable=sought.separable,
        load_friction=False,
        torque_constant=sought.torque_constant,
        resistance=sought.resistance,
        fixed={k: v for k, v in sought.fixed.items() if k != "load_friction"},
    )
    found = solved(products, plain, found)
    if not sought.load_friction and "load_friction" not in sought.fixed:
        return found
    for _ in range(_PASSES):
        products = products_of(found[0], found[1])
        found = solved(products, sought, found)
    return found


def _turns(sought: Sought) -> bool:
    """Whether a column depends on what is sought."""
    return sought.load_friction or "load_friction" in sought.fixed or sought.resistance is not None


def _linear(products: Array, sought: Sought, last: Array) -> Array:
    """One solution, with the columns that depend on the parameters formed with the last ones."""
    size = products.shape[0]
    columns = np.zeros((size, len(NAMES)))
    columns[VOLTAGE, 0] = 1.0
    columns[DRIVEN, 1] = columns[TURNED, 2] = columns[SIGN, 3] = columns[CHANGE, 5] = -1.0
    columns[LOAD, 4], columns[LOAD_VOLTAGE, 4], columns[LOAD_DRIVEN, 4] = -1.0, -last[0], last[1]
    target = np.zeros(size)
    target[KNOWN] = 1.0
    fixed = dict(sought.fixed)
    if not sought.load_friction:
        fixed.setdefault("load_friction", 0.0)
    k_t, resistance = sought.torque_constant, sought.resistance
    if k_t is not None and resistance is not None:
        fixed |= {"torque_per_voltage": k_t / resistance, "back_emf": k_t * k_t / resistance}
    tied = 0.0  # back-EMF per k_t / R
    if k_t is not None and resistance is None:
        tied = k_t
    elif resistance is not None and k_t is None:
        tied = last[0] * resistance
    free = [name for name in NAMES if name not in fixed]
    if (k_t is None) != (resistance is None):
        columns[:, 0] += tied * columns[:, 1]
        free.remove("back_emf")
    elif not sought.divided and "back_emf" in free:
        free.remove("back_emf")  # one column for both; divided below
    for name, value in fixed.items():
        target = target - value * columns[:, NAMES.index(name)]
    chosen = columns[:, [NAMES.index(name) for name in free]]
    values = _not_negative(chosen.T @ products @ chosen, chosen.T @ products @ target)
    found = np.zeros(len(NAMES))
    for name, value in [*zip(free, values, strict=True), *fixed.items()]:
        found[NAMES.index(name)] = value
    if (k_t is None) != (resistance is None):
        found[1] = found[0] * (k_t if k_t is not None else found[0] * (resistance or 0.0))
    elif "back_emf" not in free and "back_emf" not in fixed:
        found[1], found[2] = BACK_EMF_SHARE * found[2], (1.0 - BACK_EMF_SHARE) * found[2]
    return found


def _not_negative(normal: Array, right: Array) -> Array:
    """Return the least squares solution without negative entries, from its normal equations."""
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-300))
    values, vectors = np.linalg.eigh(normal / np.outer(scale, scale))
    root = np.sqrt(np.maximum(values, 1e-14))
    matrix = root[:, None] * vectors.T
    found, _ = _core.non_negative_least_squares(matrix, vectors.T @ (right / scale) / root)
    return np.asarray(found) / scale
