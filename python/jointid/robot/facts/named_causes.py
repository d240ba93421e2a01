"""Causes of a joint's misfit by name: what the engine of causes finds in its rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from jointid.estimate.causes import Cause, Causes
from jointid.estimate.findings import Finding
from jointid.estimate.objections import EXPLAINED
from jointid.identification.causes.cause_finding import finding_of_cause
from jointid.identification.causes.causes import causes_of
from jointid.identification.causes.suspicion import testable
from jointid.robot.facts.fitted_joint import FittedJoint
from jointid.robot.fit.attempt import Attempt
from jointid.robot.result.finding_types import TYPES

CAUSES = ("springs and counterweights", "a low-pass filter on the torque", "soft gears")
UNEXAMINED = f"not examined for a robot: {', '.join(CAUSES)}"
_CALLED = {"asymmetry": "asymmetric_friction"}  # before there was one name for all balances


def causes_of_joint(attempt: Attempt, name: str) -> Causes:
    """Return the causes of a joint's misfit; none where the excerpts have too little motion, or little is explained."""
    found = attempt.estimate.joints[name]
    fit = FittedJoint.of(attempt, attempt.robot.names.index(name))
    if not (found.residuals.r_squared >= EXPLAINED and testable(fit.run)):
        return Causes(found=())
    torque = attempt.balance.rows.torque[fit.kept] / fit.duration
    return causes_of(fit, found.parameters, float(np.sqrt(np.mean(torque**2))))


def cause_finding(cause: Cause, name: str, parameters: tuple[str, ...]) -> Finding:
    """Return the finding of a joint's cause."""
    kind = TYPES.get(_CALLED.get(cause.name, cause.name))
    found = finding_of_cause(cause, parameters, name, kind)
    return replace(found, details=f"{found.details}; {UNEXAMINED}")
