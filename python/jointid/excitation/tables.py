"""A design as text and as HTML."""

from __future__ import annotations

import math

from jointid.base.error_text import printable
from jointid.estimate.wording import rounded
from jointid.excitation.assumptions import assumed
from jointid.excitation.design_fields import COMPLETE, DesignFields

_LIMITS = {
    "position": ("rad", "m"),
    "velocity": ("rad/s", "m/s"),
    "acceleration": ("rad/s²", "m/s²"),
    "torque": ("N·m", "N"),
    "sensor_range": ("N·m", "N"),
}
_TITLES = {"acceleration": "acceleration of the reference", "sensor_range": "torque at the sensor"}
_VALUES = 9  # values in an answer
_REACHED = 0.98  # share from which a limit counts as reached


def head(design: DesignFields) -> list[str]:
    """Return the titles of the columns."""
    known = any(each.before is not None for each in design.parameters.values())
    named = ["parameter", "value", *(["error before"] if known else [])]
    named += ["expected error", "share", "at worst"]
    return [*named, *(["thesis's motion"] if design.reference else []), "unit"]


def rows(design: DesignFields) -> list[list[str]]:
    """Return one row per parameter: value, errors before and expected, relative, worst, the thesis's, unit."""
    found, titles = [], head(design)
    for each in design.parameters.values():
        row = [each.name, f"{each.value:.6g}"]
        if "error before" in titles:
            row.append("–" if each.before is None else _short(each.before))
        row += [_short(each.stderr), share_text(each.relative), share_text(each.worst)]
        if design.reference:
            known = design.reference.get(each.name)
            row.append("–" if known is None else share_text(known))
        found.append([*row, each.unit])
    return found


def limits_used(design: DesignFields) -> list[str]:
    """Return one sentence per limit with the reached values."""
    peaks, side = design.peaks, design.joint.kind == "prismatic"
    low, high = design.limits.position
    reached = {
        "velocity": peaks.velocity,
        "acceleration": peaks.acceleration,
        "torque": peaks.torque,
        "sensor_range": peaks.sensor_torque,
    }
    lines = []
    for name, share in design.shares.items():
        unit = _LIMITS[name][side]
        if name == "position":
            text = f"position: {peaks.position[0]:.4g} to {peaks.position[1]:.4g} of {low:.4g} to {high:.4g} {unit}"
        else:
            text = f"{_TITLES.get(name, name)}: {reached[name]:.4g} of {getattr(design.limits, name):.4g} {unit}"
        if name == "position" and math.isfinite(high - low):
            stroke = peaks.position[1] - peaks.position[0]
            text += f", a stroke of {stroke:.3g} {unit}, {100.0 * stroke / (high - low):.0f} % of the range"
        lines.append(f"{text} ({100.0 * share:.0f} %{', reached' if share >= _REACHED else ''})")
    return lines


def summary(design: DesignFields) -> str:
    """Return a design as text."""
    lines = [head(design), *rows(design)]
    widths = [max(len(line[column]) for line in lines) for column in range(len(lines[0]))]
    text = [
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in lines
    ]
    text.insert(1, "  ".join("-" * width for width in widths))
    return printable(
        "\n".join([_title(design), *_status(design), "", *text, "", *_remarks(design)])
    )


def answer(design: DesignFields) -> str:
    """Return the expected errors and what limits them, in a few lines."""
    shown = list(design.parameters.values())[:_VALUES]
    width = max((len(each.name) for each in shown), default=0)
    values = []
    for each in shown:
        value = f"{rounded(each.value, each.stderr)} {_short(each.stderr)} {each.unit}".rstrip()
        before = "" if each.before is None else f", was {_short(each.before)}"
        values.append(
            f"  {each.name.ljust(width)}  {value}, {share_text(each.worst)} at worst{before}"
        )
    more = len(design.parameters) - len(shown)
    shares = ", ".join(
        f"{100.0 * share:.0f} % of {_TITLES.get(name, name)}"
        for name, share in design.shares.items()
    )
    return printable(
        "\n".join(
            [
                _title(design),
                *_status(design),
                *values,
                *([f"  {more} more: -v"] if more else []),
                *_weakest(design),
                *improved(design),
                *([f"uses {shares}"] if shares else []),
            ]
        )
    )


def _title(design: DesignFields) -> str:
    named = f" of '{design.joint.name}'" if design.joint.name else ""
    return f"designed motion{named}: {design.duration:g} s, {design.status}"


def _status(design: DesignFields) -> list[str]:
    return [design.reason] if design.reason and design.status != COMPLETE else []


def _weakest(design: DesignFields) -> list[str]:
    if design.weakest not in design.parameters:
        return []
    worst = share_text(design.parameters[design.weakest].worst)
    limited = f"; {design.limited_by}" if design.limited_by else ""
    return [f"weakest: {design.weakest}, {worst} at worst{limited}"]


def _remarks(design: DesignFields) -> list[str]:
    return [
        *_weakest(design),
        *improved(design),
        *(f"reaches {line}" for line in limits_used(design)),
        assumed(design),
        judged_with(design),
    ]


def judged_with(design: DesignFields) -> str:
    """Return the numbers of joints and motions tried, and the criterion."""
    joints = f"{design.joints} joint{'' if design.joints == 1 else 's'}"
    return (
        f"judged with {joints} drawn from the prior, {design.evaluations} motions tried, criterion "
        f"{design.criterion}, seed {design.seed}"
    )


def improved(design: DesignFields) -> list[str]:
    """Return the weakest parameter before, and its improvement with this motion."""
    shares = {
        name: each.before * each.relative / each.stderr
        for name, each in design.parameters.items()
        if each.before is not None and 0.0 < each.stderr < math.inf
    }
    if not shares:
        return []
    name = max(shares, key=lambda each: shares[each])
    if math.isinf(shares[name]):
        return [f"weakest before: {name}, not determined"]
    smaller = shares[name] / design.parameters[name].relative
    return [
        f"weakest before: {name}, {share_text(shares[name])}; its error is now {smaller:.2g} times smaller"
    ]


def share_text(share: float) -> str:
    """Return a relative error as text."""
    if not math.isfinite(share):
        return "not determined"
    percent = 100.0 * share
    return f"{percent:.0f} %" if percent >= 10.0 else f"{percent:.2g} %"


def _short(error: float) -> str:
    return f"± {error:.2g}" if math.isfinite(error) else "∞"
