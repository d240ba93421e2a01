"""Removal of a certain friction drift from the torque, before a second fit.

A coefficient that changes with time biases other parameters, most of all the sensor gain. Removing the drift removes
this bias. The fitted coefficient is then its value at the middle of the recording.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.estimate.causes import Cause
from jointid.estimate.estimate import Estimate
from jointid.estimate.statistics import ParameterEstimate
from jointid.identification.refinements.balance_residual import fits_better
from jointid.problem.problem import Problem
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_SHARE = 0.8  # smallest share of the residual that a certain drift explains
_ROUNDED = 1.0 - 1e-6  # tolerance for rounding, because the share is computed from other sums here
_LARGE = 0.05  # smallest relative change over the recording
_LINEAR = 1e-6  # relative deviation of a drive signal from a multiple of the torque
_DRIVE = ("torque", "motor_torque", "current")


def may_drift(
    problem: Problem, penalty: _core.Penalty, parameters: Mapping[str, ParameterEstimate]
) -> bool:
    """Return whether the drift of a coefficient explains enough of the residual to be removed.

    This examines drifts only. If other causes also explain the residual, no drift is removed later.

    Parameters
    ----------
    problem : Problem
    penalty : Penalty
        Penalty as fitted.
    parameters : mapping of str to ParameterEstimate
    """
    from jointid.identification.causes.causes import share_of

    return share_of("drift", problem, penalty, parameters) >= _ROUNDED * _SHARE


def without_drift(
    problem: Problem, penalty: _core.Penalty, estimate: Estimate
) -> tuple[Problem, Cause] | None:
    """Return the problem without the drift of a friction coefficient, and that drift; None if none is certain.

    Parameters
    ----------
    problem : Problem
    penalty : Penalty
        Penalty as fitted.
    estimate : Estimate
        Estimate of that fit.

    Notes
    -----
    A drift is certain if all these conditions hold: it explains most of the residual alone, it is not small, no other
    cause explains nearly as much, and its removal improves the prediction of held-out blocks by three standard errors.
    """
    if "drift" not in {finding.code for finding in estimate.findings}:
        return None
    from jointid.identification.causes.causes import attributed

    first = attributed(problem, penalty, estimate, {}, problem.recordings[0].time).found[:1]
    cause = first[0] if first else None
    if cause is None or cause.name != "drift" or cause.share < _SHARE or cause.alike:
        return None
    term = next((each for each in penalty.terms if each.name == cause.detail), None)
    change = cause.numbers["change"].value
    if term is None or not term.friction or term.needs_load or abs(change) < _LARGE:
        return None
    span = max(run.duration for run in problem.recordings)
    rate = change * estimate.parameters[cause.detail].value / span
    shapes = np.array([estimate.parameters[shape].value for shape in term.shapes])
    steady = []
    for number, recording in enumerate(problem.recordings):
        basis = np.asarray(_core.friction_basis(term.key, recording.velocity, shapes))
        if problem.hold(number) == "zoh":  # the torque is held until the next sample
            basis = 0.5 * (basis + np.append(basis[1:], basis[-1]))
        drift = rate * (recording.time - recording.time[0] - 0.5 * span) * basis
        changed = _with_less(recording, problem.output_torque(number), drift)
        if changed is None:
            return None
        steady.append(changed)
    changed_problem = replace(problem, recordings=tuple(steady))
    if not fits_better(problem, changed_problem, 0.0):
        return None
    moved = {cause.detail: cause.shifts[cause.detail]}
    relative = {name: share for name, share in cause.relative.items() if name in moved}
    removed = replace(
        cause,
        shifts=moved,
        relative=relative,
        shares={name: share for name, share in cause.shares.items() if name in moved},
    )
    removed = replace(
        removed,
        effect=f"the values are valid in mid-recording; the drift correction changed {removed.moves}",
    )
    return changed_problem, removed


def _with_less(recording: Recording, torque: Array, drift: Array) -> Recording | None:
    """Return the recording with the drift subtracted from its torque.

    Return None if a signal of the drive is not a multiple of the torque.
    """
    signals = {name: getattr(recording, name) for name in recording.signals}
    size = float(np.einsum("i,i->", torque, torque))
    for name in _DRIVE:
        if name in signals:
            factor = float(np.einsum("i,i->", signals[name], torque)) / size
            missed = np.abs(signals[name] - factor * torque).max()
            if missed > _LINEAR * np.abs(signals[name]).max():
                return None
            signals[name] = signals[name] - factor * drift
    return recording.with_signals(**signals)
