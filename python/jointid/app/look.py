"""The look of the page: the colours of the reports for its controls, and elements that all steps use."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from nicegui import Client, ui

from jointid.base.html import Html, element, escape
from jointid.panels.palette import DARK, LIGHT
from jointid.report.renderers.style import NOTEBOOK

FIELD = "outlined dense options-dense stack-label"
"""Properties of every field."""


def _variables(colours: dict[str, str]) -> str:
    return " ".join(f"--{name}: {colour};" for name, colour in colours.items())


_COLOURS = f"""
:root {{ color-scheme: light dark; {_variables(LIGHT)} }}
@media (prefers-color-scheme: dark) {{ :root {{ {_variables(DARK)} }} }}
"""
# Quasar's own colours are for a white background. These variables come from the style sheet, for light and dark.
_CONTROLS = """
body { font: 15px/1.5 system-ui, sans-serif; --q-primary: var(--link) !important;
 --q-negative: var(--alarm) !important; --q-warning: var(--fifth) !important; --q-positive: var(--third) !important;
 color: var(--ink) !important; background: var(--ground) !important; }
.nicegui-content { padding: 1rem 1rem 6rem; align-items: center; gap: 1rem; }
.step { width: 100%; max-width: 62rem; background: var(--ground) !important; color: var(--ink) !important;
 border: 1px solid var(--grid); border-radius: 8px; box-shadow: none !important; padding: 1rem; gap: .8rem; }
.step > * { max-width: 100%; }
h1 { font-size: 1.5rem; font-weight: 600; line-height: 1.3; margin: 0; }
h2 { font-size: 1.15rem; font-weight: 600; line-height: 1.4; margin: 0; }
h3 { font-size: 1rem; font-weight: 600; line-height: 1.4; margin: .6rem 0 0; }
.hint { color: var(--muted); font-size: .875rem; line-height: 1.4; }
.fields { display: grid; grid-template-columns: repeat(4, minmax(0, 1fr)); gap: .5rem .8rem;
 width: 100%; align-items: start; }
.signal .seen { grid-column: 4; align-self: center; }
.buttons { display: flex; flex-wrap: wrap; gap: .5rem .8rem; align-items: center; }
.pictures { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: .8rem; width: 100%; }
@media (max-width: 900px) { .fields { grid-template-columns: repeat(3, minmax(0, 1fr)); }
 .signal .seen { grid-column: 1 / -1; margin-top: -.3rem; } .pictures { grid-template-columns: minmax(0, 1fr); } }
@media (max-width: 560px) { .fields { grid-template-columns: repeat(2, minmax(0, 1fr)); }
 .nicegui-content { padding: .5rem .5rem 8rem; } .step { padding: .8rem; }
 .signal > :first-child { grid-column: 1 / -1; } .facts { grid-template-columns: minmax(0, 1fr); } }
.q-field__native, .q-field__input, .q-field__native > span { color: var(--ink) !important; }
.q-field__label, .q-field__bottom, .q-field__marginal { color: var(--muted) !important; opacity: 1; }
.q-field--with-bottom { padding-bottom: 0; }
.q-field__bottom { position: static; transform: none; line-height: 1.3; min-height: 0; padding: .2rem .75rem 0; }
.q-field--focused .q-field__label { color: var(--link) !important; }
.q-field--outlined .q-field__control:before { border-color: var(--measured) !important; }
.q-field .q-field__native > span { overflow: hidden; text-overflow: ellipsis; }
.q-menu { background: var(--well) !important; color: var(--ink); border: 1px solid var(--measured); }
.q-menu .q-item { color: var(--ink); } .q-menu .q-item--active { color: var(--link); font-weight: 600; }
.q-menu .q-manual-focusable--focused { outline: 2px solid var(--link); outline-offset: -2px; }
.q-btn { text-transform: none; font-weight: 600; min-height: 2.5rem; }
.q-btn.bg-primary { color: var(--ground) !important; }
.q-btn .q-btn__content { text-align: left; }
.q-btn.disabled { opacity: .75 !important; }
.q-btn:focus-visible, .q-field--focused .q-field__control, a:focus-visible, [tabindex]:focus-visible {
 outline: 2px solid var(--link) !important; outline-offset: 2px; }
.q-uploader { width: 100%; max-height: none; background: transparent; color: inherit;
 border: 2px dashed var(--measured) !important; border-radius: 8px; box-shadow: none; }
.q-uploader__header { background: transparent !important; color: inherit; padding: .8rem; }
.q-uploader__list { display: none; }
.q-uploader__dnd { background: var(--well); opacity: .8; }
.note { width: 100%; border-left: 4px solid var(--measured); background: var(--well); padding: .5rem .8rem;
 border-radius: 0 4px 4px 0; display: flex; flex-direction: column;
 gap: .5rem; align-items: flex-start; overflow-wrap: anywhere; }
.note.blocking { border-color: var(--alarm); } .note.warning { border-color: var(--fifth); }
.note.blocking b { color: var(--alarm); } .note.warning b { color: var(--fifth); }
.working { position: fixed; left: 0; right: 0; bottom: 0; z-index: 10; background: var(--well);
 border-top: 1px solid var(--measured); padding: .6rem 1rem; display: flex; flex-wrap: wrap;
 gap: .4rem 1rem; align-items: center; justify-content: center; }
.working .q-linear-progress { flex: 1 1 12rem; max-width: 30rem; color: var(--link); height: .6rem;
 border-radius: .3rem; }
.working .hint { color: var(--ink); font-variant-numeric: tabular-nums; min-width: 14rem; }
.q-card ul { list-style: disc; padding-left: 1.4rem; margin: .3rem 0; } .q-card p { margin: .3rem 0; }
.jointid { margin: 0 !important; padding: 0 !important; width: 100%; max-width: none !important; }
.spoken { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
"""
_WORDS = {"blocking": "Error", "warning": "Warning", "info": "Note"}


def dress() -> None:
    """Apply the page's look, in the browser's light or dark mode."""
    ui.dark_mode(None)
    ui.add_css(f"@layer components {{ {_COLOURS} {NOTEBOOK} {_CONTROLS} }}")


def heading(level: int, text: str, name: str = "") -> None:
    """Draw a heading, with a name for links."""
    with ui.element(f"h{level}").props(f"id={name}" if name else ""):
        ui.html(text, tag="span")


def note(text: str, severity: str = "info", *, spoken: bool = False) -> ui.element:
    """Draw a remark with its severity in words. With `spoken`, a screen reader says it at once."""
    with ui.element("div").classes(f"note {severity}") as drawn:
        words = element("b", f"{_WORDS[severity]}:")
        ui.html(f"{words} {escape(text)}", tag="p", sanitize=False)
    return drawn.props("role=alert" if spoken else "")


def of_page(parts: Iterable[Html], name: str) -> None:
    """Draw parts of a report page."""
    markup = "".join(map(str, parts))
    ui.html(markup, sanitize=False).classes("jointid").props(f"id={name}")


def focus(client: Client, name: str) -> None:
    """Set the keyboard focus to an element that was redrawn."""
    client.run_javascript(f"setTimeout(() => document.getElementById('{name}')?.focus(), 150)")


def chart(options: dict[str, Any], name: str, text: str, height: int) -> ui.echart:
    """Draw a picture, with its text for screen readers."""
    picture = ui.echart(options, renderer="svg").style(f"height: {height}px; width: 100%")
    picture.props["id"] = name
    picture.props["role"] = "img"
    picture.props["aria-label"] = text
    return picture
