"""Held-out scores of candidate models, and reasons to refuse a candidate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.identification.selection.candidate_models import Candidate
from jointid.identification.selection.columns import ShapedColumns
from jointid.problem.block_sums import BlockSums, Fitted

Array = NDArray[np.float64]

# Number of held-out blocks, pieces per block, and fewest windows per piece. The pieces of a block are spread over the
# recordings, because a motion may be slow in one part only.
_BLOCKS, _PIECES, _FEWEST = 10, 4, 4
# A coefficient below this number of its standard errors is not significant, as in the finding model_too_rich.
_SIGNIFICANT = 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """Held-out score of one candidate.

    Attributes
    ----------
    candidate : Candidate
    parameters : int
        Number of free parameters, including shapes.
    missed : ndarray, shape (blocks,)
        Sum of squared residuals of each held-out block.
    refused : str
        Why the candidate must not be chosen; empty if it may.
    """

    candidate: Candidate
    parameters: int
    missed: Array
    refused: str


def held_out(windows: int) -> list[NDArray[np.int64]]:
    """Return the windows of each block that is held out in turn; fewer than two blocks for few windows."""
    pieces = min(_BLOCKS * _PIECES, windows // _FEWEST)
    blocks = min(_BLOCKS, pieces)
    ends = np.linspace(0, windows, pieces + 1).round().astype(np.int64)
    return [
        np.concatenate([np.arange(ends[i], ends[i + 1]) for i in range(block, pieces, blocks)])
        for block in range(blocks)
    ]


def entry_of(candidate: Candidate, columns: ShapedColumns, sums: BlockSums) -> Entry:
    """Fit a candidate without each block in turn, predict that block, and return the score."""
    choice = candidate.choice
    fitted = sums.fitted(columns.combined(choice))
    blocks = np.arange(fitted.missed.shape[1])
    nearest = np.argmin(fitted.training, axis=0)  # each block's shape is fitted to the other blocks
    free = columns.free(choice)
    return Entry(
        candidate=candidate,
        parameters=len(free) + (columns.shapes_of(choice) and columns.free_shape),
        missed=fitted.missed[nearest, blocks],
        refused=_refusal(fitted, columns, candidate),
    )


def _refusal(fitted: Fitted, columns: ShapedColumns, candidate: Candidate) -> str:
    """Return why the data do not support a model with Stribeck friction; empty if they do."""
    choice = candidate.choice
    if not columns.shapes_of(choice):
        return ""
    best = int(np.argmin(fitted.penalty))
    if columns.free_shape and best in (0, len(columns.shapes) - 1):
        return "its shape parameter ends on a bound"
    left = fitted.coefficients[best]
    spread = np.square(left - left.mean(axis=0)).sum(axis=0)
    errors = np.sqrt((len(left) - 1) / len(left) * spread)  # the jackknife over blocks
    for place, index in enumerate(columns.free(choice)):
        term = _core.term(columns.keys[index])
        value = fitted.whole[best, place]
        if term.friction and term.shapes and value < _SIGNIFICANT * errors[place]:
            return f"its {term.name} friction is not significant"
        if term.friction and term.non_negative and value < -_SIGNIFICANT * errors[place]:
            return f"its {term.name} friction is negative"
    return ""
