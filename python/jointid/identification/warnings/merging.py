"""Merge equal findings about single recordings into one that names its recordings."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace

from jointid.estimate.findings import TITLE, Finding, Measured

_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w])")
_NAMED = 5  # recordings in the details; the finding contains all


def merged(found: Iterable[tuple[int, Finding]], names: Sequence[str]) -> list[Finding]:
    """Return findings about single recordings; equal ones are merged.

    Parameters
    ----------
    found : iterable of tuple
        Number of the recording, and a finding about it.
    names : sequence of str
        Names of all recordings; a single recording is not named.
    """
    groups: dict[object, list[tuple[int, Finding]]] = {}
    for number, each in found:
        advice = tuple((action.kind, action.function, action.text) for action in each.advice)
        said = _NUMBER.sub("#", f"{each.title}\n{each.details}")
        key = (each.code, each.severity, each.parameters, said, advice)
        groups.setdefault(key, []).append((number, each))
    if len(names) == 1:
        return [each for group in groups.values() for _, each in group]
    return [_as_one(group, names) for group in groups.values()]


def _as_one(group: Sequence[tuple[int, Finding]], names: Sequence[str]) -> Finding:
    concerned = tuple(names[number] for number in dict.fromkeys(number for number, _ in group))
    findings = [each for _, each in group]
    title = _with_ranges([each.title for each in findings])
    details = _with_ranges([each.details for each in findings])
    more = f" and {len(concerned) - _NAMED} more" if len(concerned) > _NAMED else ""
    listed = f"in {', '.join(concerned[:_NAMED])}{more}"
    where = f"{len(concerned)} of {len(names)} recordings"
    if len(concerned) == 1:
        where = concerned[0]
    fits = len(f"{where}: {title}") <= TITLE
    if not fits or 1 < len(concerned) < len(names):
        details = f"{listed}; {details}".removesuffix("; ")
    return replace(
        findings[0],
        title=f"{where}: {title}" if fits else title,
        details=details,
        evidence=_largest(findings),
        recordings=concerned,
    )


def _with_ranges(causes: Sequence[str]) -> str:
    """Return sentences that differ only in numbers as one, with "4–6 %" in place of a number that differs."""
    columns = zip(*(_NUMBER.findall(cause) for cause in causes), strict=True)
    ranges = iter([_range(column) for column in columns])
    return _NUMBER.sub(lambda _: next(ranges), causes[0])


def _range(numbers: Sequence[str]) -> str:
    low, high = min(numbers, key=float), max(numbers, key=float)
    if low == high:
        return low
    return f"{low} to {high}" if low.startswith("-") else f"{low}–{high}"


def _largest(findings: Sequence[Finding]) -> dict[str, Measured]:
    """Return the largest of each number; equal findings have the same names of numbers."""
    largest: dict[str, Measured] = {}
    for each in findings:
        for name, number in each.evidence.items():
            if name not in largest or abs(number.value) > abs(largest[name].value):
                largest[name] = number
    return largest
