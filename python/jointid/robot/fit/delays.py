"""Delay of the torque against the position: the shift with the smallest residual in the balances of all joints.

The integral of a shifted torque over a window changes with the shift by the torque's difference between the window's
ends. So the shift is one more column, in addition to all parameters of the fit. Each joint gives its own delay. The
value on which joints agree is the common delay, and its error is at least the scatter of these delays.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.balance.windows import torque_integrals
from jointid.robot.balance.balance import Balance
from jointid.robot.balance.fit import Fit
from jointid.robot.fit.excerpt_rows import ExcerptRows
from jointid.robot.motion.motion import Motion

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

_ROUNDS = 8
_FAR, _FAR_ERRORS = 5e-4, 3.0  # [s] and standard errors: distance from the delay of the slope
_NEAR = 2e-5  # [s], largest last step
_STEP = 5e-4  # [s], step of the derivative of the torque by the shift
_LONGEST_STEP, LONGEST = 4e-3, 0.05  # [s]
_COARSE = 2.5e-3  # [s], step of the coarse grid
_FINEST = 1e-4  # [s]: least error of a joint's delay in comparison with the others
_SMALL = 3e-4  # [s]; a shorter delay is not removed
_WITHIN_SAMPLE = 0.06  # sample periods: friction and torque jump between samples
_SURE = 5.0  # standard errors
_APART, _SURE_OF_ONE = (
    1e-3,
    8.0,
)  # [s] and standard errors, required for a different delay of one joint
_APART_OF_LONG = 0.3  # of a delay: with a long delay, the reversals are not yet at their place
_BETTER = 3.0  # standard errors by which the residual of held-out stretches falls


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TorqueDelay:
    """Delay of the torque against the position [s]; positive: the torque is late."""

    value: float  # common delay of the joints that agree
    stderr: float
    joints: Array  # (n,), own delay of each joint
    errors: Array  # standard errors of `joints`
    # (n,), delay to remove: the common delay, a clearly different delay of one joint, or 0
    taken: Array
    # True if `taken` is not 0 and improves the prediction of held-out stretches
    certain: bool

    @property
    def sure(self) -> bool:
        """Whether the delay is too large to be chance."""
        return abs(self.value) > _SURE * self.stderr


def torque_delay(balance: Balance, fit: Fit, motions: Mapping[int, Motion]) -> TorqueDelay:
    """Return the torque's delay; all parameters of the fit are refitted with the shift.

    `motions` are some of the balance's pieces, by number.
    """
    rows = ExcerptRows(balance, fit, motions)
    torque = ShiftedTorque(motions, balance)
    n = fit.scatter.size
    measured = torque(np.zeros(n))

    def at(delay: Array) -> tuple[Array, Array]:
        """Return the residual with these delays, and the derivative of the torque's integrals by them."""
        slope = (torque(delay + _STEP) - torque(delay - _STEP)) / (2.0 * _STEP)
        return rows.residual + rows.rest(torque(delay) - measured), slope

    common, delay = True, np.zeros(n)
    for turn in range(_ROUNDS):
        rest, slope = at(delay)
        if common:
            change = rows.rest(slope)
            step = -float(change @ rest) / (float(change @ change) or np.inf)
            common = abs(step) >= _NEAR and turn < _ROUNDS // 2
            delay = _within(delay, np.full(n, step))
            if common:
                continue
            rest = rest + step * change
        each = rows.rest(np.where(rows.joint[:, None] == np.arange(n), slope[:, None], 0.0))
        inverse = np.linalg.pinv(each.T @ each)
        own = -inverse @ (each.T @ rest)
        scores = each * (rest + each @ own)[:, None]
        sums = np.column_stack([np.bincount(rows.cluster, column) for column in scores.T])
        errors = np.sqrt(np.diag(inverse @ (sums.T @ sums) @ inverse))
        errors = np.where(np.any(each, axis=0) & (errors > 0.0), errors, np.inf)
        far = (np.abs(own) > _FAR) & (np.abs(own) > _FAR_ERRORS * errors)
        if turn == _ROUNDS - 1 or not far.any():
            break
        # too far from the delay at which the slope was computed
        delay = _within(delay, np.where(far, own, 0.0))
    joints = delay + own
    first = next(iter(motions.values()))
    period = float(np.median(np.diff(first.time)))
    driven = first.driven is not None
    value, stderr, alike = _common(joints, errors, 0.0 if driven else _WITHIN_SAMPLE * period)
    taken = np.zeros(n)
    # A held torque starts at its sample. If it seems early by less than a sample, this is noise of the positions.
    small = period if value < 0.0 and first.torque_held else _SMALL
    # A command is always late, and a remaining delay looks like friction and inertia.
    if (driven or abs(value) > max(small, _SURE * stderr)) and 2 * np.count_nonzero(alike) > n:
        taken[:] = value
    alone = ~alike & (np.abs(joints) > np.maximum(_APART, _SURE_OF_ONE * errors))
    taken[alone] = joints[alone]
    better = (
        taken.any()
        and not driven
        and rows.share((torque(taken) - measured)[:, None]).certainty > _BETTER
    )
    return TorqueDelay(
        value=value,
        stderr=stderr,
        joints=joints,
        errors=errors,
        taken=taken,
        certain=bool(better or driven),
    )


