"""A velocity signal that disagrees with the position: delay, unit or sign."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.units import IMPLAUSIBLE_UNITS, degrees_advice
from jointid.recording.recording import Recording

REVERSED_SIGN = FindingType(
    code="reversed_sign",
    severity="blocking",
    meaning="the torque works against the motion, or velocity or sensor have the opposite sign",
    advice="flip the sign of the column that is wrong; of a motor-side torque, that of the gear ratio",
)
VELOCITY_MISMATCH = FindingType(
    code="velocity_mismatch",
    meaning="the velocity differs from the position's rate by more than 3 %",
    advice="correct its unit, or leave the velocity column out",
)
SIGNAL_LAG = FindingType(
    code="signal_lag",
    meaning="the velocity lags the position, or the sensor lags the motion, as a filter, a slow bus or a "
    "backward difference does",
    advice="leave the velocity column out (it is then derived centrally); of a sensor, remove the filter or shift "
    "the column",
)

MISMATCH = 0.03  # of the position's rate
LAG = 0.4  # sample periods between position and velocity; a backward difference has 0.5
_SURE = 8.0  # standard errors
_HARMLESS = 0.5  # of what the lag displaces
_DEGREE = np.pi / 180.0
_WITHOUT_VELOCITY = Action(
    "call", {"columns": {"velocity": None}}, text="it is then derived centrally", function="load"
)
_FINER = Action(
    "record", text="the position with a finer resolution, or a velocity without the filter"
)


def _is_better_derived(recording: Recording, lag: float) -> bool:
    """Whether the position's rate scatters less than the velocity does, or than the lag displaces it.

    Of a coarse encoder, or with time stamps of a busy computer, it scatters more.
    """
    plain = Recording(time=recording.time, position=recording.position)
    span = min(8, len(recording) // 4)
    rate = (recording.velocity[span:] - recording.velocity[:-span]) / (
        recording.time[span:] - recording.time[:-span]
    )
    displaced = abs(lag) * float(np.sqrt(np.mean(rate**2)))
    own = _scatter(recording.velocity)
    return _scatter(plain.velocity) < max(_HARMLESS * displaced, own)


def _scatter(velocity: NDArray[np.float64]) -> float:
    """Standard deviation of noise, from third differences, in which motion hardly shows."""
    third = np.abs(np.diff(velocity, n=3))
    third = np.minimum(third, np.quantile(third, 0.99))
    return float(np.sqrt(np.mean(third**2) / 20.0))


def _find(evidence: Evidence) -> Iterator[Finding]:
    for inspected in evidence.inspections:
        recording, found = inspected.recording, inspected.found.agreement
        if found is None:
            continue
        late = found.lag / recording.sample_period
        scale = {"scale": Measured(found.scale)}
        if found.scale < 0.0:
            yield REVERSED_SIGN.finding(
                "the velocity has the opposite sign of the position's change: one of the two signs is reversed",
                Action(
                    "inspect", text="the signs of position and velocity, and flip the wrong one"
                ),
                evidence=scale,
            )
        elif _near(found.scale, _DEGREE) or _near(found.scale, 1.0 / _DEGREE):
            which = "velocity" if found.scale < 1.0 else "position"
            factor = max(found.scale, 1.0 / found.scale)
            yield IMPLAUSIBLE_UNITS.finding(
                f"position and velocity differ by a factor of {factor:.1f}: the {which} seems to be in degrees",
                degrees_advice(recording, (which,)),
                evidence={"factor": Measured(factor)},
            )
        elif abs(found.scale - 1.0) > MISMATCH:
            yield VELOCITY_MISMATCH.finding(
                f"the position moves by {found.scale:.4g} times the integral of the velocity",
                Action("inspect", text="the units of both"),
                _WITHOUT_VELOCITY,
                evidence=scale,
            )
        elif abs(late) > LAG and abs(found.lag) > _SURE * found.lag_error:
            side = "lags" if late > 0.0 else "leads"
            yield SIGNAL_LAG.finding(
                f"the velocity {side} the position by {1e3 * abs(found.lag):.3g} ms ({abs(late):.1f} sample "
                "periods), as a filter or a backward difference does, which biases inertia and static friction",
                _WITHOUT_VELOCITY if _is_better_derived(recording, found.lag) else _FINER,
                evidence={
                    "lag": Measured(found.lag, "s"),
                    "lag_error": Measured(found.lag_error, "s"),
                    "lag_periods": Measured(late),
                },
            )


def _near(value: float, wanted: float) -> bool:
    return 0.8 < value / wanted < 1.25


CHECK = Check(_find, (REVERSED_SIGN, IMPLAUSIBLE_UNITS, VELOCITY_MISMATCH, SIGNAL_LAG))
