"""Design the next motion: the one that improves an estimate most."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.excitation.design import Design
from jointid.excitation.design_search import DesignSearch
from jointid.excitation.designing import design_excitation
from jointid.excitation.motion_limits import MotionLimits
from jointid.excitation.posterior import joint_of, posterior_of, sensors_of
from jointid.excitation.prior import Prior
from jointid.joint.joint import Joint
from jointid.simulation.arguments import Controller

_JOINTS = 48  # joints that must keep the limits


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
    """Design the motion of `Estimate.next_motion`. `joint` adds facts that the estimate's joint lacks."""
    posterior = posterior_of(estimate)
    wanted = posterior.names if parameters is None else tuple(parameters)
    for name in wanted:
        if name not in posterior.names:
            free = (
                f"choose one of {', '.join(posterior.names)}" if posterior.names else "none is free"
            )
            raise InputError(
                f"the estimate has no free parameter of this name; {free}",
                argument="parameters",
                value=name,
            )
    if not wanted:
        raise InputError(
            "the estimate has no free parameter, so no motion can improve it", argument="parameters"
        )
    believed = joint_of(estimate, posterior, joint)
    if believed.sensor and believed.link is None and {"sensor_gain", "sensor_offset"} & set(wanted):
        raise InputError(
            "the load of the torque sensor is unknown: the joint has no link",
            argument="joint",
            remedy="give a joint with its link's mass, centre_of_mass and inertia",
        )
    settings = DesignSearch() if search is None else search
    require_kind("search", settings, DesignSearch)
    design = design_excitation(
        believed,
        limits,
        duration,
        controller=controller,
        sensors=sensors_of(estimate) if sensors is None else sensors,
        parameters=wanted,
        search=settings,
        known=posterior.known,
        prior=posterior.joints(max(_JOINTS, settings.joints), settings.seed)
        if prior is None
        else prior,
        **options,
    )
    before = posterior.known.stderr()
    rows = {
        name: replace(row, before=before.get(name, math.inf))
        for name, row in design.parameters.items()
    }
    return replace(design, parameters=rows)
