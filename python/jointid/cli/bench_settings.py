"""Settings of a bench file: limits, motion, controller and drive; each one is stated or a default."""

from __future__ import annotations

import inspect
import math
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from jointid.base.values import dataclass

if TYPE_CHECKING:
    from jointid.hardware.bench.bench import Bench
    from jointid.hardware.session.limits import SessionLimits

_UNITS = {
    **dict.fromkeys(("position", "tracking_error"), "rad"),
    **dict.fromkeys(("velocity", "approach_velocity"), "rad/s"),
    **dict.fromkeys(("torque", "measured_torque", "torque_difference"), "N·m"),
    "torque_rate": "N·m/s",
    **dict.fromkeys(("period", "settle", "cycle", "duration"), "s"),
}
_UNSET = {"watchdog_travel": "the coasting distance plus a share of the window"}
_GAINS = ("bandwidth", "boundary", "stiffness", "damping")
_SESSION = ("period", "approach_velocity", "settle")


@dataclass(frozen=True, slots=True)
class Setting:
    """One setting.

    Parameters
    ----------
    table, name : str
        Names as in the joint file, e.g. "limits" and "velocity".
    value : object
        Value in JSON types.
    stated : bool
        Whether the file has the key. Otherwise the value is a default.
    """

    table: str
    name: str
    value: Any
    stated: bool

    def __str__(self) -> str:
        value = self.value
        if isinstance(value, list):
            shown = " to ".join(_short(each) for each in value)
        else:
            shown = _UNSET.get(self.name, "not watched") if value is None else _short(value)
        unit = "" if value is None else _UNITS.get(self.name, "")
        mark = "" if self.stated else "   DEFAULT: the file has no such key"
        return f"  {self.name}: {f'{shown} {unit}'.rstrip()}{mark}"


@dataclass(frozen=True, slots=True)
class InForce:
    """All settings, and the range of the trajectory.

    Parameters
    ----------
    settings : tuple of Setting
    lowest, highest : float
        Range of the trajectory [rad].
    fastest : float
        Largest velocity of the trajectory [rad/s].
    """

    settings: tuple[Setting, ...]
    lowest: float
    highest: float
    fastest: float

    def text(self) -> str:
        """Return one line for each setting, by table."""
        lines = []
        for table in dict.fromkeys(each.table for each in self.settings):
            lines.append(f"{table}:")
            lines += [str(each) for each in self.settings if each.table == table]
            if table == "trajectory":
                low, high = math.degrees(self.lowest), math.degrees(self.highest)
                lines.append(
                    f"  goes from {self.lowest:.4f} to {self.highest:.4f} rad ({low:.1f}° to {high:.1f}°), "
                    f"at up to {self.fastest:.3f} rad/s"
                )
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """Return the values by table, and the names of the defaults."""
        tables: dict[str, Any] = {}
        for each in self.settings:
            value = each.value
            infinite = isinstance(value, float) and not math.isfinite(value)
            tables.setdefault(each.table, {})[each.name] = None if infinite else value
        motion = {"lowest": self.lowest, "highest": self.highest, "fastest": self.fastest}
        defaults = [f"{each.table}.{each.name}" for each in self.settings if not each.stated]
        return {**tables, "motion": motion, "defaults": defaults}


def in_force(joint_file: Path, bench: Bench) -> InForce:
    """Return the settings of a joint file.

    Parameters
    ----------
    joint_file : Path
    bench : Bench
        Bench that was read from this file.

    Raises
    ------
    InputError
        The file cannot be read.
    """
    from jointid.joint.joint_file import read_document

    document = read_document(joint_file)
    session = document["session"]
    own, joint = session.get("limits", {}), document.get("limits", {})
    trajectory = session.get("trajectory", {})
    period = bench.options.period
    angle, speed, _ = bench.trajectory.sample(np.arange(0.0, bench.trajectory.duration, period))
    law = session.get("controller", {}).get("law", "adaptive_robust")
    return InForce(
        (
            *_limits(
                bench.limits, {**({"torque": 0} if "current" in joint else {}), **joint, **own}
            ),
            *_trajectory(trajectory, bench.trajectory.duration),
            Setting("controller", "law", law, "law" in session.get("controller", {})),
            *(
                Setting("controller", name, value, name in session.get("controller", {}))
                for name, value in bench.controller.asdict().items()
                if name in _GAINS
            ),
            *(
                Setting("session", name, getattr(bench.options, name), name in session)
                for name in _SESSION
            ),
            *_drive(bench.drive, session.get("drive", {})),
        ),
        *(float(each) for each in (angle.min(), angle.max(), np.abs(speed).max())),
    )


def _limits(limits: SessionLimits, stated: Mapping[str, Any]) -> Iterator[Setting]:
    followed = {
        "measured_torque": limits.largest_measured,
        "torque_difference": limits.largest_difference,
    }
    for field in fields(limits):
        value = followed.get(field.name, getattr(limits, field.name))
        yield Setting("limits", field.name, _plain(value), field.name in stated)


def _trajectory(stated: Mapping[str, Any], duration: float) -> Iterator[Setting]:
    from jointid.simulation.trajectory import Trajectory

    if "file" in stated:
        yield Setting("trajectory", "file", stated["file"], stated=True)
        yield Setting("trajectory", "duration", duration, stated=True)
        return
    form = stated.get("form", "thesis")
    yield Setting("trajectory", "form", form, "form" in stated)
    for name, parameter in inspect.signature(getattr(Trajectory, form)).parameters.items():
        if name in stated or parameter.default not in (parameter.empty, None):
            value = stated.get(name, parameter.default)
            yield Setting("trajectory", name, _plain(value), name in stated)


def _drive(options: Any, stated: Mapping[str, Any]) -> Iterator[Setting]:
    """Yield the drive type's options that are plain values, without None, where another key decides."""
    if not is_dataclass(options):
        return
    for field in fields(options):
        value = getattr(options, field.name)
        if value is None:  # a selected node has its own property
            value = getattr(options, f"{field.name}_node", None)
        if isinstance(value, bool | int | float | str) and field.name != "bitrate":
            yield Setting("drive", field.name, value, field.name in stated)


def _plain(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _short(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
