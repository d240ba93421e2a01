"""Plots of recordings, estimates and studies. All take and return Matplotlib axes with labels and units."""

from jointid.plot.appearance import line_style, style
from jointid.plot.design import designed_motion
from jointid.plot.estimate import convergence, friction_map, residuals, window_means
from jointid.plot.friction import friction_curves, sensitivity, torque_over_velocity
from jointid.plot.motion import signal, tracking_error, trajectory
from jointid.plot.rollout import rolled_out
from jointid.plot.search import adaptation
from jointid.plot.study import sweep

__all__ = [
    "adaptation",
    "convergence",
    "designed_motion",
    "friction_curves",
    "friction_map",
    "line_style",
    "residuals",
    "rolled_out",
    "sensitivity",
    "signal",
    "style",
    "sweep",
    "torque_over_velocity",
    "tracking_error",
    "trajectory",
    "window_means",
]
