"""A sensor's delay by its own noise: a controller that feeds the reading back repeats its noise in the torque.

The reading is drowned in noise where the delay of its smooth part is to be found; the same noise in the recorded
torque tells it to a part of a sample. No controller knows a reading's noise before the sensor shows it, so a torque
that repeats the noise before the reading does proves that the recorded reading is late.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jointid import _core
from jointid.base.values import dataclass
from jointid.identification.refinements.shift_fit import Shift
from jointid.identification.refinements.stretches import Piece


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
    found = _core.repeated_noise(
        [(piece.sensor, piece.torque) for piece in pieces if piece.sensor is not None]
    )
    if found is None:
        return None
    period = pieces[0].stretch.period
    value, stderr = found.earlier * period, found.error * period
    shift = Shift(
        value=value,
        stderr=stderr,
        conservative=(value, stderr),
        friction=(value, stderr),
        unexplained=0.0,
    )
    return Repeated(shift=shift, share=found.share, pieces=pieces)
