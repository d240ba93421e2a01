"""Friction that grows with the load, as integrals over windows, for a load from motion or sensor.

Without a sensor, the share of the inertia behind the gear is unknown, so several shares are tried. The fitted gravity
contains part of this friction, and with an offset it may be undetermined. Therefore the load comes from a fit with this
friction in the model, and each part of gravity is also tried alone.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from jointid.identification.causes.fitted_balance import FittedBalance

Array = NDArray[np.float64]

_ROUNDS = 4  # iterations of load and fit
_SHARES = (0.0, 0.05, 0.1, 0.2, 0.4, 1.0)  # shares of the inertia behind the gear
_GRAVITY = (
    ("gravity_cos", "gravity_sin"),
    ("gravity_cos", "gravity_sin", "torque_offset"),
    ("gravity_sin",),
    ("gravity_cos",),
)


def load_friction_of_sensor(fit: FittedBalance) -> Array | None:
    """Return the absolute sensed load times the direction of motion; None without gain and offset of the sensor."""
    names = ("sensor_gain", "sensor_offset")
    return _of_load(fit, names, 0.0) if set(names) <= set(fit.names) else None


def load_frictions_of_motion(fit: FittedBalance) -> Iterator[Array]:
    """Yield the same for each possible load from gravity, with the share of the inertia that fits best."""
    shares = _SHARES if "inertia" in fit.names else (0.0,)
    parts = [names for names in _GRAVITY if set(names) <= set(fit.names)]
    for names in parts:
        tried = [_of_load(fit, names, share) for share in shares]
        yield min(tried, key=lambda column: _misfit(fit, column))
    if "inertia" in fit.names and not parts:
        yield _of_load(fit, (), 1.0)


def _of_load(fit: FittedBalance, names: tuple[str, ...], share: float) -> Array:
    """Return the absolute load times the direction of motion; the load is fitted with this friction in the model."""
    turned = fit.integral_of_each(lambda _, run: np.sign(run.velocity)) / fit.duration
    places = [fit.names.index(name) for name in names]
    free = [(k, fit.free.index(place)) for k, place in enumerate(places) if place in fit.free]
    values = fit.best[places]
    still = np.zeros(len(turned))
    if share > 0.0:
        inertia = fit.names.index("inertia")
        still = share * fit.best[inertia] * fit.columns[:, inertia]
    column = np.abs(fit.columns[:, places] @ values + still) * turned
    for _ in range(_ROUNDS if free else 0):
        steps = fit.solve(np.column_stack([fit.jacobian, column]), fit.residual)
        for k, at in free:
            values[k] = fit.best[places[k]] + steps[at]
        column = np.abs(fit.columns[:, places] @ values + still) * turned
    return np.asarray(column)


def _misfit(fit: FittedBalance, column: Array) -> float:
    both = np.column_stack([fit.jacobian, column])
    steps = fit.solve(both, fit.residual)
    steps[: len(fit.start)] -= fit.start
    return float(np.sum((fit.residual + both @ steps) ** 2))
