"""Ripple that the model lacks: a peak of the residual at a multiple of the motor's or the joint's angle."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.errors import InputError
from jointid.estimate.findings import Warned
from jointid.estimate.wording import percent
from jointid.identification.facts import Facts

Array = NDArray[np.float64]

_HALVES = 16  # multiples of half the motor's angle that are looked at: 0.5 to 8
_SHARE = 0.05  # of the residual's variance
_CHANCE = 30.0  # times the share that white noise gives one multiple
_OUTSTANDING = 10.0  # times the median share of all multiples: a sharp event has them all
_FINE = 2.2  # sample periods a window: longer ones average fast ripple away


@dataclass(frozen=True, slots=True, kw_only=True)
class _Peak:
    multiple: float
    amplitude: float
    share: float


def _fine_residual(facts: Facts) -> tuple[Array, Array, Array] | None:
    """Mean residual over windows of two samples [N·m or N], angle and angle's step there [rad]."""
    period = min(recording.sample_period for recording in facts.recordings)
    try:
        fine = facts.problem.penalty(_FINE * period)
    except InputError:
        return None
    if list(fine.names) != list(facts.penalty.names):
        return None
    residual = np.asarray(fine.residuals(facts.best)) / fine.usable_duration
    if fine.residual == _core.Residual.sensor:
        residual = residual * facts.best[list(fine.names).index("sensor_gain")]
    bounds = np.asarray(fine.windows)
    run = np.asarray(fine.recording_of)
    angle = np.empty(residual.size)
    step = np.empty(residual.size)
    for number, recording in enumerate(facts.recordings):
        mine = run == number
        start = recording.position[bounds[mine, 0]]
        stop = recording.position[bounds[mine, 1]]
        angle[mine], step[mine] = 0.5 * (start + stop), np.abs(stop - start)
    return residual, angle, step


def _highest_peak(residual: Array, angle: Array, step: Array, gear: float) -> _Peak | None:
    """The multiple of the motor's angle that explains most of the residual."""
    # Windows of fast motion average the highest multiple away, and would count against it.
    kept = step * gear * 0.5 * _HALVES < 4.0 * np.pi
    if np.count_nonzero(kept) < 50:
        return None
    residual = residual[kept] - residual[kept].mean()
    turn = np.exp(0.5j * gear * angle[kept])
    power = max(float(residual @ residual), 1e-300)
    current = residual.astype(np.complex128)
    sums = np.empty(_HALVES)
    for half in range(_HALVES):
        current = current * turn
        sums[half] = abs(current.sum())
    shares = 2.0 * sums**2 / (residual.size * power)
    highest = int(np.argmax(shares))
    chance = 2.0 / residual.size
    if shares[highest] < max(_SHARE, _CHANCE * chance, _OUTSTANDING * float(np.median(shares))):
        return None
    return _Peak(
        multiple=0.5 * (highest + 1),
        amplitude=float(2.0 * sums[highest] / residual.size),
        share=float(shares[highest]),
    )


def ripple(facts: Facts) -> Iterator[Warned]:
    """A periodic residual over the motor's angle."""
    gear = abs(facts.joint.gear_ratio) if facts.joint is not None else 1.0
    if gear == 1.0 or facts.recordings[0].kind == "prismatic":
        return
    fine = _fine_residual(facts)
    peak = None if fine is None else _highest_peak(*fine, gear)
    if peak is not None:
        multiple = f"{peak.multiple:g}"
        term = f"ripple=({multiple},)" if peak.multiple.is_integer() else "a ripple term"
        yield Warned(
            code="ripple",
            parameters=("sensor_gain",) if "sensor_gain" in facts.parameters else (),
            message=(
                f"the residual swings with {multiple} × motor angle: amplitude about {peak.amplitude:.2g} N·m, "
                f"{percent(peak.share)} of the residual's variance, as a strain-wave gear's ripple does; "
                f"it biases gain and static friction: add {term} to the model"
            ),
        )
