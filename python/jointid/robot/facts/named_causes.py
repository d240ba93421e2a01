"""Named causes of a joint's residual, found by the engine of causes in the joint's rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from jointid.estimate.causes import Cause, Causes
from jointid.estimate.findings import Finding
from jointid.estimate.reasons_against_use import EXPLAINED
from jointid.identification.causes.cause_finding import finding_of_cause
from jointid.identification.causes.causes import causes_of
from jointid.identification.causes.harm import possible
from jointid.identification.causes.residual_test import testable
from jointid.robot.facts.fitted_joint import FittedJoint
from jointid.robot.fit.attempt import Attempt
from jointid.robot.result.finding_types import TYPES

CAUSES = ("springs and counterweights", "soft gears")
UNEXAMINED = f"not examined for a robot: {', '.join(CAUSES)}"
_SHOWN = 0.5  # of the mean square of all rows: below it, the excerpts do not show the residual
# codes of the engine of causes → codes of a robot's findings
_CALLED = {"asymmetry": "asymmetric_friction"}


def causes_of_joint(attempt: Attempt, name: str) -> Causes:
    """Return the causes of a joint's residual; none if the excerpts do not show it, or if little is explained."""
    found, joint = attempt.estimate.joints[name], attempt.robot.names.index(name)
    fit = FittedJoint.of(attempt, joint)
    whole = float(np.mean(attempt.fit.residual[attempt.balance.places[joint]] ** 2))
    shown = testable(fit.run) and float(np.mean(fit.residual**2)) > _SHOWN * whole
    if not (found.residuals.r_squared >= EXPLAINED and shown):
        return Causes(found=())
    torque = attempt.balance.rows.torque[fit.kept] / fit.duration
    causes = causes_of(fit, found.parameters, float(np.sqrt(np.mean(torque**2))))
    return possible(causes, found.parameters)


def cause_finding(cause: Cause, name: str, parameters: tuple[str, ...]) -> Finding:
    """Return the finding of a joint's cause, for the values that it changes, or for all if these are unknown."""
    moved = tuple(f"{name}.{each}" for each in cause.relative)
    parameters = tuple(each for each in parameters if each in moved) or parameters
    kind = TYPES.get(_CALLED.get(cause.name, cause.name))
    found = finding_of_cause(cause, parameters, name, kind)
    return replace(found, details=f"{found.details}; {UNEXAMINED}")
