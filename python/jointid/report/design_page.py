"""The report of a designed motion: how well it will identify the joint, then where it goes within its limits."""

from __future__ import annotations

import math

import numpy as np

from jointid.base.html import Html, element, page, table
from jointid.excitation.assumptions import assumed
from jointid.excitation.design import Design
from jointid.excitation.design_fields import COMPLETE
from jointid.excitation.tables import head, improved, judged_with, limits_used, rows, share_text
from jointid.joint.units import velocity_label
from jointid.report.answering import answer
from jointid.report.drawing.marks import Bars, Level, Line, Panel
from jointid.report.figure import captioned
from jointid.report.style import STYLE

_SAMPLES = 6001
_BINS = 40


def design_report(design: Design) -> str:
    """The report as one HTML page that needs no other file.

    Parameters
    ----------
    design : Design
    """
    title = f"{design.joint.name or 'joint'}: motion of {design.duration:g} s designed by jointid"
    return page(
        title,
        STYLE,
        element("h1", title),
        *_answer(design),
        element("h2", "Expected errors", id="errors"),
        table([list(row) for row in rows(design)], head=head(design), class_="errors"),
        element("p", "Expected standard errors of one recording of this motion."),
        element("h2", "Limits", id="limits"),
        element("ul", *(element("li", line) for line in limits_used(design))),
        element("h2", "Motion", id="motion"),
        *_pictures(design),
        element("h2", "What it assumes", id="assumptions"),
        element(
            "ul",
            *(
                element("li", line)
                for line in (*improved(design), assumed(design), judged_with(design))
            ),
        ),
    )


def _answer(design: Design) -> list[Html]:
    """Whether the motion may be used, and how well the worst known parameter will be known."""
    if design.status != COMPLETE:
        lines = [answer(f"Not usable: {design.status}.", "not usable")]
        return [*lines, element("p", design.reason)] if design.reason else lines
    errors = {name: each.worst for name, each in design.parameters.items()}
    name = design.weakest
    if name not in errors or not math.isfinite(errors[name]):
        undetermined = ", ".join(each for each, worst in errors.items() if not math.isfinite(worst))
        said = f"Usable with care: {undetermined or 'a parameter'} will not be determined."
        return [answer(said, "usable with care")]
    limited = f" {design.limited_by.capitalize()}." if design.limited_by else ""
    return [
        answer(
            f"Usable: no parameter's expected error is above {share_text(errors[name])}, and all limits are kept.",
            "usable",
        ),
        element(
            "p",
            f"One standard error, the worst of {design.joints} joints drawn from the prior. The weakest is "
            f"{name}.{limited}",
        ),
    ]


def _pictures(design: Design) -> list[Html]:
    time = np.linspace(0.0, design.duration, _SAMPLES)
    position, velocity, _ = design.trajectory.sample(time)
    slides = design.joint.kind == "prismatic"
    low, high = design.limits.position
    largest = design.limits.velocity
    over_time = Panel(
        across="time [s]",
        up=f"position [{'m' if slides else 'rad'}]",
        height=150,
        marks=(
            Line(look="second", label="reference", across=time, up=position),
            Level(label="limit", up=low),
            Level(up=high),
        ),
    )
    speeds = Panel(
        across="time [s]",
        up=velocity_label(design.joint.kind),
        height=150,
        marks=(
            Line(look="second", across=time, up=velocity),
            Level(up=-largest),
            Level(up=largest),
        ),
    )
    parts = [
        captioned(
            "Position and velocity of the reference, and their limits; the list above has the values that joints "
            "reach.",
            over_time,
            speeds,
        )
    ]
    peak = float(np.abs(velocity).max())
    if peak > 0.0:
        counts, edges = np.histogram(velocity, bins=np.linspace(-peak, peak, _BINS + 1))
        sampled = Panel(
            across=velocity_label(design.joint.kind),
            up="share of the time [%]",
            height=130,
            marks=(Bars(look="second", edges=edges, up=100.0 * counts / len(velocity)),),
        )
        parts.append(
            captioned(
                "Where friction is sampled: how long the joint moves at each velocity.", sampled
            )
        )
    return parts
