"""Summary of a design for a report page."""

from __future__ import annotations

import math

from jointid.base.result import Overview, Quantity
from jointid.estimate.overview import settings_of
from jointid.excitation.design_fields import COMPLETE, DesignFields
from jointid.excitation.expected_error import ExpectedError
from jointid.excitation.tables import share_text

_SETTINGS = ("criterion", "joints", "evaluations", "seed", "control_period")


def overview_of(design: DesignFields) -> Overview:
    """Return the report page's summary of a design."""
    level, *said = _answer(design)
    return Overview(
        title=f"{design.joint.name or 'joint'}: motion of {design.duration:g} s",
        answer=tuple(said),
        level=level,
        parameters=tuple(map(_quantity, design.parameters.values())),
        settings=settings_of({name: getattr(design, name) for name in _SETTINGS}),
    )


def _answer(design: DesignFields) -> tuple[str, ...]:
    """Return the level, and sentences: whether the motion may be used, and the error of the worst parameter."""
    if design.status != COMPLETE:
        return "not usable", f"Not usable: {design.status}.", *filter(None, [design.reason])
    errors = {name: each.worst for name, each in design.parameters.items()}
    name = design.weakest
    if not math.isfinite(errors.get(name, math.inf)):
        unknown = ", ".join(each for each, worst in errors.items() if not math.isfinite(worst))
        said = f"Usable with care: {unknown or 'a parameter'} will not be determined."
        return "usable with care", said
    limited = f" {design.limited_by.capitalize()}." if design.limited_by else ""
    worst = f"This is the largest standard error of {design.joints} joints drawn from the prior."
    return (
        "usable",
        f"Usable: no parameter's expected error is above {share_text(errors[name])}, and all limits are kept.",
        f"{worst} The weakest parameter is {name}.{limited}",
    )


def _quantity(each: ExpectedError) -> Quantity:
    return Quantity(
        name=each.name,
        value=each.value,
        error=each.stderr if math.isfinite(each.stderr) else None,
        unit=each.unit,
        meaning="nominal value with the expected error",
        remark=f"{share_text(each.worst)} at worst",
    )
