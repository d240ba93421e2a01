"""State of a motor as its drive reports it: off, or the drive's action on it."""

from __future__ import annotations

from typing import Literal, get_args

from jointid.joint.checks import check_choice

MotorState = Literal["off", "damped", "held", "braked", "on"]


def state_of(state: MotorState | None, motor_off: bool | None) -> MotorState | None:
    """Return a state, or the state that the older flag `motor_off` means.

    Raises
    ------
    InputError
        The state does not exist.
    """
    if state is None:
        return None if motor_off is None else "off" if motor_off else "on"
    check_choice("", "state", state, get_args(MotorState))
    return state


def is_off(state: MotorState | None) -> bool | None:
    """Return whether a motor is off; None if its state is not known."""
    return None if state is None else state == "off"
