"""The command that designs the motion to record next, as a finding advises it."""

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
    """An action that designs a motion, as a command.

    Parameters
    ----------
    action : Action
        An action of kind "record" with the function "next_motion".
    joint, estimate : str
        The joint file and the saved estimate, or what stands for them.
    of_joint : str
        The joint, where the estimate is of several. Default: it is of one.
    """
    command = ["jointid", "design", joint, "--after", estimate]
    if of_joint:
        command.append(f"--after-joint {behind_option(of_joint)}")
    limits: Mapping[str, Any] = action.arguments.get("limits", {})
    for name, value in limits.items():
        option, unknown = _LIMITS[name]
        # With "=": a value that begins with a minus would be taken for an option.
        command.append(f"{option}={unknown if _unknown(value) else behind_option(value)}")
    if "duration" in action.arguments:
        command.append(f"--duration {behind_option(action.arguments['duration'])}")
    return f"record {action.text}, designed by {' '.join(command)} --output motion.toml"


def _unknown(value: object) -> bool:
    return value is ... or value == "..."


def runs_as_printed(action: Action) -> bool:
    """Whether the design needs nothing that only the user knows."""
    limits: Mapping[str, Any] = action.arguments.get("limits", {})
    return not any(_unknown(value) for value in (*limits.values(), *action.arguments.values()))
