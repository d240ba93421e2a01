"""Disagreement of slow motion with faster motion, in an estimate."""

from __future__ import annotations

from jointid.base.values import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class SlowMotion:
    """Friction in slow windows compared with the friction from faster windows.

    Attributes
    ----------
    speed : float
        Windows below this mean speed are slow [rad/s or m/s].
    excess : float
        Mean friction in slow windows minus the prediction from faster windows [N·m or N]. Negative: slow windows
        have less friction, like a creeping or sticking joint.
    stderr : float
        Standard error of `excess`, clustered over passes of slow motion.
    level : float
        Coulomb friction from the faster windows [N·m or N].
    share : float
        Share of slow windows in the windows' time.
    applied : bool
        Whether motion slower than `speed` was left out.
    """

    speed: float
    excess: float
    stderr: float
    level: float
    share: float
    applied: bool
