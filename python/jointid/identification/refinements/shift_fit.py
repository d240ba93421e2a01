"""The shift of one signal that a balance under smooth windows asks for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.identification.refinements.smooth_windows import SmoothWindows
from jointid.recording.order_statistics import median

Array = NDArray[np.float64]

_NEAR = 1e-5  # [s], the last step of the iteration
_LONGEST_STEP = 1e-3  # [s]
_STEPS = 6
_ROUNDS = 2  # of weights
_CLIPPED = 4.0  # medians of the residual's size: a window that misses by more counts for less
_CLUSTER = 0.3  # [s] of motion that counts as one observation
_ROWS = 256
_CLEARLY_SHORTER, _CLEAR_ERRORS = 0.5, 6.0
_SINGULAR = 1e-11  # of the largest eigenvalue of the scaled normal equations


@dataclass(frozen=True, kw_only=True)
class Balance:
    """Rows of a balance: a signal's window means are a sum of columns.

    Attributes
    ----------
    windows : sequence of SmoothWindows
        One for each stretch.
    signals : sequence of ndarray
        The signal of each stretch, sample by sample.
    columns : ndarray, shape (rows, columns)
        Over the used windows of all stretches in turn.
    conservative : int
        Number of columns, the first ones, that have nothing to do with friction.
    held : bool
        Whether the signal is held between samples: it then stands for the middle of the interval.
    """

    windows: Sequence[SmoothWindows]
    signals: Sequence[Array]
    columns: Array
    conservative: int
    held: bool


@dataclass(frozen=True, kw_only=True)
class Shift:
    """The delay of a signal.

    Attributes
    ----------
    value, stderr : float
        [s]
    conservative, friction : tuple of float
        Value and standard error that each part of the signal asks for by itself [s]: what has nothing to
        do with friction, and friction. Without friction the first only, twice.
    unexplained : float
        Variance that the columns leave, over that of the signal.
    """

    value: float
    stderr: float
    conservative: tuple[float, float]
    friction: tuple[float, float]
    unexplained: float

    def agrees(self, other: Shift, share: float) -> bool:
        """Whether another estimate is within three standard errors or a share of this delay."""
        apart = abs(self.value - other.value)
        errors = 3.0 * float(np.hypot(self.stderr, other.stderr))
        return apart <= max(errors, share * abs(self.value))

    def is_of_all(self, share: float) -> bool:
        """Whether both parts of the signal ask for the same delay."""
        apart = abs(self.conservative[0] - self.friction[0])
        errors = 3.0 * float(np.hypot(self.conservative[1], self.friction[1]))
        return apart <= max(errors, share * abs(self.value))


class _Shifted:
    """The window means of a signal at any shift: the smoothed signal between samples, by a cubic."""

    def __init__(self, balance: Balance) -> None:
        self._smooth = [
            np.convolve(signal, windows.weight, mode="same")
            for windows, signal in zip(balance.windows, balance.signals, strict=True)
        ]
        self._windows = balance.windows
        self._offset = 0.5 if balance.held else 0.0

    def __call__(self, delay: float) -> Array:
        parts = []
        for smooth, windows in zip(self._smooth, self._windows, strict=True):
            moved = delay / windows.stretch.period - self._offset
            whole = int(np.floor(moved))
            p = moved - whole
            k = np.clip(windows.used + whole, 1, len(smooth) - 3)
            parts.append(
                -p * (p - 1.0) * (p - 2.0) / 6.0 * smooth[k - 1]
                + (p + 1.0) * (p - 1.0) * (p - 2.0) / 2.0 * smooth[k]
                - (p + 1.0) * p * (p - 2.0) / 2.0 * smooth[k + 1]
                + (p + 1.0) * p * (p - 1.0) / 6.0 * smooth[k + 2]
            )
        return np.concatenate(parts)


class _Projection:
    """Weighted least squares on the columns, by scaled normal equations."""

    def __init__(self, columns: Array, weights: Array | None) -> None:
        self._columns = columns
        weighted = columns if weights is None else columns * weights[:, None]
        gram = _gram(columns, weighted)
        scale = np.sqrt(np.diag(gram))
        scale = np.where(scale > 0.0, scale, np.inf)
        values, vectors = np.linalg.eigh(gram / np.outer(scale, scale))
        known = values > _SINGULAR * values[-1]
        self._basis = (vectors[:, known] / np.sqrt(values[known])) / scale[:, None]
        self._weighted = weighted
        self.rank = int(np.count_nonzero(known))

    def coefficients(self, signal: Array) -> Array:
        return np.asarray(self._basis @ (self._basis.T @ (self._weighted.T @ signal)))

    def rest(self, signal: Array) -> Array:
        """What the columns leave of a signal."""
        return np.asarray(signal - self._columns @ self.coefficients(signal))


def _gram(columns: Array, others: Array) -> Array:
    """columns.T @ others in blocks of rows: a library with threads spends longer on waking them than on one."""
    whole = len(columns) // _ROWS * _ROWS
    width = columns.shape[1]
    blocks = np.matmul(
        columns[:whole].reshape(-1, _ROWS, width).transpose(0, 2, 1),
        others[:whole].reshape(-1, _ROWS, width),
    )
    return np.asarray(blocks.sum(axis=0) + columns[whole:].T @ others[whole:])


def fit_shift(
    balance: Balance, *, reach: float = 0.0, robust: bool = True, least: float = 0.0
) -> Shift | None:
    """Return the delay of the balance's signal; None where the rows are too few or say nothing.

    The signal's window means, shifted, are regressed on the columns and on their own rate of change, which
    is taken from the fitted columns: an instrument without the signal's noise, so that neither that noise
    nor the interpolation pulls the delay to a whole or a half sample.

    Parameters
    ----------
    balance : Balance
    reach : float
        Search from the shift of least misfit up to this [s]. Default 0: from no shift.
    robust : bool
        Whether windows that miss by far count for less. Default True.
    least : float
        A delay that is clearly shorter after one step is not refined [s]. Default 0.
    """
    rows, count = balance.columns.shape
    if rows < 3 * count + 20:
        return None
    shifted = _Shifted(balance)
    projection = _Projection(balance.columns, None)
    rate = _Rate(balance)
    delay = _least_misfit(balance, shifted, projection, reach) if reach > 0.0 else 0.0
    bound = 2.0 * reach if reach > 0.0 else 0.02
    weights = np.ones(rows)
    step, level, none = 0.0, np.zeros(rows), False
    for turn in range(_ROUNDS if robust else 1):
        for _ in range(_STEPS):
            level = shifted(delay)
            fitted = projection.coefficients(level)
            rest = level - balance.columns @ fitted
            slopes = np.column_stack([projection.rest(each) for each in rate(fitted)])
            total = slopes.sum(axis=1)
            energy = float(total @ (weights * total))
            if not energy > 0.0:
                return None
            step = -float(total @ (weights * rest)) / energy
            step = float(np.clip(step, -_LONGEST_STEP, _LONGEST_STEP))
            delay += step
            if abs(delay) > bound:
                return None
            if abs(step) < _NEAR or abs(delay) < _CLEARLY_SHORTER * least:
                break
        missed = rest + step * total
        noise = float(missed @ missed) / (rows - projection.rank)
        none = abs(delay) + _CLEAR_ERRORS * np.sqrt(noise / energy) < least
        if none:
            break
        if robust and turn < _ROUNDS - 1:
            size = np.abs(missed)
            weights = 1.0 / np.maximum(1.0, size / (_CLIPPED * median(size) + 1e-300))
            projection = _Projection(balance.columns, weights)
    groups = _clusters(balance.windows)
    own = _errors(total[:, None], missed, weights, groups, projection.rank)
    spread = level - level.mean()
    parts = ((delay, float(own[0])),) * 2
    if slopes.shape[1] > 1 and not none:
        matrix = slopes.T @ (weights[:, None] * slopes)
        apart = -np.linalg.pinv(matrix) @ (slopes.T @ (weights * rest))
        errors = _errors(slopes, rest + slopes @ apart, weights, groups, projection.rank)
        parts = tuple(  # type: ignore[assignment]
            (delay + float(d), float(e)) for d, e in zip(apart, errors, strict=True)
        )
    return Shift(
        value=float(delay),
        stderr=float(own[0]),
        conservative=parts[0],
        friction=parts[1],
        unexplained=float(missed @ missed) / max(float(spread @ spread), 1e-300),
    )


def coefficients(balance: Balance) -> Array:
    """Least squares of the signal, not shifted, on the columns."""
    return _Projection(balance.columns, None).coefficients(_Shifted(balance)(0.0))


def _least_misfit(
    balance: Balance, shifted: _Shifted, projection: _Projection, reach: float
) -> float:
    period = balance.windows[0].stretch.period
    count = int(min(48, np.ceil(2.0 * reach / min(0.5 * period, 5e-4))))
    found, least = 0.0, np.inf
    for delay in np.linspace(-reach, reach, count + 1):
        level = shifted(float(delay))
        rest = projection.rest(level)
        misfit = float(rest @ rest) / max(float(level @ level), 1e-300)
        if misfit < least:
            found, least = float(delay), misfit
    return found


class _Rate:
    """Rates of the parts of a fitted signal, from neighbouring windows; zero beside a window left out."""

    def __init__(self, balance: Balance) -> None:
        self._balance = balance
        self._parts = []
        for windows in balance.windows:
            place = np.full(len(windows.middles), -1)
            place[windows.kept] = np.arange(np.count_nonzero(windows.kept))
            before = np.concatenate([[-1], place[:-1]])[windows.kept]
            after = np.concatenate([place[1:], [-1]])[windows.kept]
            inside = (before >= 0) & (after >= 0)
            span = 2.0 * windows.stride * windows.stretch.period
            self._parts.append((before, after, np.where(inside, 1.0 / span, 0.0)))

    def __call__(self, fitted: Array) -> list[Array]:
        split, columns = self._balance.conservative, self._balance.columns
        levels = [columns[:, :split] @ fitted[:split]]
        if split < columns.shape[1]:
            levels.append(columns[:, split:] @ fitted[split:])
        return [self._of(level) for level in levels]

    def _of(self, level: Array) -> Array:
        rates, first = [], 0
        for before, after, factor in self._parts:
            mine = level[first : first + len(before)]
            rates.append((mine[after] - mine[before]) * factor)
            first += len(before)
        return np.concatenate(rates)


def _clusters(windows: Sequence[SmoothWindows]) -> NDArray[np.int64]:
    """The number of the piece of motion that each row belongs to."""
    groups, first = [], 0
    for each in windows:
        time = each.stretch.time
        length = min(_CLUSTER, (time[-1] - time[0]) / 20.0)
        mine = ((time[each.used] - time[0]) / length).astype(np.int64) + first
        groups.append(mine)
        first = int(mine[-1]) + 1 if len(mine) else first
    return np.concatenate(groups)


def _errors(
    slopes: Array, missed: Array, weights: Array, groups: NDArray[np.int64], rank: int
) -> Array:
    """Standard errors: the larger of the classical ones and those clustered over pieces of the motion."""
    gram = slopes.T @ (weights[:, None] * slopes)
    inverse = 1.0 / gram if gram.size == 1 else np.linalg.pinv(gram)
    scores = slopes * (weights * missed)[:, None]
    sums = np.column_stack([np.bincount(groups, column) for column in scores.T])
    used = max(2, int(np.count_nonzero(np.bincount(groups))))
    clustered = inverse @ (sums.T @ sums) @ inverse * used / (used - 1)
    noise = float(missed @ (weights * missed)) / max(1, len(missed) - rank - 1)
    return np.sqrt(np.maximum(np.diag(clustered), noise * np.diag(inverse)))
