"""What held-out torque decides: which joints have static friction, and how much the URDF's inertias say."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance import Rows
from jointid.robot.decays import DecaySolution
from jointid.robot.solving import Known, Solution

Array = NDArray[np.float64]

_FOLDS = 8  # stretches of time, held out in turn
_CERTAINTIES = (1.0, 3.0, 10.0, 30.0, 100.0)
_CLEAR = 1.0  # standard errors by which the misfit falls


def with_static(
    found: DecaySolution,
    matrix: Array,
    wanted: Array,
    rows: Rows,
    joints: tuple[int, ...],
    known: Known,
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
    known : Known
        Of the other columns' parameters beforehand.
    """
    full = np.hstack([matrix, found.columns])
    products, norms = _products(full, wanted, rows, found.solution.scatter)
    said = known.padded(len(joints))
    beforehand = np.column_stack([said.matrix, said.wanted]) / norms
    every = np.arange(full.shape[1])
    whole = _misfits(products, beforehand, every)
    kept = []
    for place, joint in enumerate(joints):
        if found.at_bound[place]:
            continue
        without = np.delete(every, matrix.shape[1] + place)
        fall = (_misfits(products, beforehand, without) - whole)[:, joint]
        scatter = float(np.std(fall, ddof=1)) * np.sqrt(_FOLDS)
        if fall.sum() > _CLEAR * scatter:
            kept.append(joint)
    return tuple(kept)


def certainty(
    matrix: Array, wanted: Array, rows: Rows, plain: Solution, known: Known
) -> tuple[float, Known]:
    """Return how certain the URDF's inertias are made, as a factor, and what is then known of the parameters.

    Base parameters are many; of a short motion each fits some of its noise. They are held near the URDF's by as much as
    makes the prediction of held-out stretches best, and not at all nearer than weakly if nothing is gained by it.
    """
    if not known.wanted.size:
        return 0.0, known
    products, norms = _products(matrix, wanted, rows, plain.scatter)
    every = np.arange(matrix.shape[1])
    found = []
    for factor in _CERTAINTIES:
        said = known.tightened(factor)
        beforehand = np.column_stack([said.matrix, said.wanted]) / norms
        found.append(float(_misfits(products, beforehand, every).sum()))
    factor = _CERTAINTIES[int(np.argmin(found))]
    return factor, known.tightened(factor)


def _products(matrix: Array, wanted: Array, rows: Rows, scatter: Array) -> tuple[Array, Array]:
    """Products of the weighted, scaled columns with each other and the target, by stretch and joint; the scales."""
    table = np.column_stack([matrix, wanted]) / scatter[rows.joint][:, None]
    norms = np.linalg.norm(table, axis=0)
    norms = np.where(norms > 0.0, norms, 1.0)
    table /= norms
    folds, count = _folds(rows), len(scatter)
    products = np.zeros((_FOLDS, count, table.shape[1], table.shape[1]))
    for fold in range(_FOLDS):
        for joint in range(count):
            mine = table[(folds == fold) & (rows.joint == joint)]
            products[fold, joint] = mine.T @ mine
    return products, norms


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


def _misfits(products: Array, beforehand: Array, columns: NDArray[np.int64]) -> Array:
    """Squared residuals of each stretch and joint, with the values that the other stretches give."""
    target = products.shape[-1] - 1
    whole = products.sum(axis=(0, 1)) + beforehand.T @ beforehand
    found = np.empty(products.shape[:2])
    for fold in range(_FOLDS):
        rest = whole - products[fold].sum(axis=0)
        values = np.linalg.lstsq(
            rest[np.ix_(columns, columns)], rest[columns, target], rcond=1e-12
        )[0]
        for joint, held in enumerate(products[fold]):
            found[fold, joint] = (
                held[target, target]
                - 2.0 * values @ held[columns, target]
                + values @ held[np.ix_(columns, columns)] @ values
            )
    return found
