"""Pictures of a robot's joints: the friction of each joint, and its windows over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from jointid.estimate.window_views import window_centres, with_gaps
from jointid.panels.marks import Line, Mark, Panel, Picture, Points
from jointid.robot.result.friction import joint_friction

if TYPE_CHECKING:
    from jointid.robot.result.result import RobotEstimate


def friction_of_joint(estimate: RobotEstimate, name: str) -> Picture:
    """Return friction over velocity of a robot's joint: measured windows and identified curve."""
    joint = estimate.joints[name]
    windows = joint.windows
    marks: list[Mark] = [
        Points(look="measured", label="windows", across=windows.velocity, up=windows.friction)
    ]
    peak = float(np.abs(windows.velocity).max(initial=0.0))
    for sign in (-1.0, 1.0):
        speeds = sign * np.linspace(1e-3, 1.0, 100) * peak
        values = joint_friction(joint, speeds)
        marks.append(Line(label="identified" if sign > 0.0 else "", across=speeds, up=values))
    unit = _unit(estimate, name)
    panel = Panel(
        across=f"velocity [{'m/s' if unit == 'N' else 'rad/s'}]",
        up=f"friction [{unit}]",
        marks=tuple(marks),
    )
    return Picture(
        caption="Grey points: torque of each window minus all terms except this joint's speed-dependent friction. "
        "Line: identified friction, with the other joints at rest.",
        panels=(panel,),
        title=name,
    )


def windows_of_joint(estimate: RobotEstimate, name: str) -> Picture:
    """Return measured and fitted mean torque of a robot's joint over time, above the residual."""
    joint = estimate.joints[name]
    windows = joint.windows
    centre = window_centres(windows)
    order = np.argsort(centre, kind="stable")
    unit = _unit(estimate, name)
    time, measured, fitted, residual = with_gaps(
        centre[order],
        *(
            (values / windows.duration)[order]
            for values in (windows.measured, windows.fitted, windows.residual)
        ),
    )
    means = Panel(
        across="time [s]",
        up=f"torque [{unit}]",
        marks=(
            Points(look="measured", label="measured", across=time, up=measured),
            Line(label="fitted", across=time, up=fitted),
        ),
    )
    below = Panel(
        across="time [s]",
        up=f"residual [{unit}]",
        height=110,
        marks=(Line(look="second", across=time, up=residual),),
    )
    return Picture(
        caption="Above: measured and fitted mean torque of each window. Below: residual.",
        panels=(means, below),
        title=name,
    )


def _unit(estimate: RobotEstimate, name: str) -> str:
    """Return the unit of a joint's torque or force."""
    return "N" if estimate.robot.tree.prismatic[list(estimate.joints).index(name)] else "N·m"
