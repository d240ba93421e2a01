"""First section: the verdict and its meaning for each purpose, or the answer in a sentence."""

from __future__ import annotations

from collections.abc import Sequence

from jointid.base.result import Result
from jointid.estimate.answers import purposes
from jointid.estimate.findings import Finding
from jointid.estimate.tables import shown_name
from jointid.estimate.verdict import Verdict
from jointid.report.page.content import (
    Answer,
    Block,
    Bold,
    Item,
    Items,
    Link,
    Paragraph,
    Part,
    Run,
    paragraph,
)
from jointid.report.page.extras import Extras

_NAMES = 6  # parameters of one purpose; a robot may have a hundred


def content(_result: Result, extras: Extras) -> list[Part]:
    """Return the verdict with its uses and its main reason, or the sentences of the answer."""
    seen = extras.overview
    blocks: list[Block] = []
    if seen.verdict is not None:
        blocks = verdict_blocks(seen.verdict, seen.findings, extras)
        blocks += [paragraph(each, muted=True) for each in seen.answer]
    elif seen.answer:
        first, *others = seen.answer
        blocks = [Answer(first, seen.level), *map(paragraph, others)]
    return [Part("", tuple(blocks))]


def verdict_blocks(
    verdict: Verdict, findings: Sequence[Finding] = (), extras: Extras | None = None
) -> list[Block]:
    """Return whether the values may be used, for which purpose, and the reasons for care."""
    blocks: list[Block] = [Answer(f"{verdict.level.capitalize()}.", verdict.level)]
    uses = verdict.uses.values()
    if len({use.level for use in uses}) > 1 or any(use.parameters for use in uses):
        lines = (
            Item((Bold(f"{purpose}: {use.level}{use.how_good}"), *_named(use.parameters)))
            for purpose, use in verdict.uses.items()
        )
        blocks.append(Items(tuple(lines)))
    else:
        blocks += [paragraph(f"{line.strip().capitalize()}.") for line in purposes(verdict)]
    return [*blocks, *_reasons(verdict, findings, extras)]


def _reasons(verdict: Verdict, findings: Sequence[Finding], extras: Extras | None) -> list[Block]:
    """Return the first reason with its advice, and the other reasons that are not findings."""
    titles = {found.title: found for found in findings}
    blocks: list[Block] = []
    for number, reason in enumerate(verdict.reasons):
        if number and reason in titles:
            continue
        runs: list[Run] = [Bold("Because "), f"{reason.rstrip('.')}."]
        found = titles.get(reason)
        if found is not None and extras is not None:
            advice = next(filter(None, map(extras.action, found.advice)), "")
            runs += [Bold(" do: "), f"{advice}."] if advice else []
        if not number and findings and extras is not None:
            runs += [" ", Link("All findings", f"{extras.prefix}findings"), "."]
        blocks.append(Paragraph(tuple(runs)))
    return blocks


def _named(parameters: tuple[str, ...]) -> list[str]:
    if not parameters:
        return []
    # A robot's parameters are named "joint.name".
    names = [name if "." in name else shown_name(name) for name in parameters[:_NAMES]]
    more = len(parameters) - len(names)
    return [f": {', '.join(names)}{f' and {more} more' if more else ''}"]
