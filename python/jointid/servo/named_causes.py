"""Named causes of a servo's residual."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from jointid.estimate.causes import Causes
from jointid.estimate.reasons_against_use import EXPLAINED
from jointid.identification.causes.harm import possible
from jointid.identification.causes.residual_test import suspicious
from jointid.servo.estimate import ServoEstimate
from jointid.servo.fitted_servo import FittedServo
from jointid.servo.layout import KNOWN

_LEAST = 0.4  # of the residual: the certainty of a smaller share depends on the choice of windows that do not overlap


def causes_of_servo(fit: FittedServo, estimate: ServoEstimate) -> Causes:
    """Return the causes of a residual; none if it is noise, or if the model explains too little to separate them."""
    nothing = Causes(found=())
    if not 1.0 - estimate.relative_residual**2 >= EXPLAINED:
        return nothing
    velocity = fit.integral_of_each(lambda _, run: run.velocity) / fit.duration
    if not suspicious(fit.residual, fit.run, fit.duration, velocity):
        return nothing
    from jointid.identification.causes.causes import causes_of  # loaded only if needed

    torque = fit.grid.columns[fit.kept, KNOWN] / fit.duration
    causes = causes_of(fit, estimate.parameters, float(np.sqrt(np.mean(torque**2))))
    causes = possible(causes, estimate.parameters)
    return replace(causes, found=tuple(each for each in causes.found if each.share > _LEAST))
