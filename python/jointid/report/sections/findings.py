"""Section with the findings: problem, advice and reason."""

from __future__ import annotations

from jointid.base.result import Result, kind_of
from jointid.estimate.findings import Finding
from jointid.report.page.content import Bold, Item, Items, Link, Part, Run, paragraph
from jointid.report.page.extras import Extras

_SHOWN = {"info": "note"}


def content(result: Result, extras: Extras) -> list[Part]:
    """Return all findings, with the most severe first."""
    found = extras.overview.findings
    pictures = _pictures(result, extras) if kind_of(result) == "estimate" else {}
    lines = tuple(_item(each, pictures, extras) for each in found)
    block = Items(lines) if lines else paragraph("No warnings.")
    return [Part("Findings", (block,), f"{extras.prefix}findings")]


def _item(found: Finding, pictures: dict[str, str], extras: Extras) -> Item:
    severity = _SHOWN.get(found.severity, found.severity)
    runs: list[Run] = [Bold(f"{severity}:"), f" {found.title} ({found.code})"]
    if found.code in pictures:
        runs += [" ", Link("picture", pictures[found.code])]
    first, *others = [what for what in map(extras.action, found.advice) if what] or [""]
    below: list[tuple[Run, ...]] = []
    if first:
        below.append((Bold("do: "), first, *(f"; or {each}" for each in others)))
    if found.details:
        below.append((found.details,))
    return Item(tuple(runs), tuple(below), found.severity)


def _pictures(result: Result, extras: Extras) -> dict[str, str]:
    """Return the part of the page that shows each kind of finding."""
    from jointid.identification.warnings.registry import finding_types

    searched = getattr(result, "convergence", None) is not None
    shown = {code: each.picture for code, each in finding_types().items() if each.picture}
    return {
        code: f"{extras.prefix}{name}"
        for code, name in shown.items()
        if searched or name != "convergence"
    }
