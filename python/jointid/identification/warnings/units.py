"""Advice if degrees were read as radians: state a unit that no header states, and never override a header."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from jointid.base.advice import Action
from jointid.identification.warnings.check import FindingType
from jointid.recording.recording import Recording

IMPLAUSIBLE_UNITS = FindingType(
    code="implausible_units",
    severity="blocking",
    meaning="degrees seem to be read as radians: the motion is too fast or too wide, or velocity or inertia is wrong "
    "by a factor of about 57.3. Or the motor's angle is read as the joint's angle. Or the time is not in seconds. Or a "
    "current above 100 A or a torque above 5 kN·m has no stated unit. Info: the motion is wide, but its unit is stated",
    advice="state the unit of position, velocity, time, current or torque when loading, or convert the values",
)
_DEGREES = {"position": "deg", "velocity": "deg/s"}

# Position's change over the integral of the velocity, both read in SI units → their true units.
_FACTORS: tuple[tuple[float, dict[str, str]], ...] = (
    (1.0 / (2.0 * math.pi), {"position": "rev"}),
    (2.0 * math.pi, {"velocity": "rev_s"}),
    (2.0 * math.pi / 60.0, {"velocity": "rpm"}),
    (1e-3, {"time": "ms"}),
    (1e3, {"position": "mrad"}),
    (6.0, {"position": "deg", "velocity": "rpm"}),
    (360.0, {"position": "deg", "velocity": "rev_s"}),
    (1.0 / 60.0, {"position": "rev", "velocity": "rpm"}),
    (1.0 / 360.0, {"position": "rev", "velocity": "deg_s"}),
    (100.0 * math.pi / 3.0, {"position": "mrad", "velocity": "rpm"}),
)
_CLOSE = 0.03


def unit_by_factor(
    recording: Recording, factor: float, ratio: float | None = None
) -> tuple[str, tuple[Action, ...]]:
    """Return the unit that a factor between position and velocity suggests, as words and as advice.

    Parameters
    ----------
    recording : Recording
    factor : float
        Position's change over the integral of the velocity.
    ratio : float, optional
        Gear ratio: one of the two signals may be on the motor side. Default: not known.
    """
    assumed = recording.metadata.get("assumed_units")
    unstated = set(assumed) if isinstance(assumed, list | tuple) else set()
    of_motor = {} if ratio is None else {"velocity": ratio, "position": 1.0 / ratio}
    for signal, times in {"": 1.0, **of_motor}.items():
        for known, units in _FACTORS if recording.kind == "revolute" else ():
            if abs(factor * times / known - 1.0) > _CLOSE or not set(units) <= unstated:
                continue
            verb = "seem" if len(units) > 1 else "seems"
            side = {"side": {signal: "motor"}, "gear_ratio": ratio} if signal else {}
            advice = Action("call", {**side, "units": units}, function="load")
            return (
                f"{' and '.join(units)} {verb} to be in {' and '.join(units.values())}"
                + f", and the {signal} on the motor side" * bool(signal),
                (advice,),
            )
    return "", (Action("inspect", text="the units of position, velocity and time"),)


def degrees_advice(recording: Recording, signals: Sequence[str]) -> Action:
    """Return advice to read signals that seem to be in degrees."""
    assumed = recording.metadata.get("assumed_units")
    unstated = [name for name in signals if isinstance(assumed, list | tuple) and name in assumed]
    overridden = recording.metadata.get("overridden_units")
    units = {name: _DEGREES[name] for name in unstated}
    if isinstance(overridden, Mapping):
        units |= {name: overridden[name] for name in signals if name in overridden}
    if units:
        return Action("call", {"units": units}, function="load")
    text = "the header or program that states radians, and correct the unit or values"
    return Action("inspect", text=text)
