"""Findings about an unexplained residual, with the share that the other joints explain."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from jointid.base.error_text import joint_phrase
from jointid.estimate.estimate import Estimate
from jointid.estimate.findings import Finding, Measured
from jointid.joints.coupling import Share
from jointid.joints.signals import MEANING

_CODES = ("structured_residual", "poor_fit")
_OWN = ", which the joint's own motion explains nearly as well"
_UNEXPLAINED = re.compile(r"none of \d+ known causes explains [^;]+")


def cited(estimate: Estimate, shares: Sequence[Share]) -> Estimate:
    """Return an estimate whose findings on the residual name the joints that explain it for certain.

    Parameters
    ----------
    estimate : Estimate
    shares : sequence of Share
        Shares of the residual that the other joints explain.
    """
    certain = [share for share in shares if share.certain]
    if not certain:
        return estimate
    findings = tuple(
        _citing(each, certain) if each.code in _CODES else each for each in estimate.findings
    )
    return estimate if findings == estimate.findings else replace(estimate, findings=findings)


def _citing(finding: Finding, shares: Sequence[Share]) -> Finding:
    parts = [
        f"{joint_phrase(share.joint)}'s {share.by} explains {max(1, round(100.0 * share.share))} % of the residual "
        f"({MEANING[share.by]}{_OWN if share.own_too else ''})"
        for share in shares
    ]
    text = " and ".join(parts)
    details, count = _UNEXPLAINED.subn(lambda _: text, finding.details)
    explained = min(1.0, sum(share.share for share in shares))
    evidence = {name: each for name, each in finding.evidence.items() if name != "causes_excluded"}
    return replace(
        finding,
        details=details if count else "; ".join(filter(None, (finding.details, text))),
        evidence={**evidence, "explained_by_others": Measured(explained)},
    )
