"""Candidates at low speed: friction that decays differently, rises with speed, or builds up after a reversal."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.identification.causes.candidates import Candidate, typical_speed
from jointid.identification.causes.fitted_balance import FittedBalance
from jointid.identification.causes.samples import Samples, WaySinceReversal

Array = NDArray[np.float64]

# Shares of a fast speed over which dry friction rises; slower rises look like viscous friction. Friction has risen at
# `_RISEN` times such a speed.
_OF_RISES = tuple(0.01 * 1.4**k for k in range(10))
_FINER = ((1.0,), (0.85, 0.92, 1.0, 1.09, 1.18))  # factors of a coarse, then of a fine search
_RISEN = 2.0
_ENOUGH = 0.8  # share of what several columns explain that is enough for one column


def slow_motion(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield friction at low speed that decays with speed, or with the distance since the last reversal."""
    fast = typical_speed(fit)
    reach = max(float(np.ptp(run.position)) for run in fit.runs)
    speeds = fast * np.array([0.02, 0.05, 0.1, 0.2, 0.4])
    ways = reach * np.array([1e-4, 1e-3, 1e-2])
    linear = fit.integral_of_each(
        lambda _, run: (
            np.exp(-np.abs(run.velocity)[:, None] / speeds) * np.sign(run.velocity)[:, None]
        )
    )
    ways_gone = [WaySinceReversal(run) for run in fit.runs]
    since = fit.integral_of_each(
        lambda number, run: (
            np.exp(-ways_gone[number].of(run.cut)[:, None] / ways) * np.sign(run.velocity)[:, None]
        )
    )
    family = "slow_motion"
    known = "static" in fit.names or "static_positive" in fit.names
    less = _signed_gains(fit, linear) < 0.0
    for k, speed in enumerate(speeds):
        if less[k] and _may_rise(fit):
            continue  # friction that is smaller at low speed is `smooth_friction`
        yield Candidate(
            name="stribeck_exponent" if known else "slow_motion",
            columns=linear[:, k : k + 1],
            detail=f"below {speed:.2g} @/s",
            numbers=(("speed", float(speed), "/s"),),
            family=family,
        )
    for k, way in enumerate(ways):
        yield Candidate(
            name="presliding",
            columns=since[:, k : k + 1],
            detail=f"within {way:.2g} @",
            numbers=(("way", float(way), ""),),
            family=family,
        )
    every = np.hstack([linear[:, ::2], since])
    smooth = [each.columns for each in smooth_friction(fit)]
    if smooth and _explained(fit, smooth[0]) > _ENOUGH * _explained(fit, every):
        return  # one column explains nearly as much
    yield Candidate(name="slow_motion", columns=every, family=family)


def smooth_law() -> tuple[str, _core.Term]:
    """Return the name of the model with dry friction that rises with speed, and its term."""
    rising = {term.key: term for term in _core.terms() if term.settles and not term.at_rest}
    model, key = next((m.name, key) for m in _core.models() for key in m.terms if key in rising)
    return model, rising[key]


def smooth_friction(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield dry friction that is smaller at low speed, with the best speed; not with other low-speed friction."""
    if not _may_rise(fit):
        return
    _, law = smooth_law()
    power = _core.shape(law.shapes[0]).speed_power

    def columns(speeds: Array) -> Array:
        def less(_: int, run: Samples) -> Array:
            rises = [_core.friction_basis(law.key, run.velocity, [s**power]) for s in speeds]
            return np.column_stack(rises) - np.sign(run.velocity)[:, None]

        return fit.integral_of_each(less)

    speeds = typical_speed(fit) * np.array(_OF_RISES)
    for factors in _FINER:
        speeds = np.outer(speeds, factors).ravel()
        found = columns(speeds)
        gains = _signed_gains(fit, found)
        best = int(np.argmax(gains))
        speeds = speeds[best : best + 1]
    if gains[best] > 0.0:
        risen = float(_RISEN * speeds[0])
        yield Candidate(
            name="smooth_friction",
            columns=found[:, best : best + 1],
            detail=f"below {risen:.2g} @/s",
            numbers=(("speed", risen, "/s"),),
            family="slow_motion",
        )


def _may_rise(fit: FittedBalance) -> bool:
    """Return whether the model has dry friction and no other low-speed friction."""
    terms = [term for term in fit.terms if term is not None and term.friction]
    return any(t.settles for t in terms) and not any(t.shapes or t.side for t in terms)


def _explained(fit: FittedBalance, columns: Array) -> float:
    """Return the squared residual that columns explain together."""
    sizes = np.maximum(np.linalg.norm(fit.jacobian, axis=0), 1e-300)
    basis = np.linalg.qr(fit.jacobian / sizes)[0]
    rest = columns - basis @ (basis.T @ columns)
    left = fit.residual - rest @ np.linalg.lstsq(rest, fit.residual, rcond=1e-9)[0]
    return float(fit.residual @ fit.residual - left @ left)


def _signed_gains(fit: FittedBalance, columns: Array) -> Array:
    """Return the size of the residual that each column explains alone, with the sign of its coefficient."""
    sizes = np.maximum(np.linalg.norm(fit.jacobian, axis=0), 1e-300)
    basis = np.linalg.qr(fit.jacobian / sizes)[0]
    rest = columns - basis @ (basis.T @ columns)
    gains: Array = rest.T @ fit.residual / np.maximum(np.linalg.norm(rest, axis=0), 1e-300)
    return gains
