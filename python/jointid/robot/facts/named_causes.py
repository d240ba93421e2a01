"""Causes of a joint's misfit by name: what the engine of causes finds in its rows."""

from __future__ import annotations

import numpy as np

from jointid.estimate.causes import Cause, Causes
from jointid.estimate.findings import TITLE, Finding
from jointid.estimate.objections import EXPLAINED
from jointid.identification.causes.causes import causes_of
from jointid.identification.causes.families import BY_NAME
from jointid.robot.facts.fitted_joint import FittedJoint
from jointid.robot.fit.attempt import Attempt
from jointid.robot.result.finding_types import TYPES

_CALLED = {"asymmetry": "asymmetric_friction"}  # before there was one name for all balances


def causes_of_joint(attempt: Attempt, name: str) -> Causes:
    """Return the causes of a joint's misfit; none of a balance that explains too little to tell them."""
    found = attempt.estimate.joints[name]
    if not found.residuals.r_squared >= EXPLAINED:
        return Causes(found=())
    fit = FittedJoint.of(attempt, attempt.robot.names.index(name))
    torque = attempt.balance.rows.torque[fit.kept] / fit.duration
    return causes_of(fit, found.parameters, float(np.sqrt(np.mean(torque**2))))


def cause_finding(cause: Cause, name: str, parameters: tuple[str, ...]) -> Finding:
    """Return the finding of a joint's cause, in the words of a single joint."""
    code = _CALLED.get(cause.name, cause.name)
    title = f"{name}: {cause.title}"
    return (TYPES[code] if code in TYPES else BY_NAME[code].finding_type).finding(
        title if len(title) <= TITLE else f"{name}: {cause.meaning}",
        *cause.advice,
        details=cause.details if len(title) <= TITLE else str(cause),
        evidence=cause.evidence(cause.relative),
        parameters=parameters,
    )
