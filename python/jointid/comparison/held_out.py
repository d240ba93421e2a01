"""Folds of a cross-validation: the recordings to fit, and the held-out blocks to predict."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from jointid.balance.held_out import block_starts, groups_of
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.estimate.prediction import FittedModel, TorquePredictor
from jointid.problem.window_table import WindowTable
from jointid.recording.recording import Recording


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """A part of a recording, including both ends.

    Attributes
    ----------
    recording : Recording
        The whole recording: windows, mask and velocities in the block are taken from it.
    start, stop : float
        Ends of the block [s], on the recording's clock.
    """

    recording: Recording
    start: float
    stop: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Fold:
    """One split: recordings to fit, and held-out blocks."""

    training: tuple[Recording, ...]
    held_out: tuple[Block, ...]

    def residual(self, fitted: FittedModel, predictor: TorquePredictor) -> float:
        """Return the relative residual of the held-out windows: norm of the torque's residuals over norm of the torque.

        The torque is predicted from the motion, and from the reading if there is a sensor. This does not depend on the
        fitted residual, so it is the same signal for every model.

        Parameters
        ----------
        fitted : FittedModel
            Model fitted to `training`.
        predictor : TorquePredictor
            Predictor for several fits of one model.

        Raises
        ------
        InputError
            The held-out torque is zero.
        """
        missed = measured = 0.0
        for block in self.held_out:
            found = predictor.predicted(fitted, block.recording)
            inside = (found.start >= block.start) & (found.stop <= block.stop)
            missed += float(np.sum(found.residual[inside] ** 2))
            measured += float(np.sum(found.torque[inside] ** 2))
        if measured == 0.0:
            raise InputError(
                "the torque is zero in the held-out part",
                argument="folds",
                remedy="use fewer folds",
            )
        return float(np.sqrt(missed / measured))


def folds_by_block(recording: Recording, windows: WindowTable, count: int) -> tuple[Fold, ...]:
    """Cut one recording into contiguous blocks with equal numbers of windows; each is held out once.

    The training recording has a gap in place of the block, and no window crosses a gap.

    Parameters
    ----------
    windows : WindowTable
        Windows of the whole recording; there are none at standstill.
    count : int
        Number of blocks.

    Raises
    ------
    InputError
        There are too few windows for this number of blocks.
    """
    edges = [-np.inf, *block_starts(windows.start, count).tolist(), np.inf]
    return tuple(
        Fold(
            training=(_without(recording, start, stop),),
            held_out=(Block(recording=recording, start=start, stop=stop),),
        )
        for start, stop in itertools.pairwise(edges)
    )


def folds_by_recording(recordings: Sequence[Recording], count: int) -> tuple[Fold, ...]:
    """Return folds that hold out whole recordings: each alone, or in `count` groups if there are more."""
    return tuple(
        Fold(
            training=tuple(run for index, run in enumerate(recordings) if index not in group),
            held_out=tuple(
                Block(recording=recordings[index], start=-np.inf, stop=np.inf) for index in group
            ),
        )
        for group in groups_of(len(recordings), count)
    )


def _without(recording: Recording, start: float, stop: float) -> Recording:
    """Return the recording without the samples from start to stop; the sample at stop is kept."""
    kept = (recording.time < start) | (recording.time >= stop)
    return recording.with_signals(rows=kept)
