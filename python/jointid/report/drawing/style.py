"""The style sheet of pictures, for a light and a dark background."""

from __future__ import annotations

from jointid.panels.palette import BAND, DARK, DASHES, LIGHT, LOOKS

_WIDTH = 1.6  # width of a line, in pixels


def _variables(colours: dict[str, str]) -> str:
    return " ".join(f"--{name}: {colour};" for name, colour in colours.items())


def _dashes(look: str) -> str:
    lengths = " ".join(f"{_WIDTH * length:.1f}" for length in DASHES[look])
    return f"stroke-dasharray: {lengths}; stroke-linecap: butt;" if lengths else ""


def colours(selector: str) -> str:
    """Return the colours as variables of an element. They follow a dark screen; paper stays white."""
    dark = (
        f"@media screen and (prefers-color-scheme: dark) {{ {selector} {{ {_variables(DARK)} }} }}"
    )
    return f"{selector} {{ color-scheme: light dark; {_variables(LIGHT)} }}\n{dark}\n"


# Sizes of text are in tenths of a unit of the picture. The picture is smaller on a narrow screen, so its text
# is larger in units there.
RULES = f"""
svg {{ display: block; width: 100%; max-width: 46rem; height: auto; }}
svg text {{ font: 110px system-ui, sans-serif; fill: var(--ink); stroke: none; }}
svg .up {{ text-anchor: end; }} svg .across {{ text-anchor: middle; }}
svg path {{ fill: none; vector-effect: non-scaling-stroke; stroke-width: {_WIDTH}px; stroke-linejoin: round;
 stroke-linecap: round; }}
svg .grid {{ stroke: var(--grid); stroke-width: 1px; }} svg .axes {{ stroke: var(--muted); stroke-width: 1px; }}
svg .points {{ stroke-width: 3.2px; }} svg .dashed {{ stroke-dasharray: 7 5; stroke-linecap: butt; }}
svg .band {{ stroke-width: .6px; fill-opacity: {BAND}; }} svg .bars {{ stroke-width: 1px; fill-opacity: {BAND}; }}
svg path.shade {{ stroke: none; fill-opacity: {BAND}; }}
svg .readout {{ stroke: none; fill: transparent; pointer-events: all; }}
svg .readout:hover {{ fill: var(--measured); fill-opacity: .35; }}
{" ".join(f"svg .{look} {{ stroke: var(--{look}); }}" for look in LOOKS)}
{" ".join(f"svg .series.{look} {{ {_dashes(look)} }}" for look in LOOKS)}
{" ".join(f"svg .band.{look}, svg .bars.{look}, svg .shade.{look} {{ fill: var(--{look}); }}" for look in LOOKS)}
@media (max-width: 640px) {{ svg text {{ font-size: 170px; }} svg .points {{ stroke-width: 2.6px; }} }}
"""
STYLE = f"{colours(':root')}{RULES}"
