"""What own terms add to the balances that delays are estimated from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.identification.refinements.smooth_windows import SmoothWindows
from jointid.joint.own_terms import OwnTerms
from jointid.problem.own_integrals import own_series, signal_of
from jointid.problem.problem import Problem

Array = NDArray[np.float64]

_FRICTION = ("viscous", "coulomb")
_INERTIA = ("inertia", "inertia_own", "inertia_others", "scaled_inertia")
_CONSTANT = 1e-6  # of its size: an inertia that varies by less is the joint's own


@dataclass(frozen=True, kw_only=True)
class OwnSignal:
    """The integral of an own term, from the first sample to each.

    Attributes
    ----------
    series : ndarray
        Of an inertia, without its mean: that belongs to the joint's inertia.
    friction : bool
        Whether the term is friction, of another joint or of this one.
    taken : bool
        Whether it is a known torque, which has been taken away from the drive's.
    """

    series: Array
    friction: bool
    taken: bool


def own_signals(problem: Problem, number: int) -> tuple[OwnSignal, ...]:
    """Return the own terms' signals of a recording; none without own terms."""
    own, recording = problem.choice.model.resolved.terms, problem.recordings[number]
    signals = []
    for each in own.each:
        run = recording
        if each.kind in _INERTIA and not each.rate:
            inertia = signal_of(each, run)
            mean = float(inertia.mean())
            if float(np.ptp(inertia)) <= _CONSTANT * abs(mean):
                continue
            run = run.with_signals(extra={each.signal: inertia - mean})
        signals += [
            OwnSignal(
                series=series,
                friction=each.kind in _FRICTION,
                taken=each.kind == "known" and not each.rate,
            )
            for _, series in own_series(OwnTerms((each,)), run)
        ]
    return tuple(signals)


def own_columns(
    windows: SmoothWindows, own: Sequence[OwnSignal], *, friction: bool, taken: bool
) -> list[Array]:
    """Return the mean torque of own terms in each window, each for a coefficient of 1.

    Parameters
    ----------
    windows : SmoothWindows
    own : sequence of OwnSignal
        Of the windows' stretch.
    friction : bool
        Which terms: friction, or what is none.
    taken : bool
        Whether known torques, which the drive's torque lacks already, are among them.
    """
    return [
        windows.rate(each.series)
        for each in own
        if each.friction == friction and (taken or not each.taken)
    ]
