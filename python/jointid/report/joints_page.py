"""The report of several joints as one HTML page that needs no other file."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from jointid.base.advice import Action
from jointid.base.html import Html, element, page
from jointid.estimate.html_tables import html_findings, html_quality
from jointid.estimate.html_tables import html_table as html_parameters
from jointid.joints.html_tables import html_couplings, html_shares, html_table
from jointid.joints.record import JointResult
from jointid.joints.result import JointEstimates
from jointid.report.answering import verdict_lines
from jointid.report.estimate_pictures import friction_picture, windows_picture
from jointid.report.html import shown_by
from jointid.report.style import STYLE, WIDE

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate


def joints_report(result: JointEstimates, action: Callable[[Action], str] = str) -> str:
    """The report as one HTML page: the table, what couples the joints, and a section a joint.

    Parameters
    ----------
    result : JointEstimates
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    """
    title = (
        f"{result.name or 'robot'}: friction of {len(result.results)} joints, identified by jointid"
    )
    body: list[Html | str] = [
        element("h1", title),
        _verdicts(result),
        element("p", "Each joint for itself; value ± standard error."),
        element("div", html_table(result), class_="wide"),
        element("h2", "Between the joints", id="couplings"),
        element(
            "p",
            "How much of what a joint's model leaves unexplained the motion of another joint explains, on blocks of "
            "time that were held out.",
        ),
        html_couplings(result),
    ]
    if any(each.others for each in result.results.values()):
        body.append(element("div", html_shares(result), class_="wide"))
    for each in result.results.values():
        body += _section(each, action)
    return page(title, f"{STYLE}{WIDE}", *body)


def _section(result: JointResult, action: Callable[[Action], str]) -> list[Html | str]:
    heading = element("h2", f"Joint {result.name}", id=f"joint-{slug(result.name)}")
    estimate = result.estimate
    if estimate is None:
        return [heading, element("p", f"This joint failed: {result.error}")]
    return [heading, *_of_estimate(estimate, action)]


def _of_estimate(estimate: Estimate, action: Callable[[Action], str]) -> list[Html | str]:
    pictured = {"friction-map", "windows", "convergence"}
    shown = {code: name for code, name in shown_by(estimate).items() if name not in pictured}
    return [
        *verdict_lines(estimate.verdict, estimate.findings, shown, action),
        element("div", html_parameters(estimate), class_="wide"),
        html_findings(estimate, shown, action),
        friction_picture(estimate),
        windows_picture(estimate),
        element("div", html_quality(estimate), class_="wide"),
    ]


def _verdicts(result: JointEstimates) -> Html:
    """The verdict on each joint, with a link to its section."""
    lines = []
    for name, each in result.results.items():
        said = "failed" if each.estimate is None else str(each.estimate.verdict)
        link = element("a", f"Joint {name}", href=f"#joint-{slug(name)}")
        lines.append(element("li", link, f": {said}"))
    return element("ul", *lines, class_="uses")


def slug(name: str) -> str:
    """A joint's name as part of a link."""
    return "".join(letter if letter.isalnum() else "-" for letter in name)
