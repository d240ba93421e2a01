"""Breakaway and inertia that the joint file predicts for a first motion, and the reasons of a difference."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from jointid import _core
from jointid.joint.joint import Joint

LARGEST_RATIO = math.sqrt(3.0)
"""Largest ratio of measured and stated values. A stated value may be wrong by 1.5; a fault is a factor of 3."""

_CREEP, _NOTHING = 1e-6, 1e-3  # [rad/s]; smallest relevant basis at that speed
_APART = 2.0  # smallest ratio of two predicted inertias that distinguishes two explanations


@dataclass(frozen=True, slots=True, kw_only=True)
class Expected:
    """Values that a joint file states, by its own constants.

    Attributes
    ----------
    breakaway : float or None
        Friction at rest, mean of both directions [N·m]; None if not stated.
    drive_inertia : float or None
        Inertia of the drive at the output, by the joint file's gear ratio [kg·m²]; None if not stated.
    link_inertia : float or None
        Inertia of the link [kg·m²]; None if the joint file has no link.
    sensor : bool
        Whether there is a torque sensor.
    sensor_sign : float
        Sign of the sensor's gain.
    """

    breakaway: float | None
    drive_inertia: float | None
    link_inertia: float | None
    sensor: bool
    sensor_sign: float

    @property
    def inertia(self) -> float | None:
        """Inertia of drive and link together [kg·m²]; None if one of them is not stated."""
        if self.drive_inertia is None or self.link_inertia is None:
            return None
        return self.drive_inertia + self.link_inertia


def expected_of(joint: Joint) -> Expected:
    """Return the values that a joint states."""
    stated = _stated_breakaway(joint)
    identified = _value(joint, "inertia")
    drive = joint.reflected_inertia
    if identified is not None:  # without a sensor it includes the link
        drive = identified if joint.sensor else max(identified - joint.link_inertia, 0.0)
    gain = _value(joint, "sensor_gain")
    return Expected(
        breakaway=stated if stated is not None and stated > 0.0 else None,
        drive_inertia=drive,
        link_inertia=None if joint.link is None else joint.link_inertia,
        sensor=joint.sensor,
        sensor_sign=math.copysign(1.0, gain) if gain else 1.0,
    )


def _value(joint: Joint, name: str) -> float | None:
    parameter = joint.parameters.get(name)
    return None if parameter is None else parameter.value


def _stated_breakaway(joint: Joint) -> float | None:
    """Return the friction at the lowest speed, mean of both directions [N·m]; None if a value of it is not stated."""
    model = joint.model.resolved
    speeds = np.array([_CREEP, -_CREEP])
    total = np.zeros(2)
    for key in _core.model_terms(model.name, asymmetric=model.asymmetric):
        term = _core.term(key)
        if not term.friction:
            continue
        # The shape of a friction term does not matter if its coefficient is 0.
        shapes = np.array([_value(joint, shape) or 1.0 for shape in term.shapes])
        basis = _core.friction_basis(key, speeds, shapes)
        if np.abs(basis).max() < _NOTHING:
            continue
        value = _value(joint, term.name)
        if value is None:
            return None
        total += value * basis
    return 0.5 * float(total[0] - total[1])


def scale_fault(expected: Expected, friction: float, inertia: float) -> str | None:
    """Return the code of the cause if measured and stated friction differ; None if they do not.

    Parameters
    ----------
    expected : Expected
    friction, inertia : float
        Measured values, by the joint file's constants [N·m], [kg·m²]; NaN if not measured.

    Notes
    -----
    If the true torque constant is s times the stated one, measured friction and inertia are the true values divided by
    s. If the true gear ratio is n times the stated one, measured friction is the true friction divided by n. The
    measured inertia of the link is then the true inertia divided by n². The inertia of the rotor at the output still
    agrees with the stated value, because torque and angle are both wrong.
    """
    if expected.breakaway is None:
        return None
    ratio = friction / expected.breakaway
    if 1.0 / LARGEST_RATIO <= ratio <= LARGEST_RATIO:
        return None
    drive, link = expected.drive_inertia, expected.link_inertia
    both = "torque_constant_or_gear_ratio"
    if drive is None or link is None or not inertia > 0.0:
        return both
    by_constant, by_gear = (drive + link) * ratio, drive + link * ratio**2
    if abs(math.log(by_constant / by_gear)) < math.log(_APART):
        return both
    off_constant, off_gear = (abs(math.log(inertia / each)) for each in (by_constant, by_gear))
    if min(off_constant, off_gear) > 0.5 * abs(math.log(by_constant / by_gear)):
        return both
    return "torque_constant" if off_constant < off_gear else "gear_ratio"
