"""Colours of pictures, for a light and a dark background.

The colours are darker and lighter variants of Okabe and Ito's, which colour-blind readers can distinguish.
Each has a contrast of at least 3:1 against its background, also over a band.
"""

from __future__ import annotations

BAND = 0.15  # opacity of a filled area; a larger one would hide the curves on it
LIGHT = {
    "ground": "#ffffff",
    "ink": "#222222",
    "muted": "#555555",
    "grid": "#dddddd",
    "measured": "#767676",
    "fitted": "#c94f00",
    "second": "#0072b2",
    "third": "#00805c",
    "fourth": "#b2508a",
    "fifth": "#946600",
    "link": "#0b5cad",
    "alarm": "#b00020",
    "well": "#f4f4f4",
}
DARK = {
    "ground": "#15181c",
    "ink": "#e6e6e6",
    "muted": "#aeb4ba",
    "grid": "#343a41",
    "measured": "#9aa0a6",
    "fitted": "#ff9147",
    "second": "#56b4e9",
    "third": "#2fc79b",
    "fourth": "#e59cc7",
    "fifth": "#e6b23c",
    "link": "#7ab8ff",
    "alarm": "#ff8a80",
    "well": "#20252b",
}
# The names for a mark's `look`.
LOOKS = ("measured", "fitted", "second", "third", "fourth", "fifth")
# Lengths of dashes and gaps, in line widths. They distinguish the lines of a series also without colour.
DASHES: dict[str, tuple[float, ...]] = {
    "measured": (),
    "fitted": (6, 2),
    "second": (6, 2, 1, 2),
    "third": (2, 1),
    "fourth": (8, 2, 1, 1, 1, 1, 1, 2),
    "fifth": (4, 1),
}
