"""A sensor's delay by its own noise: a controller that feeds the reading back repeats its noise in the torque.

The reading is drowned in noise where the delay of its smooth part is to be found; the same noise in the recorded
torque tells it to a part of a sample. No controller knows a reading's noise before the sensor shows it, so a torque
that repeats the noise before the reading does proves that the recorded reading is late.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.identification.refinements.shift_fit import Shift
from jointid.identification.refinements.stretches import Piece

Array = NDArray[np.float64]

_LAG = 9  # samples, the longest
_CLIPPED = 4.0  # standard deviations of a difference: a reversal's jump is not noise
_AUTOCORRELATION = (20.0, -15.0, 6.0, -1.0)  # of the third differences of white noise
_REACH = len(_AUTOCORRELATION) - 1
_SURE = 8.0  # standard errors of the noise's share in the torque
_EXPLAINED = 0.9  # of the cross-correlation, by one delay
_BLOCKS = 60  # of the recording, whose spread gives the standard errors
_ANSWER = 0.1  # samples: how far the joint's own answer to the noise moves the delay


@dataclass(frozen=True, kw_only=True)
class Repeated:
    """Noise of the reading that the torque repeats.

    Attributes
    ----------
    shift : Shift
    share : float
        Correlation of both noises.
    pieces : sequence of Piece
        In which it was seen, each with a sensor.
    """

    shift: Shift
    share: float
    pieces: Sequence[Piece]

    @property
    def torque_over_reading(self) -> float:
        """How large the torque's third differences are, over those of the reading."""
        reading = np.mean([_core.roughness(p.sensor) for p in self.pieces if p.sensor is not None])
        torque = np.mean([_core.roughness(piece.torque) for piece in self.pieces])
        return float(torque / reading)


def delay_in_command(pieces: Sequence[Piece]) -> Repeated | None:
    """Return the reading's delay against the torque; None where the torque does not repeat the reading's noise.

    Parameters
    ----------
    pieces : sequence of Piece
        Each with a sensor.
    """
    products = [_products(piece) for piece in pieces if piece.sensor is not None]
    means = np.concatenate([each for each in products if len(each)] or [np.zeros((0, 1))])
    if len(means) < _BLOCKS // 2:
        return None
    seen = means.mean(axis=0)
    # Each two neighbouring delays share the noise between them; their normal equations are alike.
    kernel = _taps()
    matched, gram = kernel.T @ seen, kernel.T @ kernel
    pairs = np.column_stack([matched[:-1], matched[1:]])
    shares_of = np.linalg.inv(gram[:2, :2])
    both = pairs @ shares_of
    explained = np.where(both.prod(axis=1) >= 0.0, (pairs * both).sum(axis=1), 0.0)
    place = int(np.argmax(explained))
    most, found = float(explained[place]), place - _LAG + _REACH
    if most < _EXPLAINED * float(seen @ seen):
        return None
    shares = means @ kernel[:, place : place + 2] @ shares_of
    first, second = shares.mean(axis=0)
    spread = np.cov(shares.T) / len(shares)
    total = float(first + second)
    if not total > _SURE * float(np.sqrt(spread.sum())):
        return None
    part = float(second) / total
    slope = np.array([-part, 1.0 - part]) / total
    error = float(np.hypot(np.sqrt(slope @ spread @ slope), _ANSWER))
    period = pieces[0].stretch.period
    value, stderr = (found + part) * period, error * period
    shift = Shift(
        value=value,
        stderr=stderr,
        conservative=(value, stderr),
        friction=(value, stderr),
        unexplained=0.0,
    )
    return Repeated(shift=shift, share=total, pieces=pieces)


def _products(piece: Piece) -> Array:
    """Of each block: means of the reading's differences times the torque's, by how much earlier the torque is."""
    assert piece.sensor is not None
    count = len(piece.sensor) - 3
    blocks = max(2, round(_BLOCKS * count / max(count, 6000)))
    return np.asarray(
        _core.noise_products(
            piece.sensor, piece.torque, blocks=blocks, longest=_LAG, clipped=_CLIPPED
        )
    )


def _taps() -> Array:
    """The cross-correlation of a torque that repeats the noise so many samples earlier, a column each."""
    lags = np.arange(-_LAG, _LAG + 1)
    shape = np.zeros(2 * _LAG + 1)
    shape[: len(_AUTOCORRELATION)] = _AUTOCORRELATION
    apart = np.abs(lags[:, None] - lags[_REACH:-_REACH])
    return np.asarray(shape[apart] / shape[0])
