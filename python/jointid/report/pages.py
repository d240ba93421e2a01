"""Build the page of any result from its sections, in order."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from importlib import import_module

from jointid.base.errors import InputError
from jointid.base.result import KINDS, Result, kind_of
from jointid.report.page.content import Page, Part
from jointid.report.page.extras import Extras
from jointid.report.sections import LAST_IN_NOTEBOOK, SECTIONS


def page_of(result: Result, extras: Extras) -> Page:
    """Return the page of a result.

    Raises
    ------
    InputError
        The argument is not a result, or the recordings are not those of the result.
    """
    if kind_of(result) not in KINDS:
        raise InputError(
            "this has no report; only results of identify, compare, design, simulate and sweep have reports",
            argument="result",
            value=type(result).__name__,
        )
    if extras.recordings and kind_of(result) != "estimate":
        raise InputError(
            "only the report of one joint's estimate shows its recordings", argument="recordings"
        )
    if extras.rollout is not None and kind_of(result) not in ("servo", "robot"):
        raise InputError(
            "only the report of a servo or a robot shows a rollout", argument="rollout"
        )
    seen = result.overview
    return Page(seen.title, tuple(_parts(result, replace(extras, overview=seen))), seen.footer)


def parts_of(result: Result, extras: Extras) -> list[Part]:
    """Return the parts of all sections that apply to a result, in order."""
    return _parts(result, replace(extras, overview=result.overview))


def first_parts(result: Result) -> tuple[str, list[Part]]:
    """Return the title, and the parts for a notebook."""
    seen = result.overview
    names = list(SECTIONS)
    shown = names[: names.index(LAST_IN_NOTEBOOK) + 1]
    return seen.title, _parts(result, Extras(overview=seen), shown)


def _parts(result: Result, extras: Extras, names: Iterable[str] = SECTIONS) -> list[Part]:
    kind, whole = kind_of(result), replace(extras, parts_of=parts_of)
    return [
        part
        for name in names
        if kind in SECTIONS[name]
        for part in import_module(f"jointid.report.sections.{name}").content(result, whole)
    ]
