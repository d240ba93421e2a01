"""The report of a whole robot as one HTML page that needs no other file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from jointid.base.advice import Action
from jointid.base.argument_checks import require_path
from jointid.base.files import write_whole
from jointid.base.html import Html, element, page, table
from jointid.estimate.window_views import window_centres, with_gaps
from jointid.report.drawing.marks import Line, Mark, Panel, Points
from jointid.report.figure import captioned
from jointid.report.joints_page import slug
from jointid.report.style import STYLE, WIDE
from jointid.robot.comparison_result import RobotComparison
from jointid.robot.result import RobotEstimate, RobotJoint
from jointid.robot.tables import base_rows, head, quality, rows


def robot_report(
    estimate: RobotEstimate,
    action: Callable[[Action], str] = str,
    comparison: RobotComparison | None = None,
) -> str:
    """The report as one HTML page: the table of the joints, the findings, and two pictures a joint.

    Parameters
    ----------
    estimate : RobotEstimate
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    comparison : RobotComparison, optional
        That the estimate comes from.
    """
    title = f"{estimate.robot.name or 'robot'}: friction of {len(estimate.joints)} joints, identified by jointid"
    body: list[Html | str] = [
        element("h1", title),
        element(
            "p",
            "All joints together, by integrals of the torque balance over windows, without accelerations; value ± "
            "standard error.",
        ),
        element(
            "div",
            table([list(row) for row in rows(estimate)], head=head(estimate), class_="joints"),
            class_="wide",
        ),
        table([list(pair) for pair in quality(estimate)], class_="facts"),
        element("h2", "Findings", id="findings"),
        _findings(estimate, action),
    ]
    if comparison is not None:
        body += _comparison(comparison)
    if estimate.base_parameters:
        body += [
            element("h2", "Base parameters", id="base-parameters"),
            element(
                "p",
                "Combinations of the links' inertial parameters that motion shows, about each joint's own frame.",
            ),
            element(
                "div",
                table(
                    [list(row) for row in base_rows(estimate)],
                    head=["value", "± std. error", "unit", "combination"],
                ),
                class_="wide",
            ),
        ]
    for number, joint in enumerate(estimate.joints.values()):
        body += _section(estimate, joint, number)
    return page(title, f"{STYLE}{WIDE}", *body)


def save_robot_report(
    estimate: RobotEstimate,
    path: str | Path,
    action: Callable[[Action], str] = str,
    comparison: RobotComparison | None = None,
) -> Path:
    """Write the report, whole or not at all; see `save_report`."""
    target = require_path("path", path)
    write_whole(target, robot_report(estimate, action, comparison).encode())
    return target


def _comparison(found: RobotComparison) -> list[Html | str]:
    """What was compared, and how well each candidate predicts."""
    first = ["inertia", "model", "parameters", "held-out residual", "± std. error", "remark"]
    tables = (
        table([list(row) for row in found.cells()], head=first),
        table([list(row) for row in found.joint_cells()], head=["", *found.models]),
    )
    return [
        element("h2", "Compared on held-out torque", id="comparison"),
        element("p", found.setting()),
        *(element("div", each, class_="wide") for each in tables),
        element("p", found.reason),
    ]


def _findings(estimate: RobotEstimate, action: Callable[[Action], str]) -> Html:
    if not estimate.findings:
        return element("p", "None.")
    items = [
        element("li", element("b", found.code), f": {found.worded(action)}", class_=found.severity)
        for found in estimate.findings
    ]
    return element("ul", *items, class_="findings")


def _section(estimate: RobotEstimate, joint: RobotJoint, number: int) -> list[Html | str]:
    return [
        element("h2", joint.name, id=f"joint-{slug(joint.name)}"),
        captioned(
            "Friction: a grey point is the torque over one window less all but this joint's friction, the line is what "
            "was identified, with the other joints at rest.",
            _friction(estimate, joint, number),
        ),
        captioned(
            "Above: measured and fitted mean torque over each window. Below: the residual.",
            *_windows(joint),
        ),
    ]


def _friction(estimate: RobotEstimate, joint: RobotJoint, number: int) -> Panel:
    windows = joint.windows
    marks: list[Mark] = [
        Points(look="measured", label="windows", across=windows.velocity, up=windows.friction)
    ]
    peak = float(np.abs(windows.velocity).max(initial=0.0))
    for sign in (-1.0, 1.0):
        speeds = sign * np.linspace(1e-3, 1.0, 100) * peak
        p = joint.parameters
        values = sign * p["coulomb"].value + p["viscous"].value * speeds
        if "static" in p:
            decay = np.exp(-p["stribeck"].value * speeds**2)
            values = values + sign * p["static"].value * decay
        if "viscous_difference" in p:
            values = values + p["viscous_difference"].value * np.abs(speeds)
        marks.append(Line(label="identified" if sign > 0.0 else "", across=speeds, up=values))
    slides = estimate.robot.tree.prismatic[number]
    return Panel(
        across=f"velocity [{'m/s' if slides else 'rad/s'}]",
        up=f"friction [{'N' if slides else 'N·m'}]",
        marks=tuple(marks),
    )


def _windows(joint: RobotJoint) -> tuple[Panel, Panel]:
    windows = joint.windows
    centre = window_centres(windows)
    order = np.argsort(centre, kind="stable")
    unit = joint.parameters["coulomb"].unit
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
    return means, below
