"""Replace velocities at samples with large noise by values from neighbours with small noise.

Noisy positions are smoothed over as many samples as the motion allows. By chance, some samples have far fewer, and up
to a hundred times the usual noise. Noise at the ends of windows biases every identified inertia towards zero. The
missing inertia then looks like an early torque.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_NOISY = 3e-4  # of the velocity: smaller noise causes no such error, and smoothing would do more harm than good
_LOUD = 2.0  # times the median of the noise
_REACH = 25  # samples on both sides
_ALIKE = 3.0  # standard deviations of the sample's own noise
_SINGULAR = 1e-9  # of the weights: below it, all neighbours have large noise


def quiet_velocity(velocity: Array, noise: Array) -> Array:
    """Return a velocity with its loud samples replaced by quiet neighbours, unless these contradict them.

    A velocity with little noise is returned unchanged. `noise` is the standard deviation at each sample. A parabola is
    fitted to the samples on both sides, weighted by their noise. At a reversal or a breakaway it differs from the
    sample by more than the noise. Then the sample stays.
    """
    usual = float(np.median(noise))
    loud = np.flatnonzero(noise > _LOUD * usual)
    size = float(np.sqrt(np.mean(velocity * velocity)))
    if not loud.size or usual <= _NOISY * size or velocity.size <= 2 * _REACH:
        return velocity
    weight = (usual / np.maximum(noise, usual)) ** 2
    place = np.arange(-_REACH, _REACH + 1) / _REACH

    def summed(values: Array, power: int) -> Array:
        return np.asarray(np.convolve(values, (place**power)[::-1], "same")[loud])

    moments = np.array([summed(weight, power) for power in range(5)])
    wanted = np.array([summed(weight * velocity, power) for power in range(3)])
    normal = np.array([moments[row : row + 3] for row in range(3)]).transpose(2, 0, 1)
    normal += _SINGULAR * moments[0][:, None, None] * np.eye(3)
    fitted = np.linalg.solve(normal, wanted.T[:, :, None])[:, 0, 0]
    alike = np.abs(fitted - velocity[loud]) <= _ALIKE * noise[loud]
    found = np.array(velocity)
    found[loud[alike]] = fitted[alike]
    return found
