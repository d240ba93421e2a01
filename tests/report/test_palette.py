"""Curves stand out against their ground, in light and in dark, also where a band lies behind them."""

import re

import pytest

from jointid.panels.palette import BAND, DARK, LIGHT, LOOKS
from jointid.report.drawing.style import STYLE

LEAST = 3.0  # WCAG 2.1, 1.4.11: graphical objects
TEXT = 4.5  # 1.4.3


def luminance(colour: str) -> float:
    parts = [int(colour[place : place + 2], 16) / 255.0 for place in (1, 3, 5)]
    linear = [x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def mixed(colour: str, ground: str, opacity: float) -> str:
    parts = (
        opacity * int(colour[place : place + 2], 16)
        + (1.0 - opacity) * int(ground[place : place + 2], 16)
        for place in (1, 3, 5)
    )
    return "#" + "".join(f"{round(part):02x}" for part in parts)


def test_the_measure_is_right() -> None:
    assert contrast("#ffffff", "#000000") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.01)


@pytest.mark.parametrize("colours", [LIGHT, DARK], ids=["light", "dark"])
def test_every_curve_stands_out(colours: dict[str, str]) -> None:
    ground = colours["ground"]
    for look in (*LOOKS, "muted"):
        assert contrast(colours[look], ground) >= LEAST
        for band in LOOKS:
            assert contrast(colours[look], mixed(colours[band], ground, BAND)) >= LEAST
    for text in ("ink", "muted", "link", "alarm", "third", "fifth"):
        assert contrast(colours[text], ground) >= TEXT


def test_the_style_sheet_has_these_colours_and_fetches_nothing() -> None:
    light, dark = STYLE.split("prefers-color-scheme: dark", 1)
    for colours, sheet in ((LIGHT, light), (DARK, dark)):
        for name, colour in colours.items():
            assert f"--{name}: {colour};" in sheet
    assert f"fill-opacity: {BAND};" in STYLE
    for look in LOOKS:
        assert f"svg .{look} {{ stroke: var(--{look}); }}" in STYLE
    assert set(re.findall(r"var\(--(\w+)\)", STYLE)) <= set(LIGHT) == set(DARK)
    assert "url" not in STYLE
    assert "@import" not in STYLE
    assert not re.search("[<>&\"']", STYLE)  # a page escapes these
