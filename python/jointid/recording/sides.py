"""The sides of a gear: conversion of motor-side signals to the joint side."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from jointid.base.advice import Action
from jointid.base.argument_checks import is_finite, require_mapping
from jointid.base.errors import InputError
from jointid.recording.header_words import AT_THE_LINK

JOINT, MOTOR = "joint", "motor"
SIDES = (JOINT, MOTOR)
_MOTION = ("position", "velocity", "reference")
READ_FROM = "torque_read_from"
"""Metadata key: the signal that became the torque, if it was another one."""


def checked_ratio(gear_ratio: object, argument: str = "gear_ratio") -> float:
    """Return a gear ratio as a float.

    Raises
    ------
    InputError
        The ratio is not a finite number, or is 0.
    """
    if not is_finite(gear_ratio) or gear_ratio == 0:
        raise InputError(
            "motor angle per joint angle is expected: a number other than 0, negative if motor and joint turn in "
            "opposite directions",
            argument=argument,
            value=gear_ratio,
        )
    return float(gear_ratio)  # type: ignore[arg-type]


def at_joint(
    fields: Mapping[str, Any],
    side: str,
    gear_ratio: float | None,
    other_sides: Mapping[str, str] = MappingProxyType({}),
) -> dict[str, Any]:
    """Return the arguments of `Recording` on the joint side, if the gear ratio is known.

    Motor-side position, velocity and reference are divided by the ratio; motor-side torque and motor torque are
    multiplied by it. Without a ratio, signals stay on the motor side: ``metadata["side"]`` is then "motor", and
    the motor torque is the torque.

    Parameters
    ----------
    fields : mapping
        Arguments of `Recording`, as arrays.
    side : str
        Side of position, velocity, reference and torque: "joint" or "motor".
    gear_ratio : float or None
        Signed ratio. None: not known.
    other_sides : mapping of str to str
        Signal → its side, if it differs from `side`. Default: none.

    Raises
    ------
    InputError
        Signals are on both sides, and the ratio is not known.
    """
    if side == MOTOR and fields.get("torque") is None:  # the motor torque is then the torque
        other_sides = {name: each for name, each in other_sides.items() if name != "torque"}
    there = {name: each for name, each in other_sides.items() if fields.get(name) is not None}
    if there and gear_ratio is None:
        raise _on_both_sides(side, there)
    result = dict(fields)
    metadata = dict(result.get("metadata") or {})
    torque, motor_torque = result.get("torque"), result.get("motor_torque")
    if side == MOTOR and torque is None and motor_torque is not None:
        torque, motor_torque = motor_torque, None
        metadata[READ_FROM] = "motor_torque"
    if gear_ratio is None:
        if side == MOTOR:
            metadata["side"] = MOTOR
    else:
        metadata["gear_ratio"] = gear_ratio
        for name in _MOTION:
            if other_sides.get(name, side) == MOTOR and result.get(name) is not None:
                result[name] = result[name] / gear_ratio
        if torque is not None and other_sides.get("torque", side) == MOTOR:
            torque = torque * gear_ratio
        if motor_torque is not None and torque is None:
            torque, motor_torque = motor_torque * gear_ratio, None
            metadata[READ_FROM] = "motor_torque"
    result |= {"torque": torque, "motor_torque": motor_torque, "metadata": metadata}
    return result


def stated_sides(
    side: str, other_sides: Mapping[str, str], stated: Mapping[str, str] | None
) -> tuple[str, Mapping[str, str]]:
    """Return the side of the position, and the signals on the other side, as the call states them.

    Parameters
    ----------
    side, other_sides
        Sides from the headers.
    stated : mapping of str to str, or None
        Signal → "joint" or "motor", same as in `load`.

    Raises
    ------
    InputError
        The signal has no side, or the side is neither "joint" nor "motor".
    """
    if not stated:
        return side, other_sides
    moving = (*_MOTION, "torque")
    for name, each in require_mapping("side", stated, "{'velocity': 'motor'}").items():
        if name not in moving:
            raise InputError(
                f"only {', '.join(moving)} can have a side (motor or joint)",
                argument=f"side.{name}",
            )
        if each not in SIDES:
            raise InputError('"motor" or "joint" is expected', argument=f"side.{name}", value=each)
    sides = {name: stated.get(name, other_sides.get(name, side)) for name in moving}
    own = sides["position"]
    return own, {name: each for name, each in sides.items() if each != own}


def at_stated_sides(
    fields: Mapping[str, Any],
    gear_ratio: float | None,
    stated: Mapping[str, str] | None,
    *,
    side: str = JOINT,
    other_sides: Mapping[str, str] = MappingProxyType({}),
    place: str = "",
) -> dict[str, Any]:
    """Return the arguments of `Recording` on the joint side; headers and the call state the sides.

    Parameters
    ----------
    fields, gear_ratio, side, other_sides
        Same as in `at_joint`, without the sides from the call.
    stated : mapping of str to str, or None
        Same as in `stated_sides`.
    place : str
        The file, for messages. Default: none.

    Raises
    ------
    InputError
        Same errors as `at_joint` and `stated_sides`.
    """
    try:
        own, others = stated_sides(side, other_sides, stated)
        found = at_joint(fields, own, gear_ratio, others)
    except InputError as error:
        raise error.at(place) from None
    if stated:
        found["metadata"] = {**found["metadata"], "stated_sides": dict(stated)}
        if _unstated_torque(fields, stated, gear_ratio):
            found["metadata"]["assumed_side"] = "torque"
    return found


def _unstated_torque(
    fields: Mapping[str, Any], stated: Mapping[str, str], gear_ratio: float | None
) -> bool:
    """Whether the call sets the motion to the motor side, and the side of the torque is not stated."""
    at_motor = MOTOR in stated.values() and "torque" not in stated
    geared = gear_ratio is not None and abs(gear_ratio) != 1.0
    named = AT_THE_LINK in (fields.get("metadata") or {})
    return at_motor and geared and not named and fields.get("torque") is not None


def _on_both_sides(side: str, other_sides: Mapping[str, str]) -> InputError:
    names = " and ".join(other_sides)
    return InputError(
        f"the signals are on different sides: position on the {side} side, {names} on the "
        f"{next(iter(other_sides.values()))} side; the gear ratio is needed to combine these signals",
        argument="gear_ratio",
        value=None,
        remedy=Action("call", {"gear_ratio": ...}, function="load"),
    )
