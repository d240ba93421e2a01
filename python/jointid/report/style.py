"""The style sheet of all reports: one column, tables that scroll for themselves, light and dark."""

from __future__ import annotations

from jointid.report.drawing import palette

STYLE = f"""
{palette.STYLE}
body {{ font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--ground); max-width: 60rem;
 margin: 2rem auto; padding: 0 1rem; overflow-wrap: anywhere; }}
h1 {{ font-size: 1.5rem; }} h2 {{ font-size: 1.15rem; margin-top: 2rem; }}
a {{ color: var(--link); }}
table {{ border-collapse: collapse; font-variant-numeric: tabular-nums; display: block; max-width: 100%;
 overflow-x: auto; overflow-wrap: normal; margin: .8rem 0; }}
td:not(:first-child):not(:last-child) {{ white-space: nowrap; }}
pre {{ overflow-x: auto; background: var(--well); padding: .6rem .8rem; font-size: .85rem; line-height: 1.4; }}
th, td {{ padding: .25rem .8rem; border-bottom: 1px solid var(--grid); text-align: left; }}
td:nth-child(2), td:nth-child(3) {{ text-align: right; }}
table.facts td:nth-child(2) {{ text-align: left; overflow-wrap: anywhere; }}
table.jointid td:last-child:not(:empty) {{ min-width: 9rem; }}
table.numbers th {{ text-align: left; font-weight: normal; }} table.numbers td {{ text-align: right; }}
figure {{ margin: 1rem 0; }} figcaption {{ color: var(--muted); font-size: .9rem; max-width: 46rem; }}
ul.findings li {{ margin-bottom: .4rem; }} li.blocking b {{ color: var(--alarm); }} li.info {{ color: var(--muted); }}
p.verdict {{ font-size: 1.2rem; }} p.not-usable {{ color: var(--alarm); }}
p.usable-with-care {{ color: var(--fifth); }} p.usable {{ color: var(--third); }}
footer {{ margin-top: 3rem; color: var(--muted); font-size: .85rem; }}
"""
# Of pages with wide tables: a row for each joint.
WIDE = """
body { max-width: 76rem; } p, ul { max-width: 56rem; }
table { font-size: .92rem; } .wide { overflow-x: auto; }
table.joints td { white-space: nowrap; }
table.joints td:nth-child(2) { white-space: normal; overflow-wrap: anywhere; min-width: 11rem; }
table.joints td:last-child { white-space: normal; overflow-wrap: anywhere; min-width: 9rem; }
table.joints th { white-space: normal; }
@media screen { body { max-width: 96vw; } }
table.joints td:nth-child(2), table.joints td:nth-child(3) { text-align: left; }
"""
