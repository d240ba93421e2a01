"""Proposed units for columns without a stated unit: those that make a joint's motion plausible."""

from __future__ import annotations

import math
from collections.abc import Collection

import numpy as np

from jointid.base.values import dataclass
from jointid.recording.recording import Recording
from jointid.recording.signals import FloatArray
from jointid.recording.units import LARGEST, UNITS, WIDE, WIDEST

_FAST = 50.0  # [rad/s], of a joint with a gear
_ALIKE = (
    0.03  # tolerance of the velocity over the position's rate; the ratios 6 and 2π differ by 5 %
)
_PAIRS = (
    *(("rad", "rad_s"), ("deg", "deg_s"), ("rad", "deg_s"), ("rad", "rpm"), ("rad", "rev_s")),
    *(("deg", "rad_s"), ("deg", "rpm"), ("deg", "rev_s"), ("rev", "rad_s"), ("rev", "rpm")),
)


@dataclass(frozen=True, slots=True)
class ProposedUnit:
    """A unit that a signal probably has.

    Parameters
    ----------
    unit : str
        Unit as in a header.
    reason : str
        Reason as a phrase with the values.
    """

    unit: str
    reason: str


def proposed_units(recording: Recording) -> dict[str, ProposedUnit]:
    """Return signal → unit that is likelier than SI, for signals with no unit in the header or the call.

    Position and velocity are judged together, by the position's rate of change. Torque and current are judged by
    their size alone.
    Signals that are plausible in SI are not in the result, nor signals that no unit makes plausible.

    Parameters
    ----------
    recording : Recording
        Recording with SI assumed for the signals in ``metadata["assumed_units"]``.

    Examples
    --------
    >>> turned = jid.Recording(time=np.arange(100) / 50.0, position=60.0 * np.sin(np.arange(100) / 20.0),
    ...     torque=np.ones(100), metadata={"assumed_units": ["position"]})
    >>> proposed_units(turned)["position"].unit
    'deg'
    """
    stated = recording.metadata.get("assumed_units")
    unstated = set(stated) if isinstance(stated, list | tuple) else set()
    found: dict[str, ProposedUnit] = {}
    if recording.kind == "revolute":
        found |= _of_motion(recording, unstated)
    return found | unlikely_sizes(recording, unstated)


def unlikely_sizes(
    recording: Recording, signals: Collection[str], times: float = 1.0
) -> dict[str, ProposedUnit]:
    """Return signal → unit that makes an unusually large current or torque plausible.

    Parameters
    ----------
    recording : Recording
    signals : collection of str
        Signals to judge.
    times : float
        Allowed multiple of the largest usual value. Default 1.
    """
    found = {}
    for signal, (limit, unit, smaller) in LARGEST.items() if recording.kind == "revolute" else ():
        values = getattr(recording, signal)
        if signal in signals and values is not None:
            largest = float(np.abs(values).max())
            if largest > times * limit:
                reason = f"the largest value is {largest:.4g}; in {smaller}, this value is {largest / 1e3:.3g} {unit}"
                found[signal] = ProposedUnit(smaller, reason)
    return found


def _of_motion(recording: Recording, unstated: set[str]) -> dict[str, ProposedUnit]:
    position = recording.position
    largest = float(np.abs(position).max())
    wide = largest > WIDE
    recorded = not recording.velocity_derived and float(np.abs(recording.velocity).max()) > 0.0
    if not recorded:
        if "position" in unstated and wide and largest <= WIDEST:
            return {"position": _angle(position, "deg")}
        return {}
    slope = _slope(np.gradient(position, recording.time), recording.velocity)
    fast = float(np.abs(recording.velocity).max()) > _FAST
    for angle, speed in _PAIRS:
        if (angle != "rad" and "position" not in unstated) or (
            speed != "rad_s" and "velocity" not in unstated
        ):
            continue
        if angle == "rad" and "position" in unstated and (wide or (speed == "rad_s" and fast)):
            continue
        if abs(slope * UNITS[speed].factor / UNITS[angle].factor - 1.0) < _ALIKE:
            return _changed(recording, angle, speed, slope)
    return {}


def _changed(recording: Recording, angle: str, speed: str, slope: float) -> dict[str, ProposedUnit]:
    found = {}
    if angle != "rad":
        found["position"] = _angle(recording.position, angle)
    if speed != "rad_s":
        reason = (
            f"{slope:.4g} times the position's rate" if angle == "rad" else "as the position's rate"
        )
        found["velocity"] = ProposedUnit(speed, reason)
    return found


def _angle(position: FloatArray, unit: str) -> ProposedUnit:
    low, high = float(position.min()), float(position.max())
    turns = (high - low) / (2.0 * math.pi)
    return ProposedUnit(
        unit, f"values from {low:.4g} to {high:.4g}; in rad, this range is {turns:.3g} turns"
    )


def _slope(rate: FloatArray, velocity: FloatArray) -> float:
    square = float(rate @ rate)
    return float(rate @ velocity) / square if square > 0.0 else 0.0
