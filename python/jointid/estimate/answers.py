"""The answer in a few lines: the verdict, the values with their errors, what is wrong, and what to do about it."""

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
"""A line is at most so long, but for a command, which stays in one piece."""

_VALUES = 7  # values, of more the rest is a number
_FINDINGS = 2
_NAMED = 4  # names in a line


def answer(estimate: EstimateRecord, action: Callable[[Action], str] = str, saved: str = "") -> str:
    """Return the answer in at most 15 lines.

    Parameters
    ----------
    estimate : Estimate
    action : callable
        Words an action. Default: as at a Python prompt.
    saved : str
        The file that has the estimate. Default: there is none.
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
    """How good it is for each purpose, in a line; no line where nothing is known of that."""
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
    """A value, its standard error, and its unit with a remark: two digits of the error decide how many of the value."""
    note = remark(p)
    if p.stderr is None:
        return number(p.shown_value), "", f"{p.unit} ({note})" if note else p.unit
    if not np.isfinite(p.stderr):
        return number(p.shown_value), "", f"{p.unit} (not determined)"
    if p.stderr == 0.0:
        return number(p.shown_value), "± 0", p.unit
    return rounded(p.shown_value, p.stderr), f"± {two_digits(p.stderr)}", p.unit


def values(parameters: Sequence[ParameterEstimate]) -> list[str]:
    """One line a value; of many the first, and how many there are."""
    # What was not identified is no answer, but for an inertia that the call states.
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
    """A value with its name, error and unit, for a line of a joint that has others; nothing where there is none."""
    if p is None:
        return ""
    if p.at_bound is not None:
        return f"{p.name} {number(p.shown_value)} {p.unit} (bound)"
    value, error, unit = value_with_error(p)
    if p.stderr is not None and not np.isfinite(p.stderr):
        error, unit = "± ∞", p.unit
    return " ".join(filter(None, (p.name, value, error, unit)))


def joint_lines(rows: Sequence[Sequence[str]]) -> list[str]:
    """One line a joint: its cells in columns, without the last columns where a line would be too long."""
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
    """Two lines for each of the first findings that matter, and the codes of the others; `clean` if none does."""
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
    """What was found, and what to do about it."""
    what = next(filter(None, (action(each) for each in found.advice)), "")
    return [f"{found.severity}: {found.title}", *([f"  do: {what}"] if what else [])]


def explained(found: Finding, action: Callable[[Action], str] = str) -> list[str]:
    """Everything that a finding says, in lines."""
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
    """A line of at most `COLUMNS`."""
    return line if len(line) <= COLUMNS else line[: COLUMNS - 1] + "…"