def _within(delay: Array, step: Array) -> Array:
    limited = np.clip(step, -_LONGEST_STEP, _LONGEST_STEP)
    return np.asarray(np.clip(delay + limited, -LONGEST, LONGEST))


def _common(joints: Array, errors: Array, least: float) -> tuple[float, float, Flags]:
    """Return the mean of the joints' delays, its error, and which joints agree: near the weighted median."""
    weights = 1.0 / (errors**2 + _FINEST**2)
    order = np.argsort(joints)
    middle = int(np.searchsorted(np.cumsum(weights[order]), 0.5 * weights.sum()))
    centre = joints[order[min(middle, joints.size - 1)]]
    apart = max(_APART, _APART_OF_LONG * abs(float(centre)))
    alike = np.abs(joints - centre) <= np.maximum(apart, _SURE_OF_ONE * errors)
    if not weights.any():  # no joint has information
        return 0.0, np.inf, alike
    mine, share = joints[alike], weights[alike] / weights[alike].sum()
    value = float(share @ mine)
    scatter = float(share @ (mine - value) ** 2) / max(mine.size - 1, 1)
    of_errors = float(1.0 / np.sqrt(np.sum(weights[alike])))
    return value, float(np.sqrt(max(scatter, of_errors**2) + least**2)), alike


def coarse_delay(balance: Balance, fit: Fit, motions: Mapping[int, Motion]) -> float:
    """Return the common delay on a grid with the smallest residual; far from the minimum, slopes do not lead to it."""
    rows = ExcerptRows(balance, fit, motions, free=True)
    torque, n = ShiftedTorque(motions, balance), fit.scatter.size
    residual = rows.rest(fit.residual[rows.kept])
    measured = torque(np.zeros(n))
    grid = np.arange(-_COARSE, LONGEST + _COARSE, _COARSE)
    left = [
        np.sum((residual + rows.rest(torque(np.full(n, late)) - measured)) ** 2) for late in grid
    ]
    return float(grid[int(np.argmin(left))])


class ShiftedTorque:
    """Integrals of the torques of some pieces, for any shift."""

    def __init__(self, motions: Mapping[int, Motion], balance: Balance) -> None:
        rows = balance.rows
        kept = np.isin(rows.piece, list(motions))
        joint, piece, self._window = rows.joint[kept], rows.piece[kept], rows.window[kept]
        self._motions, self._summings = motions, balance.summings
        self._places = [
            (number, each, np.flatnonzero((piece == number) & (joint == each)))
            for number in motions
            for each in range(len(balance.places))
        ]

    def __call__(self, delay: Array) -> Array:
        """Return each row's integral for these delays of its joint's torque."""
        found, last = np.empty(self._window.size), None
        for piece, joint, mine in self._places:
            motion, summing = self._motions[piece], self._summings[piece]
            if piece != last:
                torques, last = motion.torque_late_by(delay), piece
            pushed = torque_integrals(torques[joint], summing.step, motion.torque_held)
            found[mine] = summing(joint, pushed)[self._window[mine]]
        return found
