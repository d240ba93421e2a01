"""How slow motion disagrees with faster motion, as an estimate carries it."""

from __future__ import annotations

from jointid.base.values import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class SlowMotion:
    """Slow windows held against the friction that faster windows show.

    Attributes
    ----------
    speed : float
        Windows below this mean speed are the slow ones [rad/s or m/s].
    excess : float
        Mean friction that the slow windows have beyond what the faster ones predict [N·m or N]; negative:
        they have less, as a creeping or sticking joint does.
    stderr : float
        Standard error of `excess`, clustered over passes of slow motion.
    level : float
        Dry friction of the faster windows [N·m or N].
    share : float
        Share of the windows' time that is slow.
    applied : bool
        Whether motion slower than `speed` was left out.
    """

    speed: float
    excess: float
    stderr: float
    level: float
    share: float
    applied: bool
