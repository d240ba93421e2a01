"""The true values of an emulated bench."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.joint import Joint


@dataclass(frozen=True, slots=True, kw_only=True)
class Emulation:
    """The true values of an emulated bench; a session does not know them.

    Attributes
    ----------
    truth : mapping of str to float
        Values of the joint's parameters, by name [SI]. With "ripple_sin_2" and "ripple_cos_2" the gear
        itself ripples, if the joint's model has this order; without, it does not.
    sensors : Sensors
        Noise, ripple and the rest of the torque sensor. Encoder and converter are the drive's.
    integration_step : float
        Of the joint, at most [s].
    position : float
        Angle of the joint at first [rad].
    drive : object, optional
        Options of the emulated drive, of its type's own kind. Default: the type's default.
    """

    truth: Mapping[str, float]
    sensors: _core.Sensors = field(default_factory=_core.Sensors)
    integration_step: float = 2.5e-4
    position: float = 0.0
    drive: Any = None

    def __post_init__(self) -> None:
        if not 0.0 < self.integration_step <= 0.01:
            raise InputError(
                "more than 0 and at most 0.01 s is expected",
                argument="integration_step",
                value=self.integration_step,
            )
        if not math.isfinite(self.position):
            raise InputError("a finite angle is expected", argument="position", value=self.position)


def joint_with_truth(joint: Joint, truth: Mapping[str, float]) -> Joint:
    """A joint with true parameters, and ripple only where the truth has it.

    Raises
    ------
    InputError
        A parameter that the joint's model does not have.
    """
    orders = tuple(
        order for order in joint.model.resolved.ripple if f"ripple_sin_{order:g}" in truth
    )
    return joint.replace(model=joint.model.replace(ripple=orders), parameters=dict(truth))
