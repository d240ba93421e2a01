"""Causes of a servo's misfit by name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from jointid.estimate.causes import Causes
from jointid.estimate.objections import EXPLAINED
from jointid.identification.causes.harm import possible
from jointid.identification.causes.suspicion import suspicious
from jointid.servo.estimate import ServoEstimate
from jointid.servo.fitted_servo import FittedServo
from jointid.servo.layout import KNOWN

_LEAST = 0.4  # of the misfit: whether a smaller share is certain depends on which windows stand side by side


def causes_of_servo(fit: FittedServo, estimate: ServoEstimate) -> Causes:
    """Return the causes of a misfit; none where it is noise, or where the model explains too little to tell them."""
    nothing = Causes(found=())
    if not 1.0 - estimate.relative_residual**2 >= EXPLAINED:
        return nothing
    velocity = fit.integral_of_each(lambda _, run: run.velocity) / fit.duration
    if not suspicious(fit.residual, fit.run, fit.duration, velocity):
        return nothing
    from jointid.identification.causes.causes import causes_of  # of a misfit: not of every fit

    torque = fit.grid.columns[fit.kept, KNOWN] / fit.duration
    causes = causes_of(fit, estimate.parameters, float(np.sqrt(np.mean(torque**2))))
    causes = possible(causes, estimate.parameters)
    return replace(causes, found=tuple(each for each in causes.found if each.share > _LEAST))
