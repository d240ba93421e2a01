"""Values that ended at a bound."""

from __future__ import annotations

import math
from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.reasons_against_use import LARGE
from jointid.estimate.statistics import distance_from_bound
from jointid.estimate.wording import percent, two_digits
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.model_too_rich import SHAPES, STATIC, richness
from jointid.identification.warnings.no_friction import without_friction

AT_BOUND = FindingType(
    code="at_bound",
    meaning="a parameter ended on its bound. The parameter has no standard error, so do not use its value. Info: a "
    "friction parameter is 0, and can cause at most a tenth of all friction",
    advice="widen the bound, or check units, signs and gear ratio",
)

_EXPLAINED = 0.95  # in a poor model, a wider bound would only make the value worse


def _find(evidence: Evidence) -> Iterator[Finding]:
    ended = [p for p in evidence.parameters.values() if p.at_bound is not None]
    if not ended:
        return
    rich = (*STATIC, *SHAPES) if richness(evidence) is not None else ()
    # these have their own finding; a friction of 0 is then a value
    reported = (*rich, *without_friction(evidence))
    for p in ended:
        may_be = distance_from_bound(p)
        torques, share = evidence.torques, None
        if torques.is_friction(p.name):
            share = torques.of_all_friction(p.name, may_be)
        small = share is not None and share <= LARGE and math.isfinite(may_be)
        if p.name in reported and (small or share is None):
            continue
        limit = p.min if p.at_bound == "min" else p.max
        measured = {f"{p.name}.{p.at_bound}": Measured(limit, p.unit)}
        if share is not None:
            measured[f"{p.name}.share"] = Measured(share)
        if small and limit == 0.0:
            yield AT_BOUND.finding(
                f"{p.name} ended on its bound, 0, but may be up to {two_digits(may_be)} {p.unit} "
                f"({percent(share or 0.0)} of all friction)",
                evidence=measured,
                parameters=(p.name,),
                severity="info",
            )
            continue
        side = "lower" if p.at_bound == "min" else "upper"
        advice = [Action("inspect", text="units, signs and gear ratio")]
        explained = evidence.residuals.r_squared >= _EXPLAINED
        if p.name not in evidence.bounds_from_data and limit != 0.0 and explained:
            # NOTE: None removes the bound; a wide one then comes from the data.
            wider = {p.name: {p.at_bound: None}}
            advice.insert(0, Action("call", {"parameters": wider}, text="a bound from the data"))
        yield AT_BOUND.finding(
            f"{p.name} ended at its {side} bound {limit:.6g} {p.unit}".rstrip(),
            *advice,
            details="the best value is beyond the bound, or not determined by the data; other values are affected",
            evidence=measured,
            parameters=(p.name,),
        )


CHECK = Check(_find, (AT_BOUND,))
