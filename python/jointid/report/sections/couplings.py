"""Section with the residuals that joints explain of each other."""

from __future__ import annotations

from typing import cast

from jointid.base.error_text import joint_phrase
from jointid.base.result import Result
from jointid.joints.record import JointEstimatesRecord
from jointid.joints.result import JointEstimates
from jointid.joints.tables import couplings
from jointid.report.page.content import Block, Item, Items, Part, Table, paragraph
from jointid.report.page.extras import Extras


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the sentences, and a table if a joint explains a part of another one's residual."""
    joints = cast("JointEstimates", result)
    blocks: list[Block] = [
        Items(tuple(Item((line,)) for line in couplings(joints))),
    ]
    if any(each.others for each in joints.results.values()):
        blocks += [
            _shares(joints),
            paragraph(
                "Share of a joint's residual that the motion of another joint explains, on held-out blocks "
                "of time.",
                muted=True,
            ),
        ]
    if not couplings(joints):
        return []
    return [Part("Between the joints", tuple(blocks), f"{extras.prefix}couplings")]


def _shares(result: JointEstimatesRecord) -> Table:
    """Return one row for each joint, and one column for each joint that explains a part of another."""
    explaining = {share.joint for each in result.results.values() for share in each.others}
    others = [name for name in result.results if name in explaining]
    others += sorted(explaining - set(others))  # recorded, but not identified
    rows = []
    for name, each in result.results.items():
        cells = []
        for other in others:
            mine = [
                f"{100.0 * share.share:.0f} % {share.by}{'' if share.certain else ' (?)'}"
                for share in each.others
                if share.joint == other
            ]
            cells.append(", ".join(mine) or "–")
        rows.append((name, *cells))
    return Table(tuple(rows), ("residual of", *(f"by {joint_phrase(name)}" for name in others)))
