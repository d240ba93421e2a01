"""A velocity signal that disagrees with the position: unit or sign."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected, inspect
from jointid.identification.warnings.motor_side import other_side, possible_side
from jointid.identification.warnings.units import IMPLAUSIBLE_UNITS, degrees_advice, unit_by_factor
from jointid.recording.recording import Recording

REVERSED_SIGN = FindingType(
    code="reversed_sign",
    severity="blocking",
    meaning="the torque works against the motion, or velocity or sensor have the opposite sign",
    advice="flip the sign of the column that is wrong; of a motor-side torque, that of the gear ratio",
)
VELOCITY_MISMATCH = FindingType(
    code="velocity_mismatch",
    meaning="the velocity differs from the position's rate by more than 3 %; blocking beyond a factor of 3, and where "
    "the call states the rate",
    advice="correct its unit, say on which side of the gear it is, or leave the velocity column out",
)

MISMATCH = 0.03  # of the position's rate
_OTHER_UNIT = 3.0  # a factor that no filter, gear or gain explains
_DEGREE = np.pi / 180.0
_WITHOUT_VELOCITY = Action(
    "call", {"columns": {"velocity": None}}, text="it is then derived centrally", function="load"
)


def _in_recording(evidence: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording, found = inspected.recording, inspected.found.agreement
    if found is None:
        return
    scale = {"scale": Measured(found.scale)}
    suspected, advice = unit_by_factor(recording, found.scale)
    gear = other_side(evidence, found.scale)
    large = not 1.0 / _OTHER_UNIT < abs(found.scale) < _OTHER_UNIT
    possible = [possible_side(found.scale)] * large
    if gear is not None:
        yield VELOCITY_MISMATCH.finding(
            f"the position moves by {found.scale:.4g} times the integral of the velocity, which the gear ratio "
            f"explains: the {gear[0]} is the motor's",
            gear[1],
            evidence=scale,
            severity="blocking",
        )
    elif found.scale < 0.0:
        yield REVERSED_SIGN.finding(
            "the velocity has the opposite sign of the position's change: one of the two signs is reversed",
            Action("inspect", text="the signs of position and velocity, and flip the wrong one"),
            *possible,
            evidence=scale,
        )
    elif not suspected and (_near(found.scale, _DEGREE) or _near(found.scale, 1.0 / _DEGREE)):
        which = "velocity" if found.scale < 1.0 else "position"
        factor = max(found.scale, 1.0 / found.scale)
        yield IMPLAUSIBLE_UNITS.finding(
            f"position and velocity differ by a factor of {factor:.1f}: the {which} seems to be in degrees",
            degrees_advice(recording, (which,)),
            *([] if abs(factor * _DEGREE - 1.0) < MISMATCH else possible),
            evidence={"factor": Measured(factor)},
        )
    elif abs(found.scale - 1.0) > MISMATCH:
        rate = None if suspected else _other_rate(recording, found.scale)
        if rate is not None:
            suspected, advice = (
                " at the rate that the call states: the rate is another one, or rows were lost",
                (rate, Action("record", text="the time of each sample"), *advice),
            )
        yield VELOCITY_MISMATCH.finding(
            f"the position moves by {found.scale:.4g} times the integral of the velocity{suspected}",
            *advice,
            *([] if suspected else possible),
            *([_WITHOUT_VELOCITY] if rate is None else []),
            evidence=scale,
            severity="blocking" if large or rate is not None else None,
        )


def _other_rate(recording: Recording, factor: float) -> Action | None:
    """How to read rows without a time so that position and velocity agree; None where they have one."""
    stated = recording.metadata.get("sample_period")
    if not isinstance(stated, float):
        return None
    period = float(f"{factor * stated:.6g}")
    return Action("call", {"sample_period": period}, "with which they agree", "load")


def raise_if_far_off(recordings: Sequence[Recording]) -> None:
    """Raise `InputError` if a velocity is so large that the joint seems to stand still beside it."""
    for number, run in enumerate(recordings):
        found = inspect(run).found.agreement
        if found is not None and abs(found.scale) < 1.0 / _OTHER_UNIT:
            raise InputError(
                f"the position moves by {found.scale:.4g} times its integral",
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
