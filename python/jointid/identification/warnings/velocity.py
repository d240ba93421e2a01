"""A velocity signal that disagrees with the position: unit or sign."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected, inspect
from jointid.identification.warnings.motor_side import known_ratio, other_side, possible_side
from jointid.identification.warnings.units import IMPLAUSIBLE_UNITS, degrees_advice, unit_by_factor
from jointid.recording.recording import Recording

REVERSED_SIGN = FindingType(
    code="reversed_sign",
    severity="blocking",
    meaning="the torque acts against the motion, or velocity or sensor has the wrong sign",
    advice="flip the sign of the wrong column; for a motor-side torque, flip the sign of the gear ratio",
)
VELOCITY_MISMATCH = FindingType(
    code="velocity_mismatch",
    meaning="the velocity differs from the position's derivative by more than 3 % (blocking: by more than 10 %)",
    advice="correct sampling rate, gear ratio or unit, or state the side of the gear. If only the velocity column "
    "is wrong, leave this column out",
)

MISMATCH = 0.03  # of the position's rate
_WRONG = 1.1  # a factor that no filter or gain explains: a fact is wrong, perhaps not that of the velocity
_OTHER_UNIT = 3.0  # a factor that a side of the gear may explain
_DEGREE = np.pi / 180.0
_WITHOUT_VELOCITY = Action(
    "call",
    {"columns": {"velocity": None}},
    "if the velocity alone is wrong",
    "load",
)


def _in_recording(evidence: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording, found = inspected.recording, inspected.found.agreement
    if found is None:
        return
    scale = {"scale": Measured(found.scale)}
    rate = f"the position's derivative is {found.scale:.4g} times the velocity"
    ratio = known_ratio(evidence)
    suspected, advice = unit_by_factor(recording, found.scale, ratio)
    gear = other_side(ratio, found.scale)
    large = not 1.0 / _OTHER_UNIT < abs(found.scale) < _OTHER_UNIT
    possible = [possible_side(found.scale)] * (large and ratio is None)
    if gear is not None:
        yield VELOCITY_MISMATCH.finding(
            f"{rate}: the {gear[0]} is on the motor side",
            gear[1],
            details="the gear ratio explains the factor",
            evidence=scale,
            severity="blocking",
        )
    elif found.scale < 0.0:
        yield REVERSED_SIGN.finding(
            "velocity and derivative of the position have opposite signs: one sign is wrong",
            *possible,
            Action("inspect", text="the signs of position and velocity, and flip the wrong one"),
            evidence=scale,
        )
    elif (stated := _units_against_the_file(recording)) and abs(found.scale - 1.0) > MISMATCH:
        names = " and ".join(f"{signal} in {unit}" for signal, unit in stated.items())
        yield VELOCITY_MISMATCH.finding(
            f"{rate}; the file states {names}",
            Action("call", {"units": stated}, function="load"),
            evidence=scale,
            severity="blocking",
        )
    elif not suspected and (_near(found.scale, _DEGREE) or _near(found.scale, 1.0 / _DEGREE)):
        which = "velocity" if found.scale < 1.0 else "position"
        factor = max(found.scale, 1.0 / found.scale)
        yield IMPLAUSIBLE_UNITS.finding(
            f"position and velocity differ by a factor of {factor:.1f}: the {which} seems to be in degrees",
            *([] if abs(factor * _DEGREE - 1.0) < MISMATCH else possible),
            degrees_advice(recording, (which,)),
            evidence={"factor": Measured(factor)},
        )
    elif abs(found.scale - 1.0) > MISMATCH:
        facts = () if suspected else tuple(_stated_facts(recording, found.scale))
        wrong = not 1.0 / _WRONG < found.scale < _WRONG
        yield VELOCITY_MISMATCH.finding(
            f"{suspected}: velocity and position differ by a factor of {found.scale:.4g}"
            if suspected
            else rate,
            *facts,
            *(advice if suspected else possible),
            *([] if suspected or (facts and wrong) else [_WITHOUT_VELOCITY]),
            *(() if suspected else advice),
            details="the log states no unit for this signal" if suspected else "",
            evidence=scale,
            severity="blocking" if wrong else None,
        )


def _units_against_the_file(recording: Recording) -> dict[str, str]:
    """Return units of the motion that the call states instead of the file; none if the file leaves one open."""
    assumed, overridden = (
        recording.metadata.get(name) for name in ("assumed_units", "overridden_units")
    )
    moving = {"time", "position", "velocity"}
    if not isinstance(overridden, Mapping) or (
        isinstance(assumed, list | tuple) and not moving.isdisjoint(assumed)
    ):
        return {}
    return {signal: str(unit) for signal, unit in overridden.items() if signal in moving}


def _stated_facts(recording: Recording, factor: float) -> Iterator[Action]:
    """Yield corrections of facts in the call that explain a factor between position and velocity: rate, gear ratio."""
    stated = recording.metadata
    period, ratio = stated.get("sample_period"), stated.get("gear_ratio")
    if isinstance(period, int | float):
        right = 1.0 / _short(1.0 / (period * factor))
        yield Action("call", {"sample_period": right}, "if the rate is wrong", "load")
    sides = stated.get("stated_sides")
    if isinstance(ratio, int | float) and isinstance(sides, Mapping):
        of_motor = {name for name in ("position", "velocity") if sides.get(name) == "motor"}
        if len(of_motor) == 1:
            right = ratio / factor if of_motor == {"velocity"} else ratio * factor
            yield Action(
                "call", {"gear_ratio": _short(right)}, "if the gear ratio is wrong", "load"
            )


def _short(value: float) -> float:
    """Return a value with four digits, or with two if these are within 1 %, as rates and ratios are usually stated."""
    two = float(f"{value:.2g}")
    return two if abs(two / value - 1.0) < 0.01 else float(f"{value:.4g}")


def raise_if_far_off(recordings: Sequence[Recording]) -> None:
    """Raise `InputError` if a velocity is so large that the joint seems to stand still in comparison."""
    for number, run in enumerate(recordings):
        found = inspect(run).found.agreement
        if found is not None and 0.0 < abs(found.scale) < 1.0 / _OTHER_UNIT:
            raise InputError(
                f"the change of position is {found.scale:.4g} times the integral of the velocity",
                argument="velocity",
                place=f"recording {number}",
                remedy=(
                    Action("inspect", text="the units of both"),
                    possible_side(found.scale),
                    _WITHOUT_VELOCITY,
                ),
            )


def _near(value: float, wanted: float) -> bool:
    return 0.8 < value / wanted < 1.25


CHECK = Check(None, (REVERSED_SIGN, IMPLAUSIBLE_UNITS, VELOCITY_MISMATCH), _in_recording)
