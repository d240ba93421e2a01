"""The short answer of an estimate: verdict, values with errors, problems, and remedies."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from jointid.base.advice import Action
from jointid.base.error_text import printable
from jointid.estimate.findings import Finding
from jointid.estimate.record import EstimateRecord
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.tables import remark, subject
from jointid.estimate.verdict import Verdict, judged
from jointid.estimate.wording import number, percent, rounded, two_digits

COLUMNS = 100
"""Largest length of a line; a command is never broken."""

_VALUES = 7  # values shown; the number of further values follows
_FINDINGS = 2
_NAMED = 4  # names per line


def answer(estimate: EstimateRecord, action: Callable[[Action], str] = str, saved: str = "") -> str:
    """Return the answer in at most 15 lines.

    Parameters
    ----------
    estimate : Estimate
    action : callable
        Words an action. Default: for a Python prompt.
    saved : str
        File with the estimate. Default: none.
    """
    verdict = judged(estimate)
    return printable(
        "\n".join(
            [
                f"{subject(estimate)}: {verdict.level}",
                *purposes(verdict),
                *values(list(estimate.parameters.values())),
                *findings(estimate.findings, action, saved=saved),
            ]
        )
    )


def purposes(verdict: Verdict) -> list[str]:
    """Return one line with the accuracy for each purpose; no line if nothing is known."""
    said = []
    for purpose, use in verdict.uses.items():
        if use.level == "not usable":
            said.append(f"{purpose}: not usable")
        elif use.within is not None:
            size = f"to ± {percent(use.within)}" if use.within < 1.0 else "worse than ± 100 %"
            said.append(f"{purpose} {size}")
        else:
            said.append(f"{purpose}: {use.level}")
    known = any(use.within is not None for use in verdict.uses.values())
    differ = len({use.level for use in verdict.uses.values()}) > 1
    return [f"  {', '.join(said)}"] if known or differ else []


def value_with_error(p: ParameterEstimate) -> tuple[str, str, str]:
    """Return value, standard error, and unit with a remark; the value is rounded to two digits of its error."""
    note = remark(p)
    if p.stderr is None:
        return number(p.shown_value), "", f"{p.unit} ({note})" if note else p.unit
    if not np.isfinite(p.stderr):
        return number(p.shown_value), "", f"{p.unit} (not determined)"
    if p.stderr == 0.0:
        return number(p.shown_value), "± 0", p.unit
    return rounded(p.shown_value, p.stderr), f"± {two_digits(p.stderr)}", p.unit


def values(parameters: Sequence[ParameterEstimate]) -> list[str]:
    """Return one line per value; for many values the first ones and the number of further values."""
    # Fixed values are no answer, except for an inertia that the call states.
    wanted = [p for p in parameters if p.vary or p.name == "inertia"]
    shown = wanted if len(wanted) <= _VALUES else wanted[: _VALUES - 1]
    cells = [(p.name, *value_with_error(p)) for p in shown]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)] if cells else []
    lines = [
        f"  {name.ljust(widths[0])}  {value.rjust(widths[1])} {error.ljust(widths[2])} {unit}".rstrip()
        for name, value, error, unit in cells
    ]
    if len(shown) < len(wanted):
        lines.append(f"  and {len(wanted) - len(shown)} more values")
    return lines


def in_line(p: ParameterEstimate | None) -> str:
    """Return a value with name, error and unit for a joint's line; empty if there is no value."""
    if p is None:
        return ""
    if p.at_bound is not None:
        return f"{p.name} {number(p.shown_value)} {p.unit} (bound)"
    value, error, unit = value_with_error(p)
    if p.stderr is not None and not np.isfinite(p.stderr):
        error, unit = "± ∞", p.unit
    return " ".join(filter(None, (p.name, value, error, unit)))


def joint_lines(rows: Sequence[Sequence[str]]) -> list[str]:
    """Return one line per joint, with aligned cells; the last columns are left out if a line would be too long."""
    count = len(rows[0]) if rows else 0
    for kept in range(count, 0, -1):
        widths = [max(len(row[column]) for row in rows) for column in range(kept)]
        lines = [
            f"  {'  '.join(c.ljust(w) for c, w in zip(row, widths, strict=False))}".rstrip()
            for row in rows
        ]
        if max(map(len, lines)) <= COLUMNS:
            return lines
    return [cut(f"  {row[0]}") for row in rows]


def findings(
    found: Sequence[Finding],
    action: Callable[[Action], str] = str,
    most: int = _FINDINGS,
    saved: str = "",
    clean: Sequence[str] = ("no warnings",),
) -> list[str]:
    """Return two lines for each of the first important findings, and the codes of the others; `clean` without any."""
    serious = [each for each in found if each.severity != "info"]
    blocking = [each for each in serious if each.severity == "blocking"]
    shown = serious[:most]
    lines = [line for each in shown for line in two_lines(each, action)]
    rest = [each.code for each in serious[most:]]
    if rest:
        follow = " may follow from it" if blocking else ""
        lines.append(cut(f"{len(rest)} more{follow}: {_listed(rest)}"))
    elif not serious:
        lines += clean
    notes = [each.code for each in found if each.severity == "info"]
    if notes:
        lines.append(cut(f"notes: {_listed(notes)}"))
    if serious or notes:
        codes = [each.code for each in shown] or notes
        lines.append(f"why: jointid explain {codes[0]} {saved}".rstrip())
    return lines


def two_lines(found: Finding, action: Callable[[Action], str] = str) -> list[str]:
    """Return the title of a finding and its remedy."""
    what = next(filter(None, (action(each) for each in found.advice)), "")
    return [f"{found.severity}: {found.title}", *([f"  do: {what}"] if what else [])]


def explained(found: Finding, action: Callable[[Action], str] = str) -> list[str]:
    """Return all content of a finding, in lines."""
    lines = [f"{found.severity} ({found.code}): {found.title}"]
    lines += [f"  {each}" for each in found.details.split("; ") if each]
    lines += [
        f"  {name} = {each.value:.4g} {each.unit}".rstrip() for name, each in found.evidence.items()
    ]
    lines += [f"  do: {what}" for what in map(action, found.advice) if what]
    return lines


def _listed(codes: Sequence[str]) -> str:
    names = list(dict.fromkeys(codes))
    rest = len(names) - _NAMED
    more = f" and {rest} other{'s' * (rest > 1)}" if rest > 0 else ""
    return ", ".join(names[:_NAMED]) + more


def cut(line: str) -> str:
    """Return a line cut to `COLUMNS`."""
    return line if len(line) <= COLUMNS else line[: COLUMNS - 1] + "…"
