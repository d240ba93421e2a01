"""Summary of several joints for a report page."""

from __future__ import annotations

from dataclasses import replace

from jointid.base.error_text import joint_phrase
from jointid.base.result import Overview
from jointid.estimate.findings import Finding
from jointid.estimate.overview import quantity_of, settings_of
from jointid.estimate.wording import percent
from jointid.joints.answers import headline, ordered_findings, worst_level
from jointid.joints.record import JointEstimatesRecord
from jointid.joints.tables import model_of, notes, shown_parameters


def overview_of(result: JointEstimatesRecord) -> Overview:
    """Return the report page's summary of several joints."""
    shown = shown_parameters(result)
    joints = result.results
    return Overview(
        title=f"{result.name or 'robot'}: friction of {len(joints)} joint{'s' * (len(joints) != 1)}",
        footer="Each joint is identified alone; value ± standard error.",
        answer=(
            f"{headline(result)}.",
            *(f"{joint_phrase(name)} failed: {joints[name].error}" for name in result.failed),
            *notes(result),
        ),
        level=worst_level(result),
        parameters=tuple(
            quantity_of(estimate.parameters[each], f"{name}.{each}")
            for name, estimate in result.items()
            for each in shown
            if each in estimate.parameters
        ),
        fit=tuple(
            (
                joint_phrase(name),
                f"{model_of(estimate)}, residual {percent(estimate.residuals.relative)}",
            )
            for name, estimate in result.items()
        ),
        findings=tuple(_of_joint(name, found) for name, found in ordered_findings(result)),
        settings=settings_of({"seconds": result.seconds}),
        inner=dict(result),
    )


def _of_joint(name: str, found: Finding) -> Finding:
    return replace(found, title=f"{joint_phrase(name)}: {found.title}")
