"""Command that designs the next motion to record, as a finding advises it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from jointid.base.advice import Action
from jointid.cli.values import behind_option

_LIMITS = {
    "position": ("--position", "LOW,HIGH"),
    "velocity": ("--velocity", "SPEED"),
    "acceleration": ("--acceleration", "ACCELERATION"),
    "torque": ("--torque", "TORQUE"),
    "sensor_range": ("--sensor-range", "TORQUE"),
}


def words_of_next_motion(action: Action, joint: str, estimate: str, of_joint: str = "") -> str:
    """Return an action that designs a motion, as a command.

    Parameters
    ----------
    action : Action
        Action of kind "record" with the function "next_motion".
    joint, estimate : str
        Joint file and saved estimate, or placeholders for them.
    of_joint : str
        Name of the joint if the estimate has several. Default: it has one.
    """
    command = ["jointid", "design", joint, "--after", estimate]
    if of_joint:
        command.append(f"--after-joint {behind_option(of_joint)}")
    limits: Mapping[str, Any] = action.arguments.get("limits", {})
    for name, value in limits.items():
        option, unknown = _LIMITS[name]
        # With "=", because a value that begins with a minus sign would be read as an option.
        command.append(f"{option}={unknown if _unknown(value) else behind_option(value)}")
    if "duration" in action.arguments:
        command.append(f"--duration {behind_option(action.arguments['duration'])}")
    return f"record {action.text}, designed by {' '.join(command)} --output motion.toml"


def _unknown(value: object) -> bool:
    return value is ... or value == "..."


def runs_as_printed(action: Action) -> bool:
    """Return whether the design needs no value that only the user knows."""
    limits: Mapping[str, Any] = action.arguments.get("limits", {})
    return not any(_unknown(value) for value in (*limits.values(), *action.arguments.values()))
