"""Summary of a robot's estimate for a report page."""

from __future__ import annotations

from jointid.base.result import Overview
from jointid.estimate.overview import quantity_of, settings_of
from jointid.robot.result.record import RobotEstimateRecord
from jointid.robot.result.tables import quality
from jointid.robot.result.verdict import judged_robot


def overview_of(estimate: RobotEstimateRecord) -> Overview:
    """Return the report page's summary of a robot's estimate."""
    runs = recordings_of(estimate)
    return Overview(
        title=f"{estimate.robot.name or 'robot'}: friction of {len(estimate.joints)} joints",
        footer=made_by(estimate),
        verdict=judged_robot(estimate),
        parameters=tuple(quantity_of(p, name) for name, p in estimate.parameters.items()),
        fit=tuple(quality(estimate)),
        facts=(("recordings" if len(runs) > 1 else "recording", "; ".join(runs)),),
        findings=estimate.findings,
        settings=settings_of(estimate.settings, without=("recordings", "version")),
    )


def made_by(estimate: RobotEstimateRecord) -> str:
    """Return the method, the version and the recordings."""
    return (
        "All joints are identified together, from integrals of the torque balance over windows, without "
        f"accelerations; value ± standard error. jointid {estimate.settings.get('version', '')}; "
        f"{'; '.join(recordings_of(estimate))}"
    )


def recordings_of(estimate: RobotEstimateRecord) -> list[str]:
    """Return the names of the recordings."""
    return [str(each or "recording") for each in estimate.settings.get("recordings", ())]
