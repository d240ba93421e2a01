"""The style sheet of all pages: one width, answer and values on the first screen, light and dark."""

from __future__ import annotations

from jointid.report.drawing import style

_FRAME = "font: 15px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--ground);"
_FRAME += " max-width: 76rem; padding: 0 1rem; overflow-wrap: anywhere;"
_RULES = f"""
{style.RULES}
h1 {{ font-size: 1.4rem; margin: .6rem 0; }} h2 {{ font-size: 1.1rem; margin: 1.4rem 0 .5rem; }}
h3, h4 {{ font-size: 1rem; margin: 1.1rem 0 .4rem; }}
p, ul.lines, figcaption, .caption {{ max-width: 56rem; }} p {{ margin: .5rem 0; }}
a {{ color: var(--link); }} .muted, figcaption, .caption, footer {{ color: var(--muted); font-size: .87rem; }}
table {{ border-collapse: collapse; font-variant-numeric: tabular-nums; margin: .5rem 0; max-width: 100%;
 overflow-wrap: break-word; }}
.wide {{ overflow-x: auto; }} .wide table {{ overflow-wrap: normal; max-width: none; font-size: .92rem; }}
th, td {{ padding: .2rem .7rem .2rem 0; border-bottom: 1px solid var(--grid); text-align: left; vertical-align: top; }}
tbody th {{ font-weight: normal; overflow-wrap: break-word; }} table.values td:nth-child(2) {{ white-space: nowrap; }}
table.numbers td, table.numbers th:not(:first-child) {{ text-align: right; }}
.wide td {{ white-space: nowrap; }} .wide td:last-child {{ white-space: normal; }}
.wide thead th {{ vertical-align: bottom; }}
pre {{ overflow-x: auto; background: var(--well); padding: .6rem .8rem; font-size: .85rem; line-height: 1.4; }}
figure {{ margin: .5rem 0; }}
ul.lines {{ padding-left: 1.2rem; margin: .4rem 0; }} ul.lines li {{ margin-bottom: .45rem; }}
.below {{ font-size: .92rem; }} li.blocking b {{ color: var(--alarm); }} li.warning b {{ color: var(--fifth); }}
li .below b {{ color: inherit; }}
p.verdict {{ font-size: 1.15rem; margin: .3rem 0; }} p.not-usable {{ color: var(--alarm); }}
p.usable-with-care {{ color: var(--fifth); }} p.usable {{ color: var(--third); }}
.halves, .multiples {{ display: grid; grid-template-columns: minmax(0, 1fr); column-gap: 2rem; }}
.halves h2 {{ margin-top: .8rem; }}
.wide th:first-child {{ position: sticky; left: 0; background: var(--ground); }}
@media (min-width: 700px) {{ .multiples {{ grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); }} }}
@media (min-width: 700px) and (max-width: 999px) {{ .multiples svg text {{ font-size: 170px; }} }}
@media (max-width: 640px) {{
 table.values, table.values tbody {{ display: block; width: 100%; }} table.values thead {{ display: none; }}
 table.values tr {{ display: flex; flex-wrap: wrap; justify-content: space-between; column-gap: .7rem;
 border-bottom: 1px solid var(--grid); padding: .25rem 0; }}
 table.values th, table.values td {{ border: 0; padding: 0; white-space: normal; min-width: 0; }}
 table.values td:nth-child(2) {{ margin-left: auto; }} table.values td:empty {{ display: none; }}
 table.values td:nth-child(n+3) {{ flex-basis: 100%; color: var(--muted); font-size: .87rem; }}
 table.values td:nth-child(n+3)::before {{ content: attr(data-label); margin-right: .4rem; }} }}
@media (min-width: 1000px) {{
 .halves {{ grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); }} }}
details {{ border-top: 1px solid var(--grid); }} details:last-of-type {{ border-bottom: 1px solid var(--grid); }}
summary {{ cursor: pointer; padding: .45rem 0; }}
summary h2, summary h3, summary h4 {{ display: inline; font-size: 1rem; font-weight: 600; }}
:focus-visible {{ outline: 2px solid var(--link); outline-offset: 2px; }}
footer {{ margin-top: 2rem; }}
@media print {{ .halves, .multiples {{ display: block; }} }}
"""
STYLE = f"{style.colours(':root')}body {{ {_FRAME} margin: 1rem auto; }}{_RULES}"
"""Style sheet of a page."""
NOTEBOOK = f"{style.colours('.jointid')}.jointid {{ {_FRAME} }}\n.jointid {{ {_RULES} }}"
"""Style sheet of one element among others, as in a notebook. It changes nothing outside the element."""
