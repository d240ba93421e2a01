"""An estimate as text."""

from collections.abc import Callable

import numpy as np

from jointid.base.advice import Action
from jointid.base.error_text import printable
from jointid.estimate.derived import DerivedValue, derived_values
from jointid.estimate.record import EstimateRecord
from jointid.estimate.settings import model_description, residual_unit
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.verdict import judged
from jointid.estimate.window_views import fitted_signal
from jointid.estimate.wording import number, percent, rounded, two_digits
from jointid.joint.units import velocity_label
from jointid.recording.order_statistics import distinct

HEAD = ("parameter", "value", "± std. error", "± systematic", "95 % interval", "unit", "remark")
Row = tuple[str, str, str, str, str, str, str]


def subject(estimate: EstimateRecord) -> str:
    """Return the joint's name for a title, with the number of recordings if there are several."""
    runs = estimate.settings["recordings"]
    name = estimate.joint.name or "joint"
    if len(runs) == 1:
        return name
    if name == runs[0]["name"]:  # the joint has no name
        return f"{name} and {len(runs) - 1} more recording{'s' * (len(runs) > 2)}"
    return f"{name}, {len(runs)} recordings"


def remark(p: ParameterEstimate) -> str:
    """Return a remark if a parameter is fixed or on a bound."""
    if not p.vary:
        return "fixed"
    return f"at its {'lower' if p.at_bound == 'min' else 'upper'} bound" if p.at_bound else ""


def shown_name(name: str) -> str:
    """Return the readable name of a parameter or derived quantity."""
    if name.startswith("static"):
        return f"{name} (above Coulomb)"
    if name == "stribeck_velocity":
        return "Stribeck velocity"
    base, _, direction = name.partition("_")
    if base.startswith("breakaway"):
        shown = base.replace("breakaway", "breakaway friction")
        return f"{shown}, {direction}" if direction else shown
    return name


def rows(estimate: EstimateRecord) -> list[Row]:
    """Return the table: one row per parameter, then one per derived quantity."""
    table = [_row(p, remark(p)) for p in estimate.parameters.values()]
    return table + [_row(each, f"= {each.formula}") for each in derived_values(estimate).values()]


def _row(p: ParameterEstimate | DerivedValue, text: str) -> Row:
    error = interval = ""
    if p.stderr is not None and p.interval is not None:
        share = (
            f" ({percent(p.stderr / abs(p.value))})" if p.value and np.isfinite(p.stderr) else ""
        )
        error = f"{two_digits(p.stderr)}{share}"
        interval = f"{p.interval[0]:.5g} … {p.interval[1]:.5g}"
    value = p.shown_value if isinstance(p, ParameterEstimate) else p.value
    return shown_name(p.name), number(value), error, systematic(p), interval, p.unit, text


def systematic(p: ParameterEstimate | DerivedValue) -> str:
    """Return the total of the systematic parts and the name of the largest, e.g. "1.3 (given)"."""
    if p.largest_part is None:
        return ""
    return f"{two_digits(p.systematic_total)} ({p.largest_part.replace('_', ' ')})"


def quality(estimate: EstimateRecord) -> list[tuple[str, str]]:
    """Return the quality of the fit and its basis, as label and text."""
    r = estimate.residuals
    unit = residual_unit(estimate.settings)
    tolerances = estimate.joint.tolerances.given.items()
    stated = ", ".join(f"{name} ± {value}" for name, value in tolerances)
    return [
        ("model", model_description(estimate.settings)),
        *(
            [("given", f"{stated}; the intervals are valid if these facts are right")]
            * bool(stated)
        ),
        *([("chosen", estimate.selection.sentence)] if estimate.selection else []),
        (
            "fit",
            f"R² {r.r_squared:.5f}, relative residual {100.0 * r.relative:.2f} %, rms {r.rms:.3g} {unit}",
        ),
        ("windows", f"{r.windows} of {1e3 * r.window_duration:.4g} ms"),
        (
            "left out",
            f"{100.0 * r.left_out:.1f} % of the intervals; the joint stands still in {100.0 * r.standing:.1f} % of the "
            "samples",
        ),
        *_refinements(estimate),
        ("residuals", f"autocorrelation of neighbouring windows {r.autocorrelation:.2f}"),
        (
            "condition",
            f"{estimate.condition:.3g}, weakest direction: {', '.join(estimate.weakest)}",
        ),
        ("correlation", strongest_correlation(estimate)),
        *([] if estimate.cross_check is None else [("cross-check", second_look(estimate))]),
        ("search", f"{estimate.message}; {estimate.status} in {estimate.seconds:.2f} s"),
    ]


