"""How far a joint moves, in steps of its encoder."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.recording import Recording

WIDER = "a motion of at least some hundred steps of the encoder"
_FEWEST = 50.0  # steps from the lowest position to the highest


@dataclass(frozen=True, slots=True, kw_only=True)
class SmallMotion:
    """A motion of few steps.

    Attributes
    ----------
    travel, step : float
        [rad] or [m].
    unchanged : float
        Share of the samples without a change of position.
    text : str
        The same as a sentence.
    """

    travel: float
    step: float
    unchanged: float
    text: str

    @property
    def steps(self) -> float:
        """Travel in steps."""
        return self.travel / self.step


def small_motion(recording: Recording) -> SmallMotion | None:
    """Return the motion of a recording if it is less than 50 steps of the encoder, else None."""
    position = recording.position
    travel = float(position.max() - position.min())
    changes = np.abs(np.diff(position))
    changes = changes[changes > 1e-9 * travel]  # others are rounding errors
    if not len(changes):
        return None
    step = float(changes.min())
    if travel >= _FEWEST * step:
        return None
    unchanged = 1.0 - len(changes) / (len(position) - 1)
    unit = recording.unit("position")
    return SmallMotion(
        travel=travel,
        step=step,
        unchanged=unchanged,
        text=f"the joint hardly moves: {travel:.3g} {unit} in all, {travel / step:.0f} steps of its encoder "
        f"({step:.3g} {unit}), and no change of position in {100.0 * unchanged:.0f} % of the samples",
    )


def raise_if_hardly_moving(recordings: Iterable[Recording]) -> None:
    """Raise `InputError` if one of the recordings is a motion of less than 50 steps of the encoder."""
    for number, recording in enumerate(recordings):
        small = small_motion(recording)
        if small is not None:
            raise InputError(
                small.text,
                argument="recordings",
                place=f"recording {number}",
                remedy=f"record {WIDER}",
            )
