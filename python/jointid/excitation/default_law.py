"""Default controller of a design."""

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.joint import Joint
from jointid.simulation.arguments import Controller
from jointid.simulation.plant import control_estimates

_ROBUST = 0.03  # share of the torque limit: the robust term
_STIFF = 80.0  # 1/s


def default_controller(nominal: Joint, torque: float) -> Controller:
    """Return a law with the joint's values, or a law without a model if none can compensate the joint's friction.

    `torque` is the drive's limit [N·m]. The robust term has a small share of it.
    """
    try:
        law = _core.AdaptiveRobust(
            **control_estimates(nominal), friction_velocity="reference", torque_feedback=False
        )
    except InputError:
        inertia = nominal.known_inertia or 1.0
        return _core.Pd(stiffness=inertia * _STIFF * _STIFF, damping=2.0 * inertia * _STIFF)
    return law.replace(robust_torque=min(law.robust_torque, _ROBUST * torque))
