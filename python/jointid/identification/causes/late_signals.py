"""What a velocity that is late changes, at the samples of a recording."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.identification.causes.fitted_balance import FittedBalance
from jointid.recording.recording import Recording

Array = NDArray[np.float64]


def rate(run: Recording) -> Array:
    """Return the rate of the position."""
    return np.asarray(np.gradient(run.position, run.time))


def by_velocity(fit: FittedBalance, run: Recording) -> Array:
    """Return the torque of the terms that the velocity enters: inertia and friction, but for what the travel gives."""
    total = fit.value("inertia") * np.gradient(run.velocity, run.time)
    return np.asarray(total + friction_at(fit, run.velocity))


def friction_at(fit: FittedBalance, velocity: Array) -> Array:
    """Return the friction at a velocity, without its viscous part: over a window that is the travel's."""
    total = -fit.value("viscous") * velocity
    for index in fit.friction:
        term = fit.terms[index]
        assert term is not None
        values = np.array([fit.value(shape) for shape in term.shapes])
        total += fit.best[index] * _core.friction_basis(term.key, velocity, values)
    return np.asarray(total)
