"""Delay of a sensor from its noise, which a controller with sensor feedback repeats in the torque.

Noise may hide the delay of the reading's smooth part. The same noise in the recorded torque shows the delay to a
fraction of a sample. No controller knows the noise before the sensor measures it. If the torque shows the noise before
the reading, the recorded reading is late.
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
        Pieces with this noise; each has a sensor.
    """

    shift: Shift
    share: float
    pieces: Sequence[Piece]

    @property
    def torque_over_reading(self) -> float:
        """Ratio of the torque's third differences to those of the reading."""
        reading = np.mean([_core.roughness(p.sensor) for p in self.pieces if p.sensor is not None])
        torque = np.mean([_core.roughness(piece.torque) for piece in self.pieces])
        return float(torque / reading)


def delay_in_command(pieces: Sequence[Piece]) -> Repeated | None:
    """Return the reading's delay relative to the torque; None if the torque does not repeat the reading's noise.

    Parameters
    ----------
    pieces : sequence of Piece
        Pieces with a sensor.
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
