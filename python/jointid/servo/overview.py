"""Summary of a servo's estimate for a report page."""

from __future__ import annotations

from jointid.base.result import Overview
from jointid.estimate.overview import quantity_of, settings_of
from jointid.servo.reading_back import SETTINGS
from jointid.servo.record import ServoEstimateRecord
from jointid.servo.tables import quality, recorded
from jointid.servo.verdict import judged_servo

_OF_RUNS = ("runs", "moving", "windows")


def overview_of(estimate: ServoEstimateRecord) -> Overview:
    """Return the report page's summary of a servo's estimate."""
    named = (*SETTINGS.optional, *SETTINGS.fields)
    return Overview(
        title=f"{estimate.joint.name or 'servo'}: motor and friction",
        footer=f"From {len(estimate.runs)} runs without a torque signal"
        f"{'; errors by a bootstrap over the runs' * bool(len(estimate.draws))}.",
        verdict=judged_servo(estimate),
        parameters=tuple(quantity_of(p) for p in estimate.parameters.values()),
        fit=tuple(quality(estimate)),
        facts=tuple(recorded(estimate)),
        findings=estimate.findings,
        settings=settings_of({name: getattr(estimate, name) for name in named}, without=_OF_RUNS),
    )
