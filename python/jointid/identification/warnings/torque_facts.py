"""Corrections of the torque that explain a factor between it and a known inertia: its side, its unit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from jointid.base.advice import Action
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import DRIVE
from jointid.joint.joint import Joint
from jointid.recording.recording import Recording
from jointid.recording.sides import READ_FROM
from jointid.recording.signals import dimensions
from jointid.recording.units import UNITS, find_unit

_CLOSE = 0.1  # of a factor: tolerance of a known inertia


def corrections_of(evidence: Evidence, ratio: float) -> Iterator[Action]:
    """Yield corrections that make the torque 1 / `ratio` as large; a fact in a header is never overridden.

    Parameters
    ----------
    evidence : Evidence
    ratio : float
        Ratio of the identified to the known inertia.
    """
    recording = evidence.recordings[0]
    joint = evidence.joint
    signal = next((name for name in DRIVE if getattr(recording, name) is not None), None)
    if signal is None:
        return
    if signal == "torque":
        signal = str(recording.metadata.get(READ_FROM, signal))
    if joint is not None and abs(joint.gear_ratio) != 1.0:
        yield from _of_gear(joint, recording, signal, ratio)
    unit = _other_unit(recording, signal, ratio)
    if unit is not None:
        yield Action("call", {"units": {signal: unit}}, "if this is the true unit", "load")


def _of_gear(joint: Joint, recording: Recording, signal: str, ratio: float) -> Iterator[Action]:
    gear, constant = abs(joint.gear_ratio), joint.torque_constant
    stated = recording.metadata.get("stated_sides")
    of_motor = isinstance(stated, Mapping) and stated.get("torque") == "motor"
    if signal == "torque" and _near(ratio * gear) and not of_motor:
        sides = {"side": {"torque": "motor"}, "gear_ratio": joint.gear_ratio}
        yield Action("call", sides, "if the torque is the motor's", "load")
    elif signal == "torque" and _near(ratio / gear) and of_motor:
        yield Action("call", {"side": {"torque": "joint"}}, "if the torque is the joint's", "load")
    elif signal == "current" and _near(ratio / gear) and constant is not None:
        right, text = (
            float(f"{constant / gear:.6g}"),
            "if the stated torque constant applies behind the gear",
        )
        yield Action("call", {"torque_constant": right}, text, "Joint")


def _other_unit(recording: Recording, signal: str, ratio: float) -> str | None:
    """Return the unit that explains the factor, for a signal without a unit or with a unit from the call."""
    assumed, stated = (recording.metadata.get(key) for key in ("assumed_units", "stated_units"))
    by_call = stated.get(signal) if isinstance(stated, Mapping) else None
    if by_call is None and not (isinstance(assumed, list | tuple) and signal in assumed):
        return None
    taken = find_unit(str(by_call)) if by_call is not None else None
    factor = 1.0 if taken is None else taken.factor
    dimension = dimensions(signal, recording.kind)[0]
    return next(
        (
            unit.name
            for unit in UNITS.values()
            if unit.dimension == dimension and _near(unit.factor * ratio / factor)
        ),
        None,
    )


def _near(value: float) -> bool:
    return abs(value - 1.0) < _CLOSE
