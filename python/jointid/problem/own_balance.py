"""Own terms in the balances for the estimation of delays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.joint.own_terms import FRICTION, INERTIA, OwnTerms
from jointid.problem.own_integrals import own_series, signal_of
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_CONSTANT = 1e-6  # relative variation: an inertia that varies less is part of the joint's inertia


@dataclass(frozen=True, kw_only=True)
class OwnSignal:
    """The integral of an own term, from the first sample to each.

    Attributes
    ----------
    series : ndarray
        Integral of the term. For an inertia without its mean, which belongs to the joint's inertia.
    friction : bool
        Whether the term is friction, of another joint or of this one.
    taken : bool
        Whether the term is a known torque, which is already subtracted from the drive's torque.
    """

    series: Array
    friction: bool
    taken: bool


def own_signals(own: OwnTerms, recording: Recording) -> tuple[OwnSignal, ...]:
    """Return the signals of a recording's own terms; empty without own terms."""
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
