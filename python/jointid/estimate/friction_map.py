"""The estimated friction map with its confidence band."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.estimate.intervals import squared_half_widths
from jointid.estimate.record import EstimateRecord
from jointid.estimate.statistics import FrictionCurve

Array = NDArray[np.float64]

_STEP = 1e-6  # relative step for the derivative by a shape parameter


def shared_value(values: Mapping[str, float], name: str) -> float:
    """Return a parameter's value; the mean over recordings if each recording has its own."""
    if name in values:
        return values[name]
    return float(np.mean([value for key, value in values.items() if key.startswith(f"{name}[")]))


def friction_torque(
    terms: Sequence[str], values: Mapping[str, float], velocity: Array, load: float = 0.0
) -> Array:
    """Return the friction at each velocity [N·m or N] while the drive transmits the torque `load`."""
    total = np.zeros_like(velocity)
    for key in terms:
        term = _core.term(key)
        if term.friction:
            shapes = np.array([shared_value(values, shape) for shape in term.shapes])
            basis = _core.friction_basis(key, velocity, shapes, load)
            total += shared_value(values, term.name) * basis
    return total


def friction_curve(estimate: EstimateRecord, velocity: Array, load: float = 0.0) -> FrictionCurve:
    """Return the friction at each velocity, and its pointwise 95 % band by linear propagation of the intervals."""
    values = {name: parameter.value for name, parameter in estimate.parameters.items()}
    terms = estimate.settings["terms"]
    torque = friction_torque(terms, values, velocity, load)
    sensitivity = np.zeros((len(velocity), len(estimate.free)))
    for column, name in enumerate(estimate.free):
        step = _STEP * max(abs(values[name]), 1e-3)
        above = friction_torque(terms, {**values, name: values[name] + step}, velocity, load)
        below = friction_torque(terms, {**values, name: values[name] - step}, velocity, load)
        sensitivity[:, column] = (above - below) / (2.0 * step)
    # Avoid the product of an infinite variance and a sensitivity of exactly zero.
    matrix = squared_half_widths(estimate)
    finite = np.where(np.isfinite(matrix), matrix, 0.0)
    errors = [estimate.parameters[name].stderr for name in estimate.free]
    unknown = np.array([error is None or not np.isfinite(error) for error in errors], dtype=bool)
    square = np.einsum("ij,jk,ik->i", sensitivity, finite, sensitivity)
    square[np.any(np.abs(sensitivity[:, unknown]) > 0.0, axis=1)] = np.inf
    half = np.sqrt(np.maximum(square, 0.0))
    return FrictionCurve(velocity=velocity, torque=torque, lower=torque - half, upper=torque + half)
