"""A joint with what was identified of its servo."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from jointid.joint.joint import Joint
from jointid.joint.model import Model

if TYPE_CHECKING:
    from jointid.servo.estimate import ServoEstimate

_FRICTION = ("viscous", "coulomb", "load_friction")


def identified_joint(estimate: ServoEstimate) -> Joint:
    """Return the joint with motor, inertia and friction as identified.

    Parameters
    ----------
    estimate : ServoEstimate
    """
    joint = estimate.joint
    values = {n: estimate[n] for n in _FRICTION if n in estimate.parameters}
    joint = joint.replace(
        torque_offset=False,
        model=Model(
            "coulomb_viscous",
            gravity="none" if joint.link is None else "known",
            load_friction="load_friction" in values,
        ),
    )
    inertia = estimate["inertia"]
    changes: dict[str, object] = {
        "voltage": replace(joint.voltage, resistance=estimate["resistance"]),  # type: ignore[type-var]
        "torque_constant": estimate["torque_constant"] / abs(joint.gear_ratio),
    }
    if joint.reflected_inertia is None and inertia > 0.0:
        changes["inertia"] = inertia
    return joint.replace(**changes).with_parameters(values)
