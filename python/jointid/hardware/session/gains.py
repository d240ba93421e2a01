"""Largest feedback gains for an inertia and a period. A loop that reacts within a few periods becomes unstable."""

from __future__ import annotations

from collections.abc import Callable, Collection

from jointid import _core
from jointid.hardware.session.moving_joint import MovingJoint
from jointid.simulation.arguments import Controller

_BANDWIDTH, _ROBUST = 0.25, 0.5  # largest values, per period; Table 6-1 has 0.16 and 0.45 at 2 ms
_MOST = 1.2  # largest velocity feedback over inertia, per period; Table 6-1 has 0.77
_TABLE = _core.AdaptiveRobust()
_WITH_DAMPING = (_core.Pd, _core.Pid, _core.CompensatedPid)


def inertia_of(controller: Controller, joint: MovingJoint | None) -> float | None:
    """Return the inertia that a controller's feedback moves, from its own estimate or the joint's file [kg·m²]."""
    own = float(getattr(controller, "inertia", 0.0))
    if own > 0.0:
        return own
    return None if joint is None else joint.inertia


def fitting_gains(controller: Controller, inertia: float, period: float) -> dict[str, float]:
    """Return suitable gains, at most those of Table 6-1. Return an empty dict without feedback.

    Parameters
    ----------
    controller : Controller
    inertia : float
        [kg·m²]
    period : float
        [s]
    """
    bandwidth = min(_TABLE.bandwidth, _BANDWIDTH / period)
    if isinstance(controller, _core.AdaptiveRobust):
        boundary = controller.robust_torque * period / (_ROBUST * inertia)
        return {"bandwidth": bandwidth, "boundary": max(_TABLE.boundary, boundary)}
    if isinstance(controller, _core.LugreObserver):
        return {"bandwidth": bandwidth}
    if isinstance(controller, _WITH_DAMPING):
        return {"stiffness": inertia * bandwidth**2, "damping": 2.0 * inertia * bandwidth}
    return {}


def with_fitting_gains(
    controller: Controller, stated: Collection[str], joint: MovingJoint | None, period: float
) -> Controller:
    """Return the controller with suitable gains if it states none of them."""
    inertia = inertia_of(controller, joint)
    gains = {} if inertia is None else fitting_gains(controller, inertia, period)
    if any(name in stated for name in gains):
        return controller
    change: Callable[..., Controller] = controller.replace
    return change(**gains)


def doubt_of_gains(controller: Controller, joint: MovingJoint | None, period: float) -> str:
    """Return a warning that the gains are too large for the period, with suitable gains; empty if they are not."""
    inertia = inertia_of(controller, joint)
    if inertia is None or not (gains := fitting_gains(controller, inertia, period)):
        return ""
    share = _velocity_feedback(controller) / inertia * period
    if isinstance(controller, _core.AdaptiveRobust | _core.LugreObserver):
        share += 2.0 * controller.bandwidth * period
    if share <= _MOST:
        return ""
    text = ", ".join(f"{name} = {value:.3g}" for name, value in gains.items())
    return (
        f"the gains are too high for {inertia:.3g} kg·m² and a period of {1e3 * period:g} ms: gains times period is "
        f"{share:.2g}, more than {_MOST:g}; lower gains for [session.controller]: {text}"
    )


def _velocity_feedback(controller: Controller) -> float:
    """Return the torque per velocity error, without the part that grows with the inertia [N·m·s/rad]."""
    if isinstance(controller, _core.AdaptiveRobust):
        return controller.robust_torque / controller.boundary if controller.robust_term else 0.0
    return controller.damping if isinstance(controller, _WITH_DAMPING) else 0.0
