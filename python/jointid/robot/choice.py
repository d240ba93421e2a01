"""Which joints have static friction: those whose held-out torque it predicts better."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance import Rows
from jointid.robot.decays import DecaySolution

Array = NDArray[np.float64]

_FOLDS = 8  # stretches of time, held out in turn
_CLEAR = 1.0  # standard errors by which the misfit falls


def with_static(
    found: DecaySolution, matrix: Array, wanted: Array, rows: Rows, joints: tuple[int, ...]
) -> tuple[int, ...]:
    """Return the joints that need static friction.

    Each stretch of time is predicted from the others, with static friction of all joints and without that of one. It
    is kept where it makes the joint's own prediction better by more than its scatter over the stretches. A decay at
    the bound of its range, or no static friction above 0, is none.

    Parameters
    ----------
    found : DecaySolution
        With the static friction of all `joints`.
    matrix : ndarray, shape (rows, parameters)
        The other columns.
    wanted : ndarray, shape (rows,)
    rows : Rows
    joints : tuple of int
    """
    weight = 1.0 / found.solution.scatter[rows.joint]
    table = np.column_stack([matrix, found.columns, wanted]) * weight[:, None]
    norms = np.linalg.norm(table, axis=0)
    table /= np.where(norms > 0.0, norms, 1.0)
    folds = _folds(rows)
    count = len(found.solution.scatter)
    products = np.zeros((_FOLDS, count, table.shape[1], table.shape[1]))
    for fold in range(_FOLDS):
        for joint in range(count):
            mine = table[(folds == fold) & (rows.joint == joint)]
            products[fold, joint] = mine.T @ mine
    every = np.arange(table.shape[1] - 1)
    kept = []
    for place, joint in enumerate(joints):
        if found.at_bound[place]:
            continue
        without = np.delete(every, matrix.shape[1] + place)
        fall = _misfits(products, without, joint) - _misfits(products, every, joint)
        scatter = float(np.std(fall, ddof=1)) * np.sqrt(_FOLDS)
        if fall.sum() > _CLEAR * scatter:
            kept.append(joint)
    return tuple(kept)


def _folds(rows: Rows) -> NDArray[np.int64]:
    """Stretches of equal time, through all recordings."""
    span = np.array(
        [rows.stop[rows.recording == k].max(initial=0.0) for k in np.unique(rows.recording)]
    )
    begun = np.concatenate([[0.0], np.cumsum(span)])
    index = np.searchsorted(np.unique(rows.recording), rows.recording)
    instant = begun[index] + rows.start
    low, high = float(instant.min()), float(instant.max())
    share = (instant - low) / ((high - low) or 1.0)
    return np.minimum((share * _FOLDS).astype(np.int64), _FOLDS - 1)


def _misfits(products: Array, columns: NDArray[np.int64], joint: int) -> Array:
    """Squared residuals of a joint in each stretch, with the values that the others give."""
    target = products.shape[-1] - 1
    whole = products.sum(axis=(0, 1))
    found = np.empty(_FOLDS)
    for fold in range(_FOLDS):
        rest = whole - products[fold].sum(axis=0)
        values = np.linalg.lstsq(
            rest[np.ix_(columns, columns)], rest[columns, target], rcond=1e-12
        )[0]
        held = products[fold, joint]
        found[fold] = (
            held[target, target]
            - 2.0 * values @ held[columns, target]
            + values @ held[np.ix_(columns, columns)] @ values
        )
    return found
