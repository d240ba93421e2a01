"""Travel of a joint, in encoder counts and relative to the noise."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.recording import Recording

WIDER = "a motion of at least some hundred encoder counts"
_FEWEST = 50.0  # encoder counts from the lowest position to the highest
_WIDEST = 12.0  # range of a million samples of white noise, in standard deviations
_LAGS = range(1, 5)  # samples
_ALIKE = 0.3  # correlation of positions at these lags: white noise has none


@dataclass(frozen=True, slots=True, kw_only=True)
class SmallMotion:
    """A motion of few encoder counts, or one that is lost in the noise.

    Attributes
    ----------
    travel, step : float
        [rad] or [m]. The step of a position without a grid is its smallest change.
    unchanged : float
        Share of samples without a change of position.
    noise : float
        Standard deviation of a position that is noise alone [rad or m]; 0 for a motion by encoder counts.
    text : str
        The travel as a sentence.
    details : str
        The evidence as a sentence.
    """

    travel: float
    step: float
    unchanged: float
    noise: float = 0.0
    text: str
    details: str

    @property
    def steps(self) -> float:
        """Travel in encoder counts."""
        return self.travel / self.step


def small_motion(recording: Recording) -> SmallMotion | None:
    """Return the motion of a recording if it is below 50 encoder counts or noise alone; otherwise None."""
    position = recording.position
    lowest, highest = recording.ranges["position"]
    travel = highest - lowest
    changes = np.abs(np.diff(position))
    largest = float(changes.max(initial=0.0))
    changes = changes[changes > 1e-9 * travel]  # smaller changes are rounding errors
    if not len(changes):
        return None
    step = float(changes.min())
    unchanged = 1.0 - len(changes) / (len(position) - 1)
    unit = recording.unit("position")
    # The noise estimate is the median of differences of third and higher order. Differences of neighbours bound it.
    noise = 0.0 if travel >= 2.0 * _WIDEST * largest else _noise_alone(recording, travel)
    if noise > 0.0:
        return SmallMotion(
            travel=travel,
            step=step,
            unchanged=unchanged,
            noise=noise,
            text=f"the joint stands still: its position varies by {travel:.2g} {unit}, like noise",
            details=f"the noise has a standard deviation of {noise:.2g} {unit}; or the joint moves too "
            "fast for this sampling rate",
        )
    if travel >= _FEWEST * step:
        return None
    return SmallMotion(
        travel=travel,
        step=step,
        unchanged=unchanged,
        text=f"the joint hardly moves: only by {travel:.3g} {unit}, {travel / step:.0f} encoder counts",
        details=f"one encoder count is {step:.3g} {unit}; {100.0 * unchanged:.0f} % of the samples show no change of "
        "position",
    )


def _noise_alone(recording: Recording, travel: float) -> float:
    """Return the position's standard deviation if it is white noise; otherwise 0.

    A motion with few samples per period has as large differences of neighbours, but it is correlated at some lag.
    """
    found = recording.derived.position_noise
    if found.quantum > 0.0 or travel >= _WIDEST * found.sigma:
        return 0.0
    position = recording.position - recording.position.mean()
    variance = float(np.mean(position**2))
    alike = [float(np.mean(position[lag:] * position[:-lag])) / variance for lag in _LAGS]
    return float(np.sqrt(variance)) if max(map(abs, alike)) < _ALIKE else 0.0


def raise_if_still(recordings: Sequence[Recording]) -> None:
    """Raise `InputError` if the position of one of the recordings never changes."""
    for number, recording in enumerate(recordings):
        lowest, highest = recording.ranges["position"]
        if lowest != highest:
            continue
        unit, fastest = recording.unit("position"), max(map(abs, recording.ranges["velocity"]))
        turns = not recording.velocity_derived and fastest > 0.0
        seen = f", although the velocity reaches {fastest:.3g} {recording.unit('velocity')}"
        raise InputError(
            f"the joint never moves: its position is {lowest:.6g} {unit} throughout{seen if turns else ''}",
            place=f"recording {number}{f' ({recording.name})' if recording.name else ''}",
            remedy=(
                *(("leave this recording out",) if len(recordings) > 1 else ()),
                Action("record", text="motion: a joint at rest shows no friction"),
                Action("inspect", text="which column is the position"),
            ),
        )


def raise_if_hardly_moving(recordings: Iterable[Recording]) -> None:
    """Raise `InputError` if one of the recordings moves by less than 50 encoder counts, or is noise alone."""
    for number, recording in enumerate(recordings):
        small = small_motion(recording)
        if small is not None:
            raise InputError(
                f"{small.text}; {small.details}",
                argument="recordings",
                place=f"recording {number}",
                remedy=f"record {WIDER}",
            )
