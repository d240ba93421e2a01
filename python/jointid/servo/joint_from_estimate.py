"""The joint with the identified values of its servo."""

from __future__ import annotations

from dataclasses import replace

from jointid.joint.joint import Joint
from jointid.joint.model import Model
from jointid.servo.layout import LAYOUTS, LOAD_FRICTION
from jointid.servo.record import ServoEstimateRecord


def identified_joint(estimate: ServoEstimateRecord) -> Joint:
    """Return the joint with the identified motor, inertia and friction."""
    joint = estimate.joint
    names = [t.name for t in (*LAYOUTS[estimate.model].friction, LOAD_FRICTION)]
    values = {name: estimate[name] for name in names if name in estimate.parameters}
    joint = joint.replace(
        torque_offset=False,
        model=Model.parse(estimate.model).replace(
            gravity="none" if joint.link is None else "known",
            load_friction=LOAD_FRICTION.name in values,
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
