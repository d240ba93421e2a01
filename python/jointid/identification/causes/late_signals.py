"""Torque that depends on the velocity at the samples of a recording, for the effect of a late velocity."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.identification.causes.fitted_balance import FittedBalance
from jointid.recording.recording import Recording

Array = NDArray[np.float64]


def rate(run: Recording) -> Array:
    """Return the derivative of the position [rad/s or m/s]."""
    return np.asarray(np.gradient(run.position, run.time))


def by_velocity(fit: FittedBalance, run: Recording) -> Array:
    """Return the torque of the terms that depend on the velocity: inertia, and friction without its viscous part."""
    total = fit.value("inertia") * np.gradient(run.velocity, run.time)
    return np.asarray(total + friction_at(fit, run.velocity))


def friction_at(fit: FittedBalance, velocity: Array) -> Array:
    """Return the friction at a velocity without its viscous part, because the travel gives the integral of that."""
    total = -fit.value("viscous") * velocity
    for index in fit.friction:
        term = fit.terms[index]
        assert term is not None
        values = np.array([fit.value(shape) for shape in term.shapes])
        total += fit.best[index] * _core.friction_basis(term.key, velocity, values)
    return np.asarray(total)
