"""What a cycle's instants say: numbers in a session, arrays in the replay of its frame log."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
import numpy.typing as npt

Value = TypeVar("Value", float, npt.NDArray[np.float64])


def held_torque(before: Value, told: Value, acted: Value, period: float) -> Value:
    """The mean over a cycle of the torque that the drive holds [N·m].

    Parameters
    ----------
    before, told : float or ndarray
        The last cycle's command and this one's [N·m].
    acted : float or ndarray
        From the sample until the drive acts on the command [s]; until then, the last one holds.
    period : float
        [s]
    """
    if isinstance(acted, float):
        share = min(1.0, acted / period)
        return share * before + (1.0 - share) * told
    shares = np.minimum(1.0, acted / period)
    return shares * before + (1.0 - shares) * told


def target_at(reference: Value, velocity: Value, acceleration: Value, shift: Value) -> Value:
    """The reference of the instant at which a sample was taken, `shift` [s] after it was due."""
    return reference + shift * (velocity + 0.5 * shift * acceleration)
