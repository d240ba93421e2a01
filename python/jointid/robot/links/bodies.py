"""Check whether a body can have given inertial parameters."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_NEGATIVE = 1e-9  # of the largest eigenvalue: limit of rounding errors


def possible(inertial: Array) -> bool:
    """Return whether bodies of positive density everywhere can have these inertial parameters, shape (links, 10).

    They can if the matrix of second moments, first moments and mass is positive semidefinite (Wensing, Kim and Slotine
    2018). Then the inertias also satisfy the triangle inequality. The order is mass, first moments, Ixx, Ixy, Iyy, Ixz,
    Iyz, Izz about the frame.
    """
    for each in inertial:
        values = np.linalg.eigvalsh(moments_of(each))
        if values[0] < -_NEGATIVE * max(float(np.abs(values).max()), 1e-12):
            return False
    return True


def moments_of(inertial: Array) -> Array:
    """Return the matrix of second moments, first moments and mass of one link, shape (4, 4), from its 10 parameters."""
    m, x, y, z, xx, xy, yy, xz, yz, zz = inertial
    turning = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    moments = np.empty((4, 4))
    moments[:3, :3] = 0.5 * np.trace(turning) * np.eye(3) - turning
    moments[3, :3] = moments[:3, 3] = x, y, z
    moments[3, 3] = m
    return moments
