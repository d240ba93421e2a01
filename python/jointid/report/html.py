"""One self-contained HTML page about an estimate, with its pictures inside."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from jointid.base.advice import Action
from jointid.base.argument_checks import require_path
from jointid.base.files import write_whole
from jointid.base.html import Html, element, page
from jointid.estimate.estimate import Estimate
from jointid.estimate.html_tables import (
    html_correlation,
    html_findings,
    html_quality,
    html_shifts,
    html_table,
)
from jointid.estimate.tables import shown_name
from jointid.identification.warnings.registry import finding_types
from jointid.report.estimate_pictures import picture_sections
from jointid.report.style import STYLE

_REASONS = 3  # those that matter most; the findings have all


def html_report(estimate: Estimate, action: Callable[[Action], str] = str) -> str:
    """The report as one HTML page that needs no other file.

    Parameters
    ----------
    estimate : Estimate
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    """
    title = f"{estimate.joint.name or 'joint'}: friction identified by jointid"
    return page(
        title,
        STYLE,
        element("h1", title),
        *verdict_lines(estimate),
        *sections(estimate, action),
        footer(estimate),
    )


def verdict_lines(estimate: Estimate) -> list[Html]:
    """Whether the values may be used, for what, and what speaks against it."""
    verdict = estimate.verdict
    level = verdict.level.replace(" ", "-")
    words = [
        element("li", element("b", f"{purpose}: {use.level}"), *_named(use.parameters))
        for purpose, use in verdict.uses.items()
    ]
    lines = [
        element("p", element("b", f"{verdict.level.capitalize()}."), class_=f"verdict {level}"),
        element("ul", *words, class_="uses"),
    ]
    if verdict.reasons:
        shown = [element("li", reason) for reason in verdict.reasons[:_REASONS]]
        more = len(verdict.reasons) - len(shown)
        shown += [element("li", f"and {more} more, below")] if more else []
        lines += [element("p", "Because:"), element("ul", *shown)]
    return lines


def _named(parameters: tuple[str, ...]) -> list[Html | str]:
    return [f": {', '.join(map(shown_name, parameters))}"] if parameters else []


def sections(estimate: Estimate, action: Callable[[Action], str] = str) -> list[Html]:
    """All that is told of an estimate, under its headings."""
    return [
        element("h2", "Parameters"),
        html_table(estimate),
        element("h2", "Warnings"),
        html_findings(estimate, shown_by(estimate), action),
        *picture_sections(estimate),
        element("h2", "Uncertainty"),
        element(
            "p",
            "Change of each value when the windows are halved and doubled; about one standard error is usual.",
        ),
        html_shifts(estimate),
        element(
            "p",
            "Correlation of the estimates (offsets taken at the mean reading); near ±1, two parameters are "
            "indistinguishable.",
        ),
        html_correlation(estimate),
        element("h2", "Fit and search"),
        html_quality(estimate),
    ]


def shown_by(estimate: Estimate) -> dict[str, str]:
    """The picture that shows each kind of finding."""
    types = finding_types().items()
    searched = estimate.convergence is not None
    shown = {code: each.picture for code, each in types if each.picture}
    return {code: name for code, name in shown.items() if searched or name != "convergence"}


def save_report(
    estimate: Estimate, path: str | Path, action: Callable[[Action], str] = str
) -> Path:
    """Write the report, whole or not at all.

    Parameters
    ----------
    estimate : Estimate
    path : path
        Replaced when it exists.
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        The path is no file name, or its folder does not exist.
    OSError
        The file cannot be written; an existing one is untouched.
    """
    target = require_path("path", path)
    write_whole(target, html_report(estimate, action).encode())
    return target


def footer(estimate: Estimate) -> Html:
    """What an estimate was made by and of."""
    settings = estimate.settings
    runs = "; ".join(
        f"{run['name'] or 'recording'} ({run['fingerprint']})" for run in settings["recordings"]
    )
    return element("footer", f"jointid {settings['version']}, seed {settings['seed']}; {runs}")
