"""Check whether friction differs between the directions, for joints with a model without such a difference."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent, rounded, two_digits
from jointid.joint.model import AUTO
from jointid.robot.fit.attempt import Attempt
from jointid.robot.fit.excerpt_rows import ExcerptRows
from jointid.robot.links.models import modelled, terms_of
from jointid.robot.links.parameters import DIFFERENCE, VISCOUS
from jointid.robot.result.finding_types import TYPES, titled

_SURE = 6.0  # standard errors
_BETTER = 3.0  # standard errors by which the residual of held-out stretches falls
_LARGE = 0.03  # of the viscous friction
_EXPLAINED = 0.1  # of the squared residual


def asymmetry_findings(attempt: Attempt) -> Iterator[Finding]:
    """Yield findings of joints with viscous friction that clearly differs between the directions."""
    rows = ExcerptRows(attempt.balance, attempt.fit, attempt.excerpts)
    for joint, (name, found) in enumerate(attempt.estimate.joints.items()):
        keys = [term.key for term in terms_of(found.model)]
        if DIFFERENCE in found.parameters or VISCOUS.key not in keys:
            continue
        place = attempt.balance.labels.index((joint, DIFFERENCE))
        share = rows.share(attempt.balance.matrix[rows.kept, place, None])
        mine = rows.joint == joint
        left = float(rows.residual[mine] @ rows.residual[mine]) or 1.0
        explained = share.share * float(rows.residual @ rows.residual) / left
        value, error = float(share.values[0]), float(share.errors[0])
        viscous, unit = found.parameters[VISCOUS.name].value, found.parameters[VISCOUS.name].unit
        large = abs(value) > max(_SURE * error, _LARGE * viscous)
        if not (np.isfinite(error) and large):
            continue
        if share.certainty > _BETTER and explained > _EXPLAINED:
            size = f"{rounded(2.0 * abs(value), 2.0 * error)} ± {two_digits(2.0 * error)} {unit}"
            yield TYPES["asymmetric_friction"].finding(
                titled(f"{VISCOUS.meaning} of {name} differs between the directions", size),
                Action(
                    "call", {"model": modelled(AUTO, asymmetric=True)}, function="identify_robot"
                ),
                details=f"the difference is {size}; it explains {percent(explained)} of the joint's squared residual "
                "in held-out motion",
                evidence={"difference": Measured(value, unit), "explained": Measured(explained)},
            )
