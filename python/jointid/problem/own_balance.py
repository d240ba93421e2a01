"""What own terms add to the balances that delays are estimated from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.joint.own_terms import FRICTION, INERTIA, OwnTerms
from jointid.problem.own_integrals import own_series, signal_of
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_CONSTANT = 1e-6  # of its size: an inertia that varies by less is the joint's own


@dataclass(frozen=True, kw_only=True)
class OwnSignal:
    """The integral of an own term, from the first sample to each.

    Attributes
    ----------
    series : ndarray
        Values of an inertia without their mean, which belongs to the joint's inertia.
    friction : bool
        Whether the term is friction, of another joint or of this one.
    taken : bool
        Whether it is a known torque, which has been taken away from the drive's.
    """

    series: Array
    friction: bool
    taken: bool


def own_signals(own: OwnTerms, recording: Recording) -> tuple[OwnSignal, ...]:
    """Return the own terms' signals of a recording; none without own terms."""
    signals = []
    for each in own.each:
        run = recording
        if each.kind in INERTIA and not each.rate:
            inertia = signal_of(each, run)
            mean = float(inertia.mean())
            if float(np.ptp(inertia)) <= _CONSTANT * abs(mean):
                continue
            run = run.with_signals(extra={each.signal: inertia - mean})
        signals += [
            OwnSignal(
                series=series,
                friction=each.kind in FRICTION,
                taken=each.kind == "known" and not each.rate,
            )
            for _, series in own_series(OwnTerms((each,)), run)
        ]
    return tuple(signals)
