"""The report of a whole robot as one HTML page that needs no other file."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from jointid.base.advice import Action
from jointid.base.html import Html, element, page, table
from jointid.estimate.window_views import window_centres, with_gaps
from jointid.report.answering import answer, verdict_lines
from jointid.report.drawing.marks import Line, Mark, Panel, Points
from jointid.report.figure import captioned
from jointid.report.joints_page import slug
from jointid.report.rows import NamedRow, rows_panel
from jointid.report.style import STYLE, WIDE
from jointid.robot.result.comparison_result import RobotComparison
from jointid.robot.result.friction import joint_friction
from jointid.robot.result.record import RobotJoint
from jointid.robot.result.result import RobotEstimate
from jointid.robot.result.tables import base_rows, head, quality, rows

_DRAWN = 20  # candidates; the table has all


def robot_report(estimate: RobotEstimate, action: Callable[[Action], str] = str) -> str:
    """The report as one HTML page: verdict, the table of the joints, the findings, and two pictures a joint.

    Parameters
    ----------
    estimate : RobotEstimate
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    """
    title = f"{estimate.robot.name or 'robot'}: friction of {len(estimate.joints)} joints, identified by jointid"
    body = [element("h1", title), *_of_estimate(estimate, action)]
    return page(title, f"{STYLE}{WIDE}", *body)


def robot_comparison_report(
    comparison: RobotComparison, action: Callable[[Action], str] = str
) -> str:
    """The report as one HTML page: the winner and why, all candidates, and what was identified with the winner.

    Parameters
    ----------
    comparison : RobotComparison
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    """
    estimate = comparison.estimate
    title = f"{estimate.robot.name or 'robot'}: {len(comparison.rows)} models compared by jointid"
    body = [
        element("h1", title),
        answer(f"Use {comparison.winner.name}."),
        element("p", comparison.reason),
        *_comparison(comparison),
        element("h2", "Identified with it", id="identified"),
        *_of_estimate(estimate, action),
    ]
    return page(title, f"{STYLE}{WIDE}", *body)


def _of_estimate(estimate: RobotEstimate, action: Callable[[Action], str]) -> list[Html | str]:
    body: list[Html | str] = [
        *verdict_lines(estimate.verdict, estimate.findings, action=action),
        element("h2", "Joints", id="joints"),
        element(
            "div",
            table([list(row) for row in rows(estimate)], head=head(estimate), class_="joints"),
            class_="wide",
        ),
        table([list(pair) for pair in quality(estimate)], class_="facts"),
        element("h2", "Findings", id="findings"),
        _findings(estimate, action),
    ]
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
    return [*body, _footer(estimate)]


def _footer(estimate: RobotEstimate) -> Html:
    settings = estimate.settings
    runs = "; ".join(str(each or "recording") for each in settings.get("recordings", ()))
    return element(
        "footer",
        "All joints together, by integrals of the torque balance over windows, without accelerations; value ± "
        f"standard error. jointid {settings.get('version', '')}; {runs}",
    )


def _comparison(found: RobotComparison) -> list[Html | str]:
    """What was compared, and how well each candidate predicts."""
    rows = [
        NamedRow(
            name=row.name,
            value=100.0 * row.score,
            error=100.0 * row.stderr,
            single=[100.0 * score for score in row.fold_scores],
            chosen=row is found.winner or row == found.winner,
        )
        for row in found.rows[:_DRAWN]
    ]
    first = ["inertia", "model", "parameters", "held-out residual", "± std. error", "remark"]
    tables = (
        table([list(row) for row in found.cells()], head=first),
        table([list(row) for row in found.joint_cells()], head=["", *found.models]),
    )
    return [
        element("h2", "How well each candidate predicts", id="comparison"),
        captioned(
            "Relative residual of torque that the candidate was not fitted to, mean over joints: smaller is better. "
            "A grey point is one part that was held out, the stroke is the mean with its standard error.",
            rows_panel(
                rows,
                "held-out residual [%]",
                "candidate",
                ("one part", "mean", "mean of the chosen one"),
            ),
        ),
        *(element("div", each, class_="wide") for each in tables),
        element("p", found.setting()),
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
        values = joint_friction(joint, speeds)
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
    unit = joint.parameters["torque_offset"].unit
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
