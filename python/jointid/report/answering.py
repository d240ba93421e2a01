"""What a page says first: a verdict for each purpose, or an answer in a sentence."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from jointid.base.advice import Action
from jointid.base.html import Html, element
from jointid.estimate.findings import Finding
from jointid.estimate.tables import shown_name
from jointid.estimate.verdict import Level, Verdict

_REASONS = 3  # those that matter most; the findings have all
_NAMES = 6  # parameters of one purpose; a robot may have a hundred


def answer(sentence: str, level: Level | None = None) -> Html:
    """Return a page's answer, in the colour of a level if it has one."""
    look = "verdict" if level is None else f"verdict {level.replace(' ', '-')}"
    return element("p", element("b", sentence), class_=look)


def verdict_lines(
    verdict: Verdict,
    findings: Sequence[Finding] = (),
    pictures: Mapping[str, str] | None = None,
    action: Callable[[Action], str] = str,
) -> list[Html]:
    """Return whether the values may be used, for what, and the reasons where care is needed.

    Parameters
    ----------
    verdict : Verdict
    findings : sequence of Finding
        That it rests on: a reason that is a finding's has its advice. Default: reasons alone.
    pictures : mapping of str to str, optional
        Code → section of the page that shows it, which the reason then links to. Default: no links.
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    """
    words = [
        element(
            "li", element("b", f"{purpose}: {use.level}{use.how_good}"), *_named(use.parameters)
        )
        for purpose, use in verdict.uses.items()
    ]
    lines = [
        answer(f"{verdict.level.capitalize()}.", verdict.level),
        element("ul", *words, class_="uses"),
    ]
    if verdict.reasons:
        by_title = {found.title: found for found in findings}
        shown = [
            _reason(reason, by_title.get(reason), pictures or {}, action)
            for reason in verdict.reasons[:_REASONS]
        ]
        more = len(verdict.reasons) - len(shown)
        shown += [element("li", f"and {more} more, below")] if more else []
        lines += [element("p", "Because:"), element("ul", *shown)]
    return lines


def _reason(
    reason: str,
    found: Finding | None,
    pictures: Mapping[str, str],
    action: Callable[[Action], str],
) -> Html:
    if found is None:
        return element("li", reason)
    parts: list[Html | str] = [found.cause]
    if found.advice:
        parts += [". ", element("b", "What to do: "), "; or ".join(map(action, found.advice)), "."]
    if found.code in pictures:
        parts += [" ", element("a", "picture", href=f"#{pictures[found.code]}")]
    return element("li", *parts)


def _named(parameters: tuple[str, ...]) -> list[Html | str]:
    if not parameters:
        return []
    # A robot's parameters are named "joint.name".
    names = [name if "." in name else shown_name(name) for name in parameters[:_NAMES]]
    more = len(parameters) - len(names)
    return [f": {', '.join(names)}{f' and {more} more' if more else ''}"]
