"""Disturbances: residuals that are concentrated in a few short stretches of time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.identification.causes.fitted_balance import FittedBalance
from jointid.recording.order_statistics import quantile

Array = NDArray[np.float64]

_LENGTH = 0.03  # length of a stretch, as a share of the windows
_MOST = 3  # largest number of stretches
_ALONE, _TOGETHER = 0.6, 0.8  # smallest share of the residual in one stretch, or in several
_OTHER, _MORE = 0.3, 0.3
_SLOW = 0.2  # share of the windows that count as slow
_ROUNDS = 3  # refits, because the effect of a disturbance on the fit hides part of it


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LocalEvent:
    """Stretches of time with most of the residual.

    Attributes
    ----------
    rows : ndarray of bool, shape (windows,)
        Windows of the event.
    share : float
        Share of the squared residual in these windows.
    torque : float
        Largest mean torque of such a window [N·m or N].
    text : str
        Times of the stretches.
    stretches : int
        Number of stretches.
    slow : bool
        Whether most of the residual there comes from windows in which the joint hardly moves.
    """

    rows: NDArray[np.bool_]
    share: float
    torque: float
    text: str
    stretches: int
    slow: bool

    def stands_out(self, share: float) -> bool:
        """Return whether the event explains clearly more than a cause with this share of the whole residual."""
        if self.stretches > 1:
            return share < _OTHER
        return self.share > share + _MORE * (1.0 - share)


def local_event(fit: FittedBalance, base: Array, residual: Array) -> LocalEvent | None:
    """Return the stretches with most of the remaining residual; None if it is spread out."""
    length = max(3, round(_LENGTH * len(residual)))
    if len(residual) < 20 * length:
        return None
    keep = np.ones(len(residual), dtype=bool)
    left = residual
    for _ in range(_ROUNDS):  # refit without the stretches, then search again
        steps = fit.solve(np.where(keep[:, None], base, 0.0), np.where(keep, residual, 0.0))
        steps[: len(fit.start)] -= fit.start
        left = residual + base @ steps
        stretches = _stretches(left**2, length)
        keep = np.ones(len(residual), dtype=bool)
        for low, high in stretches:
            keep[low:high] = False
    share = float(np.sum(left[~keep] ** 2) / max(np.sum(left**2), 1e-300))
    if not stretches or share < (_ALONE if len(stretches) == 1 else _TOGETHER):
        return None
    means = left / fit.duration
    highest = int(np.argmax(np.where(keep, 0.0, np.abs(means))))
    return LocalEvent(
        rows=~keep,
        share=share,
        torque=float(means[highest]),
        text=_when(fit, stretches),
        stretches=len(stretches),
        slow=_is_slow(fit, np.where(keep, 0.0, left**2)),
    )


def _is_slow(fit: FittedBalance, power: Array) -> bool:
    speed = fit.integral_of_each(lambda _, run: np.abs(run.velocity)) / fit.duration
    slow = speed < quantile(speed, _SLOW)
    return float(power[slow].sum()) > 0.5 * float(power.sum())


def _stretches(power: Array, length: int) -> list[tuple[int, int]]:
    """Return the stretches with the most power: one if it has enough, otherwise a few, or none."""
    found: list[tuple[int, int]] = []
    left = power.copy()
    total = float(power.sum())
    held = 0.0
    while len(found) < _MOST:
        run = np.concatenate([[0.0], np.cumsum(left)])
        sums = run[length:] - run[:-length]
        low = int(np.argmax(sums))
        held += float(sums[low])
        found.append((low, low + length))
        left[low : low + length] = 0.0
        if held > (_ALONE if len(found) == 1 else _TOGETHER) * total:
            return found
    return []


def _when(fit: FittedBalance, stretches: list[tuple[int, int]]) -> str:
    spans = fit.spans
    texts = []
    for low, high in sorted(stretches):
        run = int(fit.run[low])
        last = min(high - 1, int(np.searchsorted(fit.run, run + 1)) - 1)
        place = f" of recording {run}" if len(fit.runs) > 1 else ""
        texts.append(f"{spans[low, 0]:.4g} to {spans[last, 1]:.4g} s{place}")
    return " and ".join(texts)
