"""One self-contained HTML page about an estimate, with its pictures inside."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from jointid import plot
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
from jointid.identification.warnings.registry import finding_types

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.15rem; margin-top: 2rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .8rem; border-bottom: 1px solid #ddd; text-align: left; }
td:nth-child(2), td:nth-child(3) { text-align: right; }
table.facts td:nth-child(2) { text-align: left; }
table.numbers th { text-align: left; font-weight: normal; } table.numbers td { text-align: right; }
figure { margin: 1rem 0; } img { max-width: 100%; height: auto; }
figcaption { color: #555; font-size: .9rem; }
ul.findings li { margin-bottom: .4rem; } li.blocking b { color: #b00; } li.info { color: #555; }
footer { margin-top: 3rem; color: #777; font-size: .85rem; }
"""


def html_report(estimate: Estimate, action: Callable[[Action], str] = str) -> str:
    """The report as one HTML page that needs no other file.

    Parameters
    ----------
    estimate : Estimate
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    """
    title = f"{estimate.joint.name or 'joint'}: friction identified by jointid"
    body = [
        element("h1", title),
        element("h2", "Parameters"),
        html_table(estimate),
        element("h2", "Warnings"),
        html_findings(estimate, shown_by(estimate), action),
        *_pictures(estimate),
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
        _footer(estimate),
    ]
    return page(title, STYLE, *body)


def shown_by(estimate: Estimate) -> dict[str, str]:
    """The picture that shows each kind of finding."""
    types = finding_types().items()
    searched = estimate.convergence is not None
    shown = {code: each.picture for code, each in types if each.picture}
    return {code: name for code, name in shown.items() if searched or name != "convergence"}


def _pictures(estimate: Estimate) -> list[Html]:
    parts = [
        element("h2", "Friction map", id="friction-map"),
        friction_picture(estimate),
        element("h2", "Windows", id="windows"),
        windows_picture(estimate),
    ]
    if estimate.convergence is not None:
        parts += [
            element("h2", "Convergence", id="convergence"),
            picture(
                "The genetic search, generation by generation; dashed: the penalty after the local polish.",
                lambda axes: plot.convergence(estimate, axes[0]),
            ),
        ]
    return parts


def friction_picture(estimate: Estimate) -> Html:
    """The friction map, with what it shows."""
    return picture(
        "Friction map: a grey point is the friction that the recording shows over one window, the line is the "
        "identified model with its 95 % band.",
        lambda axes: plot.friction_map(None, estimate, axes[0]),
    )


def windows_picture(estimate: Estimate) -> Html:
    """Measured and fitted windows above their residuals."""
    return picture(
        "Above: measured and fitted mean over each window. Below: the residual. Windows "
        "in which the joint stands still are left out.",
        lambda axes: (
            plot.window_means(estimate, axes[0]),
            plot.residuals(estimate, axes[1]),
        ),
        rows=2,
    )


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


def picture(caption: str, draw: Callable[[list[Axes]], object], rows: int = 1) -> Html:
    """A picture of one or several axes below each other, with its caption."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with plot.style():
        figure = Figure(figsize=(8.0, 3.6 + 1.8 * (rows - 1)))
        FigureCanvasAgg(figure)  # no pyplot: nothing global, no window, no display needed
        ratios = [2.0] + [1.0] * (rows - 1)
        axes = figure.subplots(rows, 1, sharex=True, squeeze=False, height_ratios=ratios)[:, 0]
        draw(list(axes))
        for upper in axes[:-1]:
            upper.set_xlabel("")
        image = _png(figure)
    picture = element("img", alt=caption, src=f"data:image/png;base64,{image}")
    return element("figure", picture, element("figcaption", caption))


def _png(figure: Figure) -> str:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=150)
    return base64.b64encode(buffer.getvalue()).decode("ascii")


def _footer(estimate: Estimate) -> Html:
    settings = estimate.settings
    runs = "; ".join(
        f"{run['name'] or 'recording'} ({run['fingerprint']})" for run in settings["recordings"]
    )
    return element("footer", f"jointid {settings['version']}, seed {settings['seed']}; {runs}")