def second_look(estimate: EstimateRecord) -> str:
    """Return one line with the values of the cross-check, or the reason why there are none."""
    check = estimate.cross_check
    if check is None or check.reason:
        return f"none: {check.reason}" if check else "none"
    values = [f"{name} {rounded(each.value, each.error)}" for name, each in check.values.items()]
    contradicted = ", ".join(check.contradicted)
    verdict = f"disagrees in {contradicted}" if contradicted else "agrees"
    return f"plain least squares {verdict}: {', '.join(values)}"


def recorded(estimate: EstimateRecord) -> list[tuple[str, str]]:
    """Return the data of the estimate as label and text: recordings, and the ranges of the windows."""
    windows, r = estimate.windows, estimate.residuals
    kind = estimate.settings["kind"]
    runs = estimate.settings["recordings"]
    named = "; ".join(f"{run['name'] or 'recording'} ({run['fingerprint']})" for run in runs)
    signal, unit = fitted_signal(estimate)
    lines = [("recordings" if len(runs) > 1 else "recording", named), ("samples", str(r.samples))]
    if windows.start.size:
        spans = [
            float(np.ptp([windows.start[mine].min(), windows.stop[mine].max()]))
            for mine in (windows.recording == run for run in distinct(windows.recording))
        ]
        mean = windows.measured / windows.duration
        speed = velocity_label(kind).partition("[")[2].rstrip("]")
        lines += [
            ("time", f"{sum(spans):.4g} s from the first to the last window"),
            ("velocity", f"{windows.velocity.min():.3g} to {windows.velocity.max():.3g} {speed}"),
            (signal, f"{mean.min():.4g} to {mean.max():.4g} {unit}, means over windows"),
        ]
    return [*lines, ("standing still", f"{percent(r.standing)} of the samples")]


def _refinements(estimate: EstimateRecord) -> list[tuple[str, str]]:
    """Return the corrections of the data before the search, as label and text."""
    lines = []
    if estimate.delays:
        each = [delay.shown for delay in estimate.delays.values()]
        lines.append(("delays", f"against the position: {', '.join(each)}"))
    slow = estimate.slow_motion
    if slow is not None and slow.applied:
        prismatic = estimate.settings["kind"] == "prismatic"
        length, torque = ("m", "N") if prismatic else ("rad", "N·m")
        lines.append(
            (
                "slow motion",
                f"{percent(slow.share)} of the motion, below {slow.speed:.3g} {length}/s, is left out: its friction "
                f"differs by {rounded(slow.excess, slow.stderr)} ± {two_digits(slow.stderr)} {torque} from the "
                "friction of faster motion",
            )
        )
    return lines


def strongest_correlation(estimate: EstimateRecord) -> str:
    """Return the pair of parameters with the strongest correlation."""
    size = np.abs(np.triu(estimate.correlation, 1))
    if size.size < 2:
        return "a single free parameter"
    first, second = np.unravel_index(int(np.argmax(size)), size.shape)
    pair = f"{estimate.free[first]} and {estimate.free[second]}"
    return f"strongest {estimate.correlation[first, second]:.2f}, between {pair}"


def text_report(estimate: EstimateRecord, action: Callable[[Action], str] = str) -> str:
    """Return the estimate as text.

    Parameters
    ----------
    estimate : Estimate
    action : callable
        Words the remedies of a finding. Default: for a Python prompt.
    """
    table = [HEAD, *rows(estimate)]
    widths = [max(len(row[column]) for row in table) for column in range(len(HEAD))]
    lines = [
        f"jointid estimate — {subject(estimate)}",
        "",
        *judged(estimate).lines(),
        "",
    ]
    for index, row in enumerate(table):
        cells = [
            cell.rjust(w) if 0 < c < 4 and index else cell.ljust(w)
            for c, (cell, w) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
        if index == 0:
            lines.append("  ".join("-" * w for w in widths))
    lines.append("")
    pairs = quality(estimate)
    width = max(len(label) for label, _ in pairs)
    lines += [f"{label.ljust(width)}  {text}" for label, text in pairs]
    lines.append("")
    if not estimate.warnings:
        lines.append("no warnings")
    lines += _findings(estimate, action)
    return printable("\n".join(lines))


def _findings(estimate: EstimateRecord, action: Callable[[Action], str]) -> list[str]:
    """Return one line per finding; a line between blocking findings and warnings states how many may be effects."""
    lines = [
        f"{found.severity} ({found.code}): {found.worded(action)}" for found in estimate.findings
    ]
    blocking = sum(found.severity == "blocking" for found in estimate.findings)
    others = len(estimate.warnings) - blocking
    if blocking and others:
        it = "it" if blocking == 1 else "them"
        lines.insert(blocking, f"{others} more may follow from {it}:")
    return lines
