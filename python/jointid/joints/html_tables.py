"""Several joints' estimates as HTML, for notebooks and the report."""

from __future__ import annotations

from jointid.base.html import Html, element, table
from jointid.joints.record import JointEstimatesRecord
from jointid.joints.tables import couplings, head, notes, rows


def html_table(result: JointEstimatesRecord) -> Html:
    """The table of all joints."""
    return table([list(row) for row in rows(result)], head=head(result), class_="joints")


def html_couplings(result: JointEstimatesRecord) -> Html:
    """What the joints explain of each other, and what holds for the whole table."""
    lines = [*notes(result), *couplings(result)]
    return element("ul", *(element("li", line) for line in lines))


def html_shares(result: JointEstimatesRecord) -> Html:
    """Shares of the residuals: one row a joint, one column for each other one that explains something."""
    explaining = {s.joint for each in result.results.values() for s in each.others}
    others = [*(name for name in result.results if name in explaining)]
    others += sorted(explaining - set(others))  # recorded, but not identified
    body: list[list[Html | str]] = []
    for name, each in result.results.items():
        cells: list[Html | str] = [element("th", name)]
        for other in others:
            mine = [share for share in each.others if share.joint == other]
            text = ", ".join(
                f"{100.0 * share.share:.0f} % {share.by}{'' if share.certain else ' (?)'}"
                for share in mine
            )
            cells.append(text or "–")
        body.append(cells)
    return table(
        body, head=["residual of", *(f"by joint {name}" for name in others)], class_="joints"
    )


def html_summary(result: JointEstimatesRecord) -> Html:
    """What a notebook shows for several joints."""
    title = element("b", f"jointid estimates — {result.name or 'robot'}")
    return element("div", title, html_table(result), html_couplings(result))
