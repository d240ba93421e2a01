"""One self-contained HTML page about an estimate, with its pictures inside."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from jointid.base.advice import Action
from jointid.base.html import Html, element, page
from jointid.estimate.estimate import Estimate
from jointid.estimate.html_tables import (
    html_correlation,
    html_findings,
    html_quality,
    html_shifts,
    html_table,
    html_windows,
)
from jointid.estimate.tables import subject
from jointid.identification.warnings.registry import finding_types
from jointid.recording.recording import Recording
from jointid.report.answering import verdict_lines
from jointid.report.estimate_pictures import convergence_section, picture_sections
from jointid.report.recorded_signals import recorded_sections
from jointid.report.style import STYLE
from jointid.report.values_to_copy import values_sections


def html_report(
    estimate: Estimate,
    action: Callable[[Action], str] = str,
    recordings: Sequence[Recording] = (),
) -> str:
    """The report as one HTML page that needs no other file.

    Parameters
    ----------
    estimate : Estimate
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    recordings : sequence of Recording
        That the estimate was made from, for pictures of their signals. Default: without these.
    """
    title = f"{subject(estimate)}: friction identified by jointid"
    return page(
        title,
        STYLE,
        element("h1", title),
        *verdict_lines(estimate.verdict, estimate.findings, shown_by(estimate), action),
        *sections(estimate, action, recordings),
        footer(estimate),
    )


def sections(
    estimate: Estimate,
    action: Callable[[Action], str] = str,
    recordings: Sequence[Recording] = (),
) -> list[Html]:
    """All that is told of an estimate, under its headings."""
    return [
        element("h2", "Parameters"),
        html_table(estimate),
        element("h2", "Findings", id="findings"),
        html_findings(estimate, shown_by(estimate), action),
        element("h2", "Recording", id="recording"),
        html_windows(estimate),
        *picture_sections(estimate),
        *(recorded_sections(estimate, recordings) if recordings else []),
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
        *convergence_section(estimate),
        *values_sections(estimate),
    ]


def shown_by(estimate: Estimate) -> dict[str, str]:
    """The picture that shows each kind of finding."""
    types = finding_types().items()
    searched = estimate.convergence is not None
    shown = {code: each.picture for code, each in types if each.picture}
    return {code: name for code, name in shown.items() if searched or name != "convergence"}


def footer(estimate: Estimate) -> Html:
    """What an estimate was made by and of."""
    settings = estimate.settings
    runs = "; ".join(
        f"{run['name'] or 'recording'} ({run['fingerprint']})" for run in settings["recordings"]
    )
    return element("footer", f"jointid {settings['version']}, seed {settings['seed']}; {runs}")
