"""True values of an emulated bench."""

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
    """True values of an emulated bench. The session does not use them.

    Attributes
    ----------
    truth : mapping of str to float
        True parameter values by name, in SI units. The gear has torque ripple only with entries such as
        "ripple_sin_2" and "ripple_cos_2". The joint's model must have these orders of ripple.
    sensors : Sensors
        Noise, ripple and other errors of the torque sensor. Encoder and converter are options of the drive.
    integration_step : float
        Longest step of the joint's simulation [s].
    position : float
        Angle of the joint at the start [rad].
    drive : object, optional
        Options of the emulated drive, as its drive type defines them. Default: the default options of the drive type.
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
    """Return a joint with true parameters. It has ripple only if the truth has it.

    Raises
    ------
    InputError
        The joint's model does not have a parameter.
    """
    orders = tuple(
        order for order in joint.model.resolved.ripple if f"ripple_sin_{order:g}" in truth
    )
    return joint.replace(model=joint.model.replace(ripple=orders), parameters=dict(truth))
