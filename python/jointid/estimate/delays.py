"""Delays of the signals against the position, as an estimate carries them."""

from __future__ import annotations

from jointid.base.values import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Delay:
    """The constant delay of one signal against the position.

    Attributes
    ----------
    signal : str
        "torque", "sensor" or "velocity".
    value : float
        As recorded, before any shift [s]; positive: the signal is late.
    stderr : float
        [s]; clustered over stretches of the motion.
    certain : bool
        Whether what is left of it is significant, long enough to matter, and the same for every part of the
        signal.
    fits : bool
        Whether the torque balance fits better without what is left of it; asked where that is certain. Without
        a shift in the call it is then taken away.
    applied : float
        What the signal was shifted by before the identification [s]; 0: not at all.
    """

    signal: str
    value: float
    stderr: float
    certain: bool
    fits: bool
    applied: float

    @property
    def left(self) -> float:
        """What the identification still had of it [s]; with an error of `stderr`."""
        return self.value - self.applied

    @property
    def shown(self) -> str:
        """What was measured, what was taken away, and what is left, in milliseconds."""
        text = f"{self.signal} {1e3 * self.value:+.2f} ± {1e3 * self.stderr:.2g} ms"
        if not self.applied:
            return text
        if self.applied == self.value:
            return f"{text} (taken away)"
        stated = f"{1e3 * self.applied:+.2f} ms was taken away as stated"
        return f"{text} ({stated}, {1e3 * self.left:+.2f} ms is left)"
