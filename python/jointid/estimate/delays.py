"""Delays of the signals against the position, as an estimate carries them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Delay:
    """The constant delay of one signal against the position.

    Attributes
    ----------
    signal : str
        "torque", "sensor" or "velocity".
    value : float
        [s]; positive: the signal is late.
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
    def shown(self) -> str:
        """In milliseconds with its standard error, e.g. "torque 1.31 ± 0.04 ms"."""
        return f"{self.signal} {1e3 * self.value:+.2f} ± {1e3 * self.stderr:.2g} ms"
