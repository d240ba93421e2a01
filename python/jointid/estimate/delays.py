"""Delays of the signals against the position, in an estimate."""

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
        Delay as recorded, before any shift [s]; positive: the signal is late.
    stderr : float
        Standard error [s], clustered over stretches of the motion.
    certain : bool
        Whether the remaining delay is significant, long enough to matter, and equal in all parts of the signal.
    fits : bool
        Whether the torque balance fits better without the remaining delay; only examined if it is certain. If the
        call states no shift, such a delay is removed.
    applied : float
        Shift of the signal before the identification [s]; 0: none.
    """

    signal: str
    value: float
    stderr: float
    certain: bool
    fits: bool
    applied: float

    @property
    def left(self) -> float:
        """Remaining delay in the identification [s], with the error `stderr`."""
        return self.value - self.applied

    @property
    def shown(self) -> str:
        """Measured, removed and remaining delay as text, in milliseconds."""
        text = f"{self.signal} {1e3 * self.value:+.2f} ± {1e3 * self.stderr:.2g} ms"
        if not self.applied:
            return text
        if self.applied == self.value:
            return f"{text} (removed)"
        stated = f"{1e3 * self.applied:+.2f} ms was removed as stated"
        return f"{text} ({stated}, {1e3 * self.left:+.2f} ms remains)"
