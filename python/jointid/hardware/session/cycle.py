"""Torque and reference of a control cycle, for numbers (session) and arrays (replay of its frame log)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

Value = TypeVar("Value", float, npt.NDArray[np.float64])


@dataclass(frozen=True, slots=True, kw_only=True)
class LoggedCycle:
    """One control cycle of a frame log: a sample, then a command.

    Attributes
    ----------
    taken, acted : float
        Times of the sample and of the command [s], from the time stamps of the log.
    position : float
        Position at the output [rad].
    torque : float
        Torque that the drive accepted, at the output [N·m].
    reading : float
        Reading of the torque sensor; 0 without a sensor.
    current : float
        Active motor current [A]; NaN if not known.
    lost : str
        Sentence that states why the cycle has a command but no sample. Default: empty; the cycle has a sample.
    """

    taken: float
    acted: float
    position: float
    torque: float
    reading: float = 0.0
    current: float = float("nan")
    lost: str = ""


def held_torque(before: Value, accepted: Value, acted: Value, period: float) -> Value:
    """Return the mean over a cycle of the torque that the drive holds [N·m].

    Parameters
    ----------
    before, accepted : float or ndarray
        Command of the previous cycle and of this cycle [N·m].
    acted : float or ndarray
        Time from the sample until the drive acts on the command [s]. Until then, the previous command holds.
    period : float
        Period of the cycles [s].
    """
    if isinstance(acted, float):
        share = min(1.0, acted / period)
        return share * before + (1.0 - share) * accepted
    shares = np.minimum(1.0, acted / period)
    return shares * before + (1.0 - shares) * accepted


def capped(shift: Value, period: float) -> Value:
    """Return the time by which a reference is extrapolated [s]: at most one period, as later cycles are skipped."""
    if isinstance(shift, float):
        return max(-period, min(period, shift))
    return np.clip(shift, -period, period)


def target_at(reference: Value, velocity: Value, acceleration: Value, shift: Value) -> Value:
    """Return the reference at the time of a sample, taken `shift` [s] after it was due."""
    return reference + shift * (velocity + 0.5 * shift * acceleration)
