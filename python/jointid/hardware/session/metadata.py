"""What a session's recording says of itself: everything that it takes to do the session again."""

from __future__ import annotations

import math
import platform
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import can
import numpy as np

from jointid import _core
from jointid.base.errors import InputError
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter
from jointid.hardware.session.drive import Drive
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.options import SessionOptions
from jointid.joint.joint import Joint
from jointid.joint.joint_file import joint_document
from jointid.simulation.arguments import Controller
from jointid.simulation.trajectory import Trajectory

_LONGEST = 100  # numbers of an argument; a trajectory of samples is in the reference anyway
_SOURCES = {kind.__name__: kind for kind in (AnalogInput, SyncedConverter)}


def notes_of_session(
    drive: Drive,
    controller: Controller,
    trajectory: Trajectory,
    limits: SessionLimits,
    options: SessionOptions,
) -> dict[str, Any]:
    """What is known before a session begins, of JSON's types; the same whenever it is repeated.

    Joint and wiring are those of a drive with attributes `joint` and `options`, as an `ElmoDrive` has.
    """
    joint, wired = getattr(drive, "joint", None), getattr(drive, "options", None)
    notes = {
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
        "drive_options": plain(wired) if is_dataclass(wired) else None,
        "versions": {
            "jointid": _core.__version__,
            "python": platform.python_version(),
            "numpy": np.__version__,
            "python-can": can.__version__,
        },
    }
    return {name: value for name, value in notes.items() if value is not None}


def plain(value: Any) -> Any:
    """Return a value as JSON's types: a dataclass as a mapping, what is not finite as None."""
    if is_dataclass(value) and not isinstance(value, type):
        named = {"source": type(value).__name__} if type(value).__name__ in _SOURCES else {}
        return named | {item.name: plain(getattr(value, item.name)) for item in fields(value)}
    if isinstance(value, Mapping):
        return {str(name): plain(entry) for name, entry in value.items()}
    if isinstance(value, tuple | list):
        return [plain(entry) for entry in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value if value is None or isinstance(value, str | int) else str(value)


def elmo_options_of(notes: Mapping[str, Any], place: str) -> ElmoOptions:
    """The wiring that a recording's `drive_options` tell; the default one where they tell nothing.

    Raises
    ------
    InputError
        They are those of another drive, or of a later version.
    """
    said = notes.get("drive_options")
    if said is None:
        return ElmoOptions()
    try:
        torque = said["torque"]
        if torque is not None:
            rest = {name: entry for name, entry in torque.items() if name != "source"}
            scaling = SensorScaling(**rest.pop("scaling"))
            torque = _SOURCES[torque["source"]](**rest, scaling=scaling)
        return ElmoOptions(**{**said, "torque": torque})
    except (KeyError, TypeError, AttributeError) as error:
        raise InputError(
            f"{place}: its drive_options are not those of an Elmo drive ({error}); give options="
        ) from None


def _gains(controller: object) -> dict[str, Any]:
    """The core's controllers tell them; another that works like one need not."""
    told = getattr(controller, "asdict", None)
    return {"gains": plain(told())} if callable(told) else {}


def _short(value: Any) -> Any:
    if isinstance(value, tuple) and len(value) > _LONGEST:
        return f"{len(value)} numbers"
    return plain(value)
