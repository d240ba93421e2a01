"""An estimate as text, and as a small HTML table for notebooks."""

from collections.abc import Callable
from html import escape

import numpy as np

from jointid.base.advice import Action
from jointid.estimate.estimate import Estimate
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import number, percent, two_digits

_HEAD = ("parameter", "value", "± std. error", "95 % interval", "unit", "remark")


def remark(p: ParameterEstimate) -> str:
    """What is special about a parameter, in a few words."""
    if not p.vary:
        return "fixed"
    return f"at its {'lower' if p.at_bound == 'min' else 'upper'} bound" if p.at_bound else ""


def rows(estimate: Estimate) -> list[tuple[str, str, str, str, str, str]]:
    """The parameter table, one row a parameter."""
    table = []
    for p in estimate.parameters.values():
        error = interval = ""
        if p.stderr is not None and p.interval is not None:
            share = f" ({percent(p.stderr / abs(p.value))})" if p.value else ""
            error = f"{two_digits(p.stderr)}{share}"
            interval = f"{p.interval[0]:.5g} … {p.interval[1]:.5g}"
        table.append((p.name, number(p.value), error, interval, p.unit, remark(p)))
    return table


def quality(estimate: Estimate) -> list[tuple[str, str]]:
    """How well it fits and what it rests on, as label and text."""
    r = estimate.residuals
    settings = estimate.settings
    unit = (
        "sensor units"
        if settings["residual"] == "sensor"
        else "N"
        if settings["kind"] == "prismatic"
        else "N·m"
    )
    return [
        ("model", _model(estimate)),
        (
            "fit",
            f"R² {r.r_squared:.5f}, relative residual {100.0 * r.relative:.2f} %, rms {r.rms:.3g} {unit}",
        ),
        ("windows", f"{r.windows} of {1e3 * r.window_duration:.4g} ms"),
        (
            "left out",
            f"{100.0 * r.left_out:.1f} % of the intervals; standing still in {100.0 * r.standing:.1f} % of the samples",
        ),
        ("residuals", f"correlation of neighbours {r.autocorrelation:.2f}"),
        (
            "condition",
            f"{estimate.condition:.3g}, weakest direction: {', '.join(estimate.weakest)}",
        ),
        ("correlation", strongest_correlation(estimate)),
        ("search", f"{estimate.message}; {estimate.status} in {estimate.seconds:.2f} s"),
    ]


def _model(estimate: Estimate) -> str:
    settings = estimate.settings
    text = f"{settings['model']}, residual of the {settings['residual']}"
    return f"{text} (without {settings['dropped']})" if settings["dropped"] else text


def strongest_correlation(estimate: Estimate) -> str:
    """The pair of parameters that the recording separates least."""
    size = np.abs(np.triu(estimate.correlation, 1))
    if size.size < 2:
        return "a single free parameter"
    first, second = np.unravel_index(int(np.argmax(size)), size.shape)
    pair = f"{estimate.free[first]} and {estimate.free[second]}"
    return f"strongest {estimate.correlation[first, second]:.2f}, between {pair}"


def text_report(estimate: Estimate, action: Callable[[Action], str] = str) -> str:
    """The estimate as text; a face may bring its own wording of the advice."""
    table = [_HEAD, *rows(estimate)]
    widths = [max(len(row[column]) for row in table) for column in range(len(_HEAD))]
    lines = [f"jointid estimate — {estimate.joint.name or 'joint'}", ""]
    for index, row in enumerate(table):
        cells = [
            cell.rjust(w) if 0 < c < 3 and index else cell.ljust(w)
            for c, (cell, w) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
        if index == 0:
            lines.append("  ".join("-" * w for w in widths))
    lines.append("")
    facts = quality(estimate)
    width = max(len(label) for label, _ in facts)
    lines += [f"{label.ljust(width)}  {text}" for label, text in facts]
    lines.append("")
    if not estimate.warnings:
        lines.append("no warnings")
    lines += [f"warning ({w.code}): {w.worded(action)}" for w in estimate.warnings]
    return "\n".join(lines)


def html_correlation(estimate: Estimate) -> str:
    """The correlation matrix of the free parameters as HTML."""
    head = "".join(f"<th>{escape(name)}</th>" for name in ("", *estimate.free))
    body = ""
    for name, row in zip(estimate.free, estimate.correlation, strict=True):
        body += f"<tr><th>{escape(name)}</th>" + "".join(f"<td>{x:.2f}</td>" for x in row) + "</tr>"
    return f"<table class='numbers'><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def html_shifts(estimate: Estimate) -> str:
    """How each value moves when the windows are halved and doubled, as HTML."""
    head = "<th>parameter</th><th>windows halved</th><th>windows doubled</th><th>std. error</th><th>unit</th>"
    body = ""
    for p in estimate.parameters.values():
        if p.vary:
            shown = (p.shift_halved, p.shift_doubled)
            cells = "".join(f"<td>{'–' if s is None else f'{s:+.3g}'}</td>" for s in shown)
            cells += f"<td>{'–' if p.stderr is None else two_digits(p.stderr)}</td>"
            body += f"<tr><th>{escape(p.name)}</th>{cells}<th>{escape(p.unit)}</th></tr>"
    return f"<table class='numbers'><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def html_table(estimate: Estimate) -> str:
    """The parameter table as HTML."""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in _HEAD)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>"
        for row in rows(estimate)
    )
    return f"<table class='jointid'><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def html_warnings(estimate: Estimate) -> str:
    """The warnings as an HTML list, or a line that says there are none."""
    if not estimate.warnings:
        return "<p>No warnings.</p>"
    items = "".join(
        f"<li><b>{escape(w.code)}</b>: {escape(w.message)}</li>" for w in estimate.warnings
    )
    return f"<ul class='warnings'>{items}</ul>"


def html_summary(estimate: Estimate) -> str:
    """What a notebook shows for an estimate."""
    r = estimate.residuals
    caption = (
        f"R² {r.r_squared:.5f}, relative residual {100.0 * r.relative:.2f} %, {r.windows} windows of "
        f"{1e3 * r.window_duration:.4g} ms"
    )
    title = escape(estimate.joint.name or "joint")
    parts = (html_table(estimate), f"<p>{escape(caption)}</p>", html_warnings(estimate))
    return f"<div><b>jointid estimate — {title}</b>{''.join(parts)}</div>"
