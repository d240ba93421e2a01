"""Delay of a sensor from single samples with jumps in the motion, such as the acceleration at a reversal.

Smooth windows leave out reversals and smooth the rest. If the velocity is precise enough, the reading is compared with
inertia, gravity and a constant at each sample. The jumps show the delay to a fraction of a sample, but only for a
rigid link: an elastic gear responds to a jump late and with oscillations. The delay must therefore be pure: the
residual near jumps must not be larger than elsewhere.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.identification.refinements.shift_fit import Shift
from jointid.identification.refinements.stretches import Piece
from jointid.recording.order_statistics import median

Array = NDArray[np.float64]

# Largest noise, as a share of the squared changes of the acceleration. More noise biases the delay to half a sample.
_NOISE_SHARE = 0.02
_FEW = 200  # samples
_PARTS = 20  # grid of the residual within a sample
_CLIPPED = 4.0  # standard deviations of the reading's noise; larger residuals get a smaller weight
_ROUNDS = 3  # rounds of reweighting
_JUMP = 1.0  # standard deviations of the reading's noise
_NEAR = 3  # samples from a jump
_AS_ELSEWHERE = 1.25  # largest residual variance near jumps over that elsewhere, for a pure delay
_LEAST_ERROR = 0.05  # samples; error from changes within a sample, in addition to noise
_GRID = 4001
_UNLIKE = 3.5  # standard errors between both estimates
_RIDGE = 1e-12


def delay_by_samples(
    pieces: Sequence[Piece], smooth: Shift, reach: float, inertia: float
) -> Shift | None:
    """Return the reading's delay; None if noise of the motion, an elastic gear or too few samples prevent it.

    Parameters
    ----------
    pieces : sequence of Piece
        Pieces with a sensor.
    smooth : Shift
        Delay of the reading's smooth part. Its field `friction` has the delay of gravity.
    reach : float
        Longest delay [s].
    inertia : float
        Inertia of drive and link.
    """
    pieces = [piece for piece in pieces if not piece.stretch.derived]
    if not pieces or not inertia > 0.0 or sum(len(piece.torque) for piece in pieces) < _FEW:
        return None
    period = pieces[0].stretch.period
    most = int(np.ceil(reach / period)) + 1
    signals = [_Samples(piece, most, inertia) for piece in pieces]
    noise = sum(each.noise for each in signals)
    if not 2.0 * noise < _NOISE_SHARE * sum(each.change for each in signals):
        return None
    reading = np.concatenate([each.reading for each in signals])
    low = max(-most, int(np.floor((smooth.value - _UNLIKE * smooth.stderr) / period)) - 1)
    high = min(most, int(np.ceil((smooth.value + _UNLIKE * smooth.stderr) / period)) + 1)
    if low >= high:
        return None
    weights = np.ones(len(reading))
    found, missed, noise, curve = 0.0, reading, 0.0, 0.0
    for _ in range(_ROUNDS):
        profile = [
            (_Neighbours(signals, whole, reading, weights), whole) for whole in range(low, high)
        ]
        misfits = np.array([each.misfits() for each, _ in profile])
        place, part = np.unravel_index(int(np.argmin(misfits)), misfits.shape)
        neighbours, whole = profile[int(place)]
        found = whole + neighbours.least(int(part))
        missed = neighbours.missed(found - whole)
        noise = 1.4826 * median(np.abs(missed))
        if not noise > 0.0:
            return None
        weights = np.minimum(1.0, _CLIPPED * noise / np.maximum(np.abs(missed), 1e-300))
        curve = neighbours.curvature(found - whole)
        low, high = max(low, whole - 1), min(high, whole + 2)
    if not curve > 0.0:
        return None
    acceleration = neighbours.of_acceleration(found - whole)
    jumps = np.concatenate([each.near_jumps(found, acceleration, noise) for each in signals])
    ratio = _near_over_elsewhere(np.minimum(np.abs(missed), _CLIPPED * noise), jumps)
    if not ratio < _AS_ELSEWHERE:
        return None
    stderr = period * noise * np.sqrt(max(1.0, ratio) / curve)
    value = period * found
    return _combined(value, float(stderr), smooth, period)


def _near_over_elsewhere(missed: Array, near: NDArray[np.bool_]) -> float:
    """Return the residual variance near jumps over that elsewhere, reduced by what few samples explain by chance."""
    count, others = int(np.count_nonzero(near)), int(np.count_nonzero(~near))
    if count == 0 or others == 0:
        return 1.0 if count == 0 else np.inf
    ratio = float(np.mean(missed[near] ** 2)) / float(np.mean(missed[~near] ** 2))
    return ratio / (1.0 + 2.0 * float(np.sqrt(2.0 / count)))


def _combined(value: float, stderr: float, smooth: Shift, period: float) -> Shift | None:
    """Return the delay that agrees with both samples and gravity; None if no delay agrees with both.

    An interpolated reading spreads a jump over two samples and so shows any delay. An instantaneous reading shows
    the acceleration of a held torque at a whole sample. The delay is then anywhere up to the next sample, and
    only gravity shows where. Both kinds of reading have the same prior probability.
    """
    stderr = float(np.hypot(stderr, _LEAST_ERROR * period))
    gravity, error = smooth.friction
    low = min(value, gravity) - _UNLIKE * error - period
    high = max(value, gravity) + _UNLIKE * error + period
    delay = np.linspace(low, high, _GRID)
    spread = (delay - value) / stderr
    whole = (np.floor(delay / period) * period - value) / stderr
    apart = (delay - gravity) / error
    chance = (np.exp(-0.5 * spread**2) + np.exp(-0.5 * whole**2)) * np.exp(-0.5 * apart**2)
    if not chance.max() > np.exp(-0.5 * _UNLIKE**2):
        return None
    chance /= chance.sum()
    mean = float(chance @ delay)
    error = max(stderr, float(np.sqrt(chance @ (delay - mean) ** 2)))
    return _shift(mean, error, smooth)


def _shift(value: float, stderr: float, smooth: Shift) -> Shift:
    return Shift(
        value=value,
        stderr=stderr,
        conservative=(value, stderr),
        friction=(value, stderr),
        unexplained=smooth.unexplained,
    )


class _Samples:
    """One piece: regressors at every sample, and the reading at the samples that can be shifted."""

    def __init__(self, piece: Piece, most: int, inertia: float) -> None:
        assert piece.sensor is not None
        velocity = piece.stretch.velocity
        self._columns = np.column_stack([_acceleration(piece, inertia), *piece.circle])
        self._most = most + 2
        self._used = slice(self._most, len(velocity) - self._most)
        self.reading = piece.sensor[self._used]
        # Third differences of white noise; a few jumps do not change a median.
        third = median(np.abs(np.diff(self._columns[:, 0], 3)))
        self.noise = (1.4826 * third) ** 2 / 20.0
        self.change = float(np.mean(np.diff(self._columns[:, 0]) ** 2))

    def at(self, whole: int) -> Array:
        """Return the columns `whole` samples earlier."""
        first = self._used.start - whole
        return np.asarray(self._columns[first : first + len(self.reading)])

    def near_jumps(self, delay: float, inertia: float, noise: float) -> NDArray[np.bool_]:
        """Return which samples are near a jump of the acceleration that is visible in the reading."""
        acceleration = self.at(int(np.floor(delay)))[:, 0]
        jump = np.abs(np.diff(acceleration, prepend=acceleration[:1])) * abs(inertia)
        counts = np.convolve(jump > _JUMP * noise, np.ones(2 * _NEAR + 1), mode="same")
        return np.asarray(counts > 0.5)


def _acceleration(piece: Piece, inertia: float) -> Array:
    """Return the acceleration at each sample; with a held torque, at the end of the interval before it.

    Differences of the velocity are means over intervals. The mean after a sample is corrected by the torque's jump.
    A reversal in an interval makes its mean useless; the mean of the other side is then used.
    """
    velocity, period = piece.stretch.velocity, piece.stretch.period
    mean = np.diff(velocity) / period
    jump = np.diff(piece.torque[:-1]) if piece.held else np.zeros(len(mean) - 1)
    turned = velocity[1:] * velocity[:-1] <= 0.0
    after = mean[1:] - jump / inertia
    stuck = (velocity[1:-1] == 0.0) | (velocity[2:] == 0.0)
    after[stuck] = np.where(velocity[1:-1][stuck] == 0.0, 0.0, after[stuck])
    before = mean[:-1]
    found = 0.5 * (before + after)
    found = np.where(turned[:-1] & ~turned[1:], after, found)
    found = np.where(turned[1:] & ~turned[:-1], before, found)
    found = np.where(velocity[1:-1] == 0.0, 0.0, found)
    return np.concatenate([found[:1], found, found[-1:]])


class _Neighbours:
    """Normal equations of the reading on the columns of two neighboring delays, one sample apart."""

    def __init__(
        self, signals: Sequence[_Samples], whole: int, reading: Array, weights: Array
    ) -> None:
        first = np.vstack([each.at(whole) for each in signals])
        second = np.vstack([each.at(whole + 1) for each in signals])
        self._width = first.shape[1]
        ones = np.ones((len(first), 1))
        self._rows = np.hstack([first, second, ones])
        both = np.hstack([self._rows, reading[:, None]])
        self._gram = _gram(both, both * weights[:, None])
        self._reading = reading

    def _solved(self, part: float) -> tuple[Array, Array]:
        """Return the coefficients, and the interpolation between the columns of both delays."""
        width = self._width
        between = np.zeros((2 * width + 1, width + 1))
        between[:width, :width] = (1.0 - part) * np.eye(width)
        between[width : 2 * width, :width] = part * np.eye(width)
        between[-1, -1] = 1.0
        gram = between.T @ self._gram[:-1, :-1] @ between
        scale = 1.0 / np.sqrt(np.maximum(np.diag(gram), 1e-300))
        scaled = gram * np.outer(scale, scale) + _RIDGE * np.eye(width + 1)
        right = between.T @ self._gram[:-1, -1]
        return scale * np.linalg.solve(scaled, scale * right), between

    def _misfit(self, part: float) -> float:
        found, between = self._solved(part)
        whole = np.concatenate([-(between @ found), [1.0]])
        return float(whole @ self._gram @ whole)

    def misfits(self) -> Array:
        """Return the residual at an even grid between both delays."""
        return np.array([self._misfit(part) for part in np.linspace(0.0, 1.0, _PARTS + 1)])

    def least(self, near: int) -> float:
        """Return the fraction of the sample with the smallest residual, by a parabola."""
        step = 1.0 / _PARTS
        middle = min(max(near, 1), _PARTS - 1) * step
        before, here, after = (self._misfit(middle + k * step) for k in (-1, 0, 1))
        bend = before - 2.0 * here + after
        moved = 0.5 * (before - after) / bend if bend > 0.0 else 0.0
        return float(np.clip(middle + step * moved, 0.0, 1.0))

    def curvature(self, part: float) -> float:
        """Return the squared change of the reading per sample of delay, at free coefficients.

        Its ratio to the noise variance is the inverse variance of the delay.
        """
        found, between = self._solved(part)
        width = self._width
        rate = np.concatenate([-found[:width], found[:width], [0.0]])
        gram = self._gram[:-1, :-1]
        own = between.T @ gram @ between
        cross = between.T @ gram @ rate
        scale = 1.0 / np.sqrt(np.maximum(np.diag(own), 1e-300))
        scaled = own * np.outer(scale, scale) + _RIDGE * np.eye(width + 1)
        return float(rate @ gram @ rate - (scale * cross) @ np.linalg.solve(scaled, scale * cross))

    def missed(self, part: float) -> Array:
        """Return the residual of the reading."""
        found, between = self._solved(part)
        return np.asarray(self._reading - self._rows @ (between @ found))

    def of_acceleration(self, part: float) -> float:
        """Return the change of the reading for an acceleration of 1."""
        return float(self._solved(part)[0][0])


def _gram(columns: Array, others: Array) -> Array:
    """Return columns.T @ others, computed in blocks so that the threads of a library do not change the last bits."""
    rows = 256
    whole = len(columns) // rows * rows
    width = columns.shape[1]
    blocks = np.matmul(
        columns[:whole].reshape(-1, rows, width).transpose(0, 2, 1),
        others[:whole].reshape(-1, rows, width),
    )
    return np.asarray(blocks.sum(axis=0) + columns[whole:].T @ others[whole:])
