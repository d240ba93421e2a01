"""What to record next: a motion that adds what the recordings lack."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.design.design import Design
from jointid.design.designing import DesignSearch, design_excitation
from jointid.design.known import Told
from jointid.design.motion_limits import MotionLimits
from jointid.joint.joint import Joint
from jointid.simulation.arguments import Controller
from jointid.simulation.plant import control_estimates


def motion_after(
    joint: Joint,
    told: Told,
    limits: MotionLimits | Mapping[str, Any] | None,
    duration: float,
    *,
    controller: Controller | None = None,
    sensors: _core.Sensors | None = None,
    parameters: Sequence[str] | None = None,
    prior: Mapping[str, tuple[float, float]] | Sequence[Mapping[str, float]] | None = None,
    search: DesignSearch | None = None,
    **options: Any,
) -> Design:
    """Return the motion that adds most to what an estimate tells.

    Parameters
    ----------
    joint : Joint
        With the estimate's values.
    told : Told
        What the estimate tells of its free parameters.
    limits, duration, controller, sensors, parameters, prior, search, options
        As `design_excitation`; by default the controller is the one that believes the estimate, and joints are drawn
        from its intervals.

    Returns
    -------
    Design
        Its expected errors are of both recordings together, and `before` is of the first alone.
    """
    wanted = tuple(told.names if parameters is None else parameters)
    for name in wanted:
        if name not in told.names:
            raise InputError(
                f"the estimate has no free parameter of this name; free are {', '.join(told.names)}",
                argument="parameters",
                value=name,
            )
    settings = DesignSearch() if search is None else search
    design = design_excitation(
        joint,
        limits,
        duration,
        controller=believing(joint) if controller is None else controller,
        sensors=sensors,
        parameters=wanted,
        search=settings,
        known=told.known,
        prior=told.joints(settings.joints, settings.seed) if prior is None else prior,
        **options,
    )
    before = told.known.stderr()
    rows = {
        name: replace(row, before=before.get(name, float("inf")))
        for name, row in design.parameters.items()
    }
    return replace(design, parameters=rows)


def believing(joint: Joint) -> Controller | None:
    """Return the controller that believes a joint's values; None where none compensates its friction."""
    try:
        return _core.AdaptiveRobust(**control_estimates(joint))
    except InputError:
        return None
