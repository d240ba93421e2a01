"""The tables of an estimate as HTML, for notebooks and the report."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from jointid.base.advice import Action
from jointid.base.html import Html, element, table
from jointid.estimate.answers import purposes
from jointid.estimate.derived import DerivedValue, derived_values
from jointid.estimate.findings import Finding
from jointid.estimate.record import EstimateRecord
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.tables import HEAD, quality, recorded, rows, shown_name, subject
from jointid.estimate.verdict import judged
from jointid.estimate.wording import rounded, two_digits


def html_table(estimate: EstimateRecord) -> Html:
    """The parameter table; the digits of a value are those of its standard error."""
    found: list[ParameterEstimate | DerivedValue] = [
        *estimate.parameters.values(),
        *derived_values(estimate).values(),
    ]
    body: list[list[Html | str]] = [
        [row[0], _rounded(p.value, p.stderr) or row[1], *row[2:]]
        for p, row in zip(found, rows(estimate), strict=True)
    ]
    return table(body, head=list(HEAD))


def _rounded(value: float, stderr: float | None) -> str:
    """A value with the digits of its error; nothing without an error."""
    return rounded(value, stderr) if stderr is not None and 0.0 < stderr < math.inf else ""


def html_windows(estimate: EstimateRecord) -> Html:
    """What the estimate was made from."""
    return table([list(pair) for pair in recorded(estimate)], class_="facts")


def html_quality(estimate: EstimateRecord) -> Html:
    """Quality of the fit and what it is based on."""
    return table([list(pair) for pair in quality(estimate)], class_="facts")


def html_correlation(estimate: EstimateRecord) -> Html:
    """The correlation matrix of the free parameters."""
    body: list[list[Html | str]] = [
        [element("th", shown_name(name)), *(f"{x:.2f}" for x in row)]
        for name, row in zip(estimate.free, estimate.correlation, strict=True)
    ]
    return table(body, head=["", *map(shown_name, estimate.free)], class_="numbers")


def html_shifts(estimate: EstimateRecord) -> Html:
    """How each value moves when the windows are halved and doubled."""
    body: list[list[Html | str]] = []
    for p in estimate.parameters.values():
        if p.vary:
            shifts = ("–" if s is None else f"{s:+.3g}" for s in (p.shift_halved, p.shift_doubled))
            error = "–" if p.stderr is None else two_digits(p.stderr)
            body.append([element("th", shown_name(p.name)), *shifts, error, element("th", p.unit)])
    head = ["parameter", "windows halved", "windows doubled", "std. error", "unit"]
    return table(body, head=head, class_="numbers")


def html_findings(
    estimate: EstimateRecord,
    pictures: Mapping[str, str] | None = None,
    action: Callable[[Action], str] = str,
) -> Html:
    """The findings as a list, or a line that says there are none.

    Parameters
    ----------
    estimate : Estimate
    pictures : mapping of str to str, optional
        Code → section of the page that shows it, which the finding then links to. Default: no links.
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    """
    if not estimate.findings:
        return element("p", "No warnings.")
    return element(
        "ul",
        *(_finding(found, pictures or {}, action) for found in estimate.findings),
        class_="findings",
    )


def _finding(found: Finding, pictures: Mapping[str, str], action: Callable[[Action], str]) -> Html:
    parts: list[Html | str] = [
        element("b", found.code),
        f" ({found.severity}): {found.title}",
    ]
    if found.code in pictures:
        parts += [" ", element("a", "picture", href=f"#{pictures[found.code]}")]
    first, *others = [what for what in map(action, found.advice) if what] or [""]
    if first:
        parts += [element("br"), f"do: {first}"]
    rest = "; ".join([found.details] * bool(found.details) + [f"or {each}" for each in others])
    if rest:
        parts += [element("br"), element("small", rest)]
    return element("li", *parts, class_=found.severity)


def html_summary(estimate: EstimateRecord) -> Html:
    """What a notebook shows for an estimate."""
    r = estimate.residuals
    caption = (
        f"R² {r.r_squared:.5f}, relative residual {100.0 * r.relative:.2f} %, {r.windows} windows of "
        f"{1e3 * r.window_duration:.4g} ms"
    )
    if estimate.selection is not None:
        caption += f"; chosen: {estimate.selection.sentence}"
    verdict = judged(estimate)
    lines = [f"{subject(estimate)}: {verdict.level}", *purposes(verdict)]
    return element(
        "div",
        element("p", element("b", lines[0]), *(f"; {each.strip()}" for each in lines[1:])),
        html_table(estimate),
        element("p", caption),
        html_findings(estimate),
    )
