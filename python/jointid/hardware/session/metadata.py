"""Metadata of a session's recording: all values that are needed to repeat the session."""

from __future__ import annotations

import math
import platform
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from importlib.metadata import version
from typing import Any

import numpy as np

from jointid import _core
from jointid.hardware.session.drive import Drive
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.watchdog import watchdog_of
from jointid.joint.joint import Joint
from jointid.joint.joint_file import joint_document
from jointid.simulation.arguments import Controller
from jointid.simulation.designed_for import DesignedFor
from jointid.simulation.trajectory import Trajectory

_LONGEST = 100  # longest list of numbers that is kept; the samples of a trajectory are in the reference anyway


def session_metadata(
    drive: Drive,
    controller: Controller,
    trajectory: Trajectory,
    limits: SessionLimits,
    options: SessionOptions,
) -> dict[str, Any]:
    """Return the metadata that is known before a session begins, in JSON types. It is the same when it is repeated.

    A drive may have a `joint`, and a method `metadata` that returns the name of its type and its options.
    """
    joint, described = getattr(drive, "joint", None), getattr(drive, "metadata", None)
    values = {
        "control_period": options.period,
        "joint": joint_document(joint) if isinstance(joint, Joint) else None,
        "controller": {"kind": type(controller).__name__} | _gains(controller),
        "trajectory": {
            "form": trajectory.form,
            "duration": trajectory.duration,
            "arguments": {name: _short(value) for name, value in trajectory.arguments},
        },
        "limits": plain(limits),
        "options": plain(options),
        "drive": plain(drive.identity()),
        "watchdog": plain(watchdog_of(drive)),
        **(plain(described()) if callable(described) else {}),
        "versions": {
            "jointid": _core.__version__,
            "python": platform.python_version(),
            "numpy": np.__version__,
            "python-can": version("python-can"),
        },
    }
    return {name: value for name, value in values.items() if value is not None}


def motion_metadata(
    designed_for: DesignedFor | None,
    trajectory: Trajectory,
    joint: object,
    controller: Controller,
    period: float,
) -> dict[str, Any]:
    """Return the key `motion_warning` if the motion was designed for other conditions."""
    if designed_for is None:
        return {}
    moved = joint if isinstance(joint, Joint) else None
    warning = designed_for.warning(trajectory, moved, controller, period)
    return {"motion_warning": warning} if warning else {}


def plain(value: Any) -> Any:
    """Return a value in JSON types: a dataclass as a mapping, a number that is not finite as None."""
    if is_dataclass(value) and not isinstance(value, type):
        return {item.name: plain(getattr(value, item.name)) for item in fields(value)}
    if isinstance(value, Mapping):
        return {str(name): plain(entry) for name, entry in value.items()}
    if isinstance(value, tuple | list):
        return [plain(entry) for entry in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value if value is None or isinstance(value, str | int) else str(value)


def _gains(controller: object) -> dict[str, Any]:
    """Return the gains of one of the core's controllers; a controller of another type may have none."""
    gains = getattr(controller, "asdict", None)
    return {"gains": plain(gains())} if callable(gains) else {}


def _short(value: Any) -> Any:
    if isinstance(value, tuple) and len(value) > _LONGEST:
        return f"{len(value)} numbers"
    return plain(value)
