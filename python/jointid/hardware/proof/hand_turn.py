"""Turn of the joint by hand with the motor off: the only proof without torque that the encoder counts."""

from __future__ import annotations

from jointid.hardware.proof.axis import Axis
from jointid.hardware.proof.refusal import RefusedBenchError

_COUNTS = 50.0  # more than jitter, and more than by leaning on the joint
_QUIET = 1.0  # [s] without a count: the joint was released


def await_hand_turn(axis: Axis, longest: float) -> float:
    """Wait until somebody has turned and released the joint. Return the angle of the turn [rad].

    The bounds of the axis start at the position after the turn.

    Parameters
    ----------
    axis : Axis
        Axis with its motor off.
    longest : float
        Longest wait for the turn, and again for the release [s].

    Raises
    ------
    RefusedBenchError
        The encoder did not count in that time, or did not stop.
    """
    farthest = 0.0
    with axis.by_hand():
        start, end = axis.sample.position, axis.now + longest
        while farthest < _COUNTS * axis.resolution:
            farthest = max(farthest, abs(axis.read().position - start))
            if axis.now > end:
                raise RefusedBenchError(
                    "encoder_stands",
                    f"in {longest:g} s of waiting for a turn by hand, the encoder moved by "
                    f"{farthest / axis.resolution:.0f} counts, fewer than {_COUNTS:.0f}: turn the joint; if you have "
                    "turned it, the encoder hangs or is not connected",
                )
        place, since, end = axis.sample.position, axis.now, axis.now + longest
        while axis.now - since < _QUIET:
            position = axis.read().position
            farthest = max(farthest, abs(position - start))
            if abs(position - place) > 1.5 * axis.resolution:
                place, since = position, axis.now
            if axis.now > end:
                raise RefusedBenchError(
                    "moving", f"the joint was still turning after {longest:g} s; let the joint go"
                )
    return farthest
