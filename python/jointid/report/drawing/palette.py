"""Colours and the style sheet of pictures, for a light and a dark ground.

The colours are darkened and lightened variants of Okabe and Ito's, which the colour-blind can tell apart.
Each has a contrast of at least 3:1 against its ground, also where a band lies behind it.
"""

from __future__ import annotations

BAND = 0.15  # opacity of a filled area; more would take the contrast from the curves on it
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
# The names that a mark may have as its look.
LOOKS = ("measured", "fitted", "second", "third", "fourth", "fifth")


def _variables(colours: dict[str, str]) -> str:
    return " ".join(f"--{name}: {colour};" for name, colour in colours.items())


# A dark screen is served, paper stays white. Sizes of text are in tenths of a unit of the picture,
# which is drawn smaller on a narrow screen: there the text is larger in the picture's units.
STYLE = f"""
:root {{ color-scheme: light dark; {_variables(LIGHT)} }}
@media screen and (prefers-color-scheme: dark) {{ :root {{ {_variables(DARK)} }} }}
svg {{ display: block; width: 100%; max-width: 46rem; height: auto; }}
svg text {{ font: 110px system-ui, sans-serif; fill: var(--ink); stroke: none; }}
svg .up {{ text-anchor: end; }} svg .across {{ text-anchor: middle; }}
svg path {{ fill: none; vector-effect: non-scaling-stroke; stroke-width: 1.6px; stroke-linejoin: round;
 stroke-linecap: round; }}
svg .grid {{ stroke: var(--grid); stroke-width: 1px; }} svg .axes {{ stroke: var(--muted); stroke-width: 1px; }}
svg .points {{ stroke-width: 3.2px; }} svg .dashed {{ stroke-dasharray: 7 5; stroke-linecap: butt; }}
svg .band {{ stroke-width: .6px; fill-opacity: {BAND}; }} svg .bars {{ stroke: none; fill-opacity: .75; }}
svg .shade.measured {{ stroke: none; fill: var(--measured); fill-opacity: {BAND}; }}
svg .readout {{ stroke: none; fill: transparent; pointer-events: all; }}
svg .readout:hover {{ fill: var(--measured); fill-opacity: .35; }}
{" ".join(f"svg .{look} {{ stroke: var(--{look}); }}" for look in LOOKS)}
{" ".join(f"svg .band.{look}, svg .bars.{look} {{ fill: var(--{look}); }}" for look in LOOKS)}
@media (max-width: 640px) {{ svg text {{ font-size: 170px; }} svg .points {{ stroke-width: 2.6px; }} }}
"""
