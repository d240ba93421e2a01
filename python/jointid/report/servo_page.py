"""The report of a servo as one HTML page that needs no other file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from jointid.base.advice import Action
from jointid.base.argument_checks import require_page
from jointid.base.files import write_whole
from jointid.base.html import Html, element, page, table
from jointid.report.answering import verdict_lines
from jointid.report.drawing.marks import Line, Panel
from jointid.report.figure import captioned
from jointid.report.style import STYLE, WIDE
from jointid.servo.estimate import ServoEstimate
from jointid.servo.rolling_out import Rollout, RunRollout
from jointid.servo.tables import head, rows

_MOST = 40  # runs with a picture


def servo_report(
    estimate: ServoEstimate,
    action: Callable[[Action], str] = str,
    rollout: Rollout | None = None,
) -> str:
    """The report as one HTML page: parameters, findings, and each run's closed loop beside its log.

    Parameters
    ----------
    estimate : ServoEstimate
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    rollout : Rollout, optional
        Of runs. Default: no such section.
    """
    title = f"{estimate.joint.name or 'servo'}: motor and friction, identified by jointid"
    body: list[Html | str] = [
        element("h1", title),
        *verdict_lines(estimate.verdict, estimate.findings, action=action),
        element(
            "p",
            f"From {len(estimate.runs)} runs without a torque signal, by integrals of the torque balance over "
            f"{estimate.windows} windows; errors by a bootstrap over the runs.",
        ),
        element("div", table([list(row) for row in rows(estimate)], head=[*head()]), class_="wide"),
        element(
            "p",
            f"The model leaves {1e3 * estimate.rms:.3g} mN·m, {100.0 * estimate.relative_residual:.1f} % of the "
            "load's torque.",
        ),
        element("h2", "Findings", id="findings"),
        _findings(estimate, action),
    ]
    if rollout is not None:
        body += _rollouts(rollout)
    return page(title, f"{STYLE}{WIDE}", *body)


def save_servo_report(
    estimate: ServoEstimate,
    path: str | Path,
    rollout: Rollout | None = None,
    action: Callable[[Action], str] = str,
) -> Path:
    """Write the report, whole or not at all; see `save_report`."""
    target = require_page("path", path)
    write_whole(target, servo_report(estimate, action, rollout).encode())
    return target


def _findings(estimate: ServoEstimate, action: Callable[[Action], str]) -> Html:
    if not estimate.findings:
        return element("p", "None.")
    items = [
        element("li", element("b", found.code), f": {found.worded(action)}", class_=found.severity)
        for found in estimate.findings
    ]
    return element("ul", *items, class_="findings")


def _rollouts(rollout: Rollout) -> list[Html | str]:
    lines: list[list[Html | str]] = [
        [
            run.name,
            f"{np.degrees(run.error):.2f}",
            f"{np.degrees(run.spread):.2f}",
            "bistable" if run.bistable else "",
        ]
        for run in rollout.runs
    ]
    lines.append(["median", f"{np.degrees(rollout.median):.2f}", "", ""])
    return [
        element("h2", "Closed loop, simulated", id="rollouts"),
        element(
            "p",
            "Each run from its logged initial state; only the wanted position, the supply, and when the motor is "
            "driven are taken from the log.",
        ),
        table(lines, head=["run", "mean error [deg]", "moved by 1 % of torque [deg]", ""]),
        *(
            captioned(f"{run.name}: position as logged (grey) and as simulated.", _panel(run))
            for run in rollout.runs[:_MOST]
        ),
    ]


def _panel(run: RunRollout) -> Panel:
    time = run.time - run.time[0]
    return Panel(
        across="time [s]",
        up="position [deg]",
        marks=(
            Line(label="logged", across=time, up=np.degrees(run.measured), look="measured"),
            Line(label="simulated", across=time, up=np.degrees(run.position)),
        ),
    )
