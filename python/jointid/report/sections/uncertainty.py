"""Folded section: intervals, systematic parts, effect of other windows, and correlated values."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from jointid.base.result import Result, kind_of
from jointid.estimate.estimate import Estimate
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.tables import shown_name
from jointid.estimate.wording import two_digits
from jointid.report.page.content import Block, Part, Run, Table, paragraph
from jointid.report.page.extras import Extras

if TYPE_CHECKING:
    from jointid.servo.estimate import ServoEstimate


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the tables."""
    parameters = cast("Estimate | ServoEstimate", result).parameters
    found = [p for p in parameters.values() if p.vary]
    blocks: list[Block] = [_intervals(found)]
    if kind_of(result) == "estimate":
        blocks += [
            _other_windows(found),
            paragraph(
                "Change of each value with windows of half and twice the length. One standard error is a usual change.",
                muted=True,
            ),
            _correlation(cast("Estimate", result)),
            paragraph(
                "Correlation of the parameters. Offsets refer to the mean reading. If a correlation is near ±1, "
                "two parameters look the same in the data.",
                muted=True,
            ),
        ]
    return [Part("Uncertainty", tuple(blocks), f"{extras.prefix}uncertainty", "folded")]


def _intervals(parameters: list[ParameterEstimate]) -> Table:
    rows: list[tuple[Run, ...]] = []
    for p in parameters:
        interval = "–" if p.interval is None else f"{p.interval[0]:.5g} … {p.interval[1]:.5g}"
        parts = (
            f"{two_digits(size)} {name.replace('_', ' ')}" for name, size in p.systematic.items()
        )
        texts = (f"{interval} {p.unit}".rstrip(), ", ".join(parts) or "–", p.meaning)
        rows.append((shown_name(p.name), *texts))
    return Table(tuple(rows), ("parameter", "95 % interval", "systematic parts", "meaning"))


def _other_windows(parameters: list[ParameterEstimate]) -> Table:
    rows = tuple(
        (
            shown_name(p.name),
            *("–" if s is None else f"{s:+.3g}" for s in (p.shift_halved, p.shift_doubled)),
            p.unit,
        )
        for p in parameters
    )
    return Table(rows, ("parameter", "windows halved", "doubled", "unit"))


def _correlation(estimate: Estimate) -> Table:
    rows = tuple(
        (shown_name(name), *(f"{x:.2f}" for x in row))
        for name, row in zip(estimate.free, estimate.correlation, strict=True)
    )
    return Table(rows, ("correlation", *map(shown_name, estimate.free)), numbers=True)
