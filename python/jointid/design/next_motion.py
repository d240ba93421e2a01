"""What to record next: the motion that adds most to what an estimate tells."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.design.design import Design
from jointid.design.design_search import DesignSearch
from jointid.design.designing import design_excitation
from jointid.design.motion_limits import MotionLimits
from jointid.design.prior import Prior
from jointid.design.told import joint_of, sensors_of, told_by
from jointid.estimate.estimate import Estimate
from jointid.joint.joint import Joint
from jointid.simulation.arguments import Controller
from jointid.simulation.plant import control_estimates


def motion_after(
    estimate: Estimate,
    limits: MotionLimits | Mapping[str, Any] | None,
    duration: float,
    *,
    joint: Joint | None = None,
    controller: Controller | None = None,
    sensors: _core.Sensors | None = None,
    parameters: Sequence[str] | None = None,
    prior: Prior = None,
    search: DesignSearch | None = None,
    **options: Any,
) -> Design:
    """Answer `Estimate.next_motion`.

    Parameters
    ----------
    estimate : Estimate
    limits, duration, controller, sensors, parameters, prior, search, options
        As `design_excitation`; see there and `Estimate.next_motion` for the defaults.
    joint : Joint, optional
        Facts that the estimate's joint lacks.
    """
    told = told_by(estimate)
    wanted = told.names if parameters is None else tuple(parameters)
    for name in wanted:
        if name not in told.names:
            free = f"free are {', '.join(told.names)}" if told.names else "none is free"
            raise InputError(
                f"the estimate has no free parameter of this name; {free}",
                argument="parameters",
                value=name,
            )
    if not wanted:
        raise InputError("nothing is free that a motion could tell more of", argument="parameters")
    believed = joint_of(estimate, told, joint)
    if believed.sensor and believed.link is None and {"sensor_gain", "sensor_offset"} & set(wanted):
        raise InputError(
            "what loads the torque sensor is not known: the joint has no link",
            argument="joint",
            remedy="give a joint with its link's mass, centre_of_mass and inertia",
        )
    settings = DesignSearch() if search is None else search
    require_kind("search", settings, DesignSearch)
    design = design_excitation(
        believed,
        limits,
        duration,
        controller=believing(believed) if controller is None else controller,
        sensors=sensors_of(estimate) if sensors is None else sensors,
        parameters=wanted,
        search=settings,
        known=told.known,
        prior=told.joints(settings.joints, settings.seed) if prior is None else prior,
        **options,
    )
    before = told.known.stderr()
    rows = {
        name: replace(row, before=before.get(name, math.inf))
        for name, row in design.parameters.items()
    }
    return replace(design, parameters=rows)


def believing(joint: Joint) -> Controller | None:
    """Return the controller that believes a joint's values; None where none compensates its friction."""
    try:
        return _core.AdaptiveRobust(**control_estimates(joint))
    except InputError:
        return None
