"""Draw panels below each other, with axes and legends, as one SVG."""

from __future__ import annotations

from collections.abc import Sequence

from jointid.base.html import Html, element
from jointid.panels.marks import Mark, Panel, numbers
from jointid.report.drawing.mark_paths import UNIT, legend_sample, mark_kind, mark_path
from jointid.report.drawing.pointed_values import readouts
from jointid.report.drawing.scale import Scale, drawable, limits
from jointid.report.drawing.ticks import Ticks, superscript

WIDTH = 560  # width of the picture in units
# Tenths of a unit. The spaces for texts fit the large text of a narrow screen, see the style sheet.
_LETTER = 105
_NARROW, _BROAD = frozenset("iljtfrI,.:;'!|()[] -"), frozenset("mwMW%@−")
_LINE = 210
_RIGHT = 170
_SWATCH = 250
_BETWEEN = 170
_FOR_A_TICK = 330


def drawn(panels: Sequence[Panel], title: str, description: str = "") -> Html:
    """Draw panels with one horizontal axis, as one picture.

    Parameters
    ----------
    panels : sequence of Panel
        Panels from top to bottom. The horizontal axis of the lowest one has labels.
    title : str
        Name of the picture, also for screen readers.
    description : str
        Text after the description of the axes. Default: none.

    Returns
    -------
    Html
        An ``svg`` element that scales with the page. The page must contain `style.STYLE`.
    """
    marks = [mark for panel in panels for mark in (*panel.marks, *panel.right)]
    logarithmic = panels[-1].logarithmic_across
    low, high = limits([each for mark in marks for each in mark.values()[0]], logarithmic)
    ranges = [_range_of_rows(panel) or _range(panel.marks, panel.logarithmic) for panel in panels]
    ticks = [
        Ticks(_rows(panel), ("",) * len(panel.names))
        if panel.names
        else Scale(*up, 0, 1, panel.logarithmic).ticks(panel.height * UNIT // _FOR_A_TICK)
        for panel, up in zip(panels, ranges, strict=True)
    ]
    rights = [
        Scale(*_range(panel.right), 0, 1).ticks(panel.height * UNIT // _FOR_A_TICK)
        for panel in panels
        if panel.right
    ]
    left = _room(ticks)
    across = Scale(
        low, high, left, WIDTH * UNIT - (_room(rights) if rights else _RIGHT), logarithmic
    )
    parts: list[Html | str] = []
    below = begin = 0
    for number, (panel, up, each) in enumerate(zip(panels, ranges, ticks, strict=True)):
        legend, below = _legend(panel, below)
        top = below + _LINE + 90
        named = _axis_title(panel.up, each.exponent)
        title_place = element("text", named, x="40", y=str(top - 110))
        foot = top + panel.height * UNIT
        begin = begin or top
        upright = Scale(*up, foot, top, panel.logarithmic)
        last = number == len(panels) - 1
        parts += [*legend, title_place, *_axes(across, upright, each, panel.across if last else "")]
        parts += _row_names(panel, across, upright)
        paths = [mark_path(mark, across, upright) for mark in panel.marks]
        if panel.right:
            other = Scale(*_range(panel.right), foot, top)
            parts += _right_axis(across, other, rights.pop(0), panel.right_up, top - 110)
            paths += [mark_path(mark, across, other) for mark in panel.right]
        parts += [path for path in paths if path is not None]
        if not any(paths):
            middle = str((across.start + across.stop) // 2)
            parts.append(
                element("text", "no values", class_="across", x=middle, y=str((top + foot) // 2))
            )
        below = foot + (2 * _LINE + 60 if last else 60)
    parts += readouts(panels, across, begin, foot)
    said = f"{_summary(panels, ranges, (low, high))} {description}".strip()
    return element(
        "svg",
        element("title", title),
        element("desc", said),
        *parts,
        viewBox=f"0 0 {WIDTH * UNIT} {below}",
        role="img",
    )


def _range(marks: Sequence[Mark], logarithmic: bool = False) -> tuple[float, float]:
    return limits([each for mark in marks for each in mark.values()[1]], logarithmic)


def _room(ticks: Sequence[Ticks]) -> int:
    """Return the width of the numbers at a vertical axis."""
    return 80 + _LETTER * max(len(text) for each in ticks for text in (*each.texts, "0"))


def _right_axis(across: Scale, up: Scale, ticks: Ticks, title: str, above: int) -> list[Html | str]:
    """Return the axis at the right with its numbers, and its title above it."""
    right = str(WIDTH * UNIT - 40)
    return [
        element("path", class_="axes", d=f"M{across.stop} {up.stop}V{up.start}"),
        element("text", _axis_title(title, ticks.exponent), class_="up", x=right, y=str(above)),
        *(
            element("text", text, x=str(across.stop + 60), y=str(y + 45))
            for text, y in zip(ticks.texts, up.places(ticks.values).tolist(), strict=True)
        ),
    ]


def _axes(across: Scale, up: Scale, ticks: Ticks, title: str) -> list[Html | str]:
    """Return grid, axes, numbers at the ticks and the horizontal axis's title. Without a title, omit numbers."""
    below = _ticks_across(across)
    rows = up.places(ticks.values).tolist()
    columns = across.places(below.values).tolist()
    grid = "".join(f"M{across.start} {y}H{across.stop}" for y in rows)
    grid += "".join(f"M{x} {up.stop}V{up.start}" for x in columns)
    parts: list[Html | str] = [
        element("path", class_="grid", d=grid),
        element("path", class_="axes", d=f"M{across.start} {up.stop}V{up.start}H{across.stop}"),
    ]
    parts += [
        element("text", text, class_="up", x=str(across.start - 60), y=str(y + 45))
        for text, y in zip(ticks.texts, rows, strict=True)
        if text
    ]
    if title:
        foot = up.start + _LINE
        parts += [
            element("text", text, class_="across", x=str(x), y=str(foot))
            for text, x in zip(below.texts, columns, strict=True)
        ]
        middle = str((across.start + across.stop) // 2)
        named = _axis_title(title, below.exponent)
        parts.append(element("text", named, class_="across", x=middle, y=str(foot + _LINE)))
    return parts


def _rows(panel: Panel) -> tuple[float, ...]:
    return tuple(-float(row) for row in range(len(panel.names)))


def _range_of_rows(panel: Panel) -> tuple[float, float] | None:
    """Return the range with space for the last row's marks and the first row's name."""
    return (0.6 - len(panel.names), 0.75) if panel.names else None


def _row_names(panel: Panel, across: Scale, up: Scale) -> list[Html | str]:
    """Return each row's name above it, cut at the end of the picture."""
    room = across.stop - across.start - 80
    x, rows = str(across.start + 40), up.places(_rows(panel)).tolist()
    return [
        element("text", _cut(name, room), x=x, y=str(y - 110))
        for name, y in zip(panel.names, rows, strict=True)
    ]


def _cut(text: str, room: int) -> str:
    """Return a text with its middle removed if it is too long."""
    if _width(text) <= room:
        return text
    kept = max(2, len(text) * room // _width(text) - 3)
    return f"{text[: kept - kept // 2]}…{text[len(text) - kept // 2 :]}"


def _ticks_across(across: Scale) -> Ticks:
    """Return as many ticks as their numbers have space for."""
    for most in range(7, 2, -1):
        ticks = across.ticks(most)
        if len(ticks.texts) * _LETTER * (max(map(len, ticks.texts), default=0) + 1) <= (
            across.stop - across.start
        ):
            return ticks
    return across.ticks(2)


def _axis_title(title: str, exponent: int) -> str:
    if not exponent:
        return title
    power = f"10{superscript(exponent)}"
    return title.replace("[", f"[{power} ", 1) if "[" in title else f"{title} [{power}]"


def _legend(panel: Panel, top: int) -> tuple[list[Html | str], int]:
    """Return the labelled marks in rows as wide as the picture, and the place below them."""
    parts: list[Html | str] = []
    x, y = 40, top + _LINE
    labelled = [mark for mark in (*panel.marks, *panel.right) if mark.label]
    if len(labelled) == 0:
        return [], top
    for mark in labelled:
        width = _SWATCH + _width(mark.label) + _BETWEEN
        if x > 40 and x + width - _BETWEEN > WIDTH * UNIT:
            x, y = 40, y + _LINE
        parts += [
            legend_sample(mark, x, y - 45),
            element("text", mark.label, x=str(x + _SWATCH), y=str(y)),
        ]
        x += width
    return parts, y + 60


def _width(text: str) -> int:
    """Return the approximate width of a text in a wide font."""
    narrow, broad = sum(map(_NARROW.__contains__, text)), sum(map(_BROAD.__contains__, text))
    return _LETTER * len(text) + (_LETTER * (broad - narrow)) // 2


def _summary(
    panels: Sequence[Panel],
    ranges: Sequence[tuple[float, float]],
    across: tuple[float, float],
) -> str:
    """Return a description: the axes with their ranges, and the marks."""
    said = [f"Across: {panels[-1].across}, from {across[0]:.3g} to {across[1]:.3g}."]
    for panel, up in zip(panels, ranges, strict=True):
        drawn = "; ".join(_counted(mark) for mark in panel.marks if mark.label)
        shown = f"{panel.up}, from {up[0]:.3g} to {up[1]:.3g}"
        if panel.names:
            shown = f"{panel.up}, from above: {', '.join(panel.names)}"
        said.append(f"Up: {shown}{': ' if drawn else ''}{drawn}.")
        if panel.right:
            drawn = "; ".join(_counted(mark) for mark in panel.right)
            said.append(f"At the right: {panel.right_up}: {drawn}.")
    return " ".join(said)


def _counted(mark: Mark) -> str:
    shown = sum(int(drawable(numbers(each)).sum()) for each in list(mark.values()[1])[:1])
    return f"{mark.label} ({mark_kind(mark)}, {shown} values)"
