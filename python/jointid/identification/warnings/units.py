"""What to do where degrees were taken for radians: state a unit that no header states, never overrule a stated one."""

from __future__ import annotations

from collections.abc import Sequence

from jointid.base.advice import Action
from jointid.identification.warnings.check import FindingType
from jointid.recording.recording import Recording

IMPLAUSIBLE_UNITS = FindingType(
    code="implausible_units",
    severity="blocking",
    meaning="degrees taken for radians: position and velocity differ by 57.3, a known inertia is contradicted by "
    "as much, or the motion would be impossibly fast or wide; or other stamps than seconds",
    advice="state the unit of position, velocity and time when loading, or convert the values",
)
_DEGREES = {"position": "deg", "velocity": "deg/s"}


def degrees_advice(recording: Recording, signals: Sequence[str]) -> Action:
    """How to read signals that seem to be in degrees."""
    assumed = recording.metadata.get("assumed_units")
    unstated = [name for name in signals if isinstance(assumed, list | tuple) and name in assumed]
    if unstated:
        units = {name: _DEGREES[name] for name in unstated}
        return Action("call", {"units": units}, function="load")
    return Action(
        "inspect",
        text="the header or the program that made the recording, which states radians: correct it, or convert the "
        "values",
    )
