"""Choices by held-out torque: which joints have a shaped term, and how much weight the URDF's inertias have."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance.products import FOLDS, Products, powers, weighted
from jointid.robot.balance.shaped_terms import ShapedSolution, ShapedTerms
from jointid.robot.balance.solving import PriorRows, Solution

Array = NDArray[np.float64]

_CERTAINTIES = (1.0, 3.0, 10.0, 30.0, 100.0)
_CLEAR = 1.0  # standard errors by which the residual falls


def with_shapes(
    found: ShapedSolution, products: Products, shaped: ShapedTerms, prior: PriorRows
) -> tuple[int, ...]:
    """Return the joints that need their shaped term, such as static friction.

    `products` and `prior` are those of the other columns. Each stretch of time is predicted from the other stretches,
    with the shaped terms of all joints and without the term of one joint. The term is kept if it improves the joint's
    own prediction by more than the scatter over the stretches. A term with its shape at the bound of the range, or
    with a coefficient of 0, is not kept.
    """
    joints = shaped.joints
    every = np.arange(products.columns + len(joints))
    lengths = np.concatenate([products.norms[:-1], shaped.norms, products.norms[-1:]])
    prior_product = prior.padded(len(joints)).scaled(lengths)
    scatter = found.solution.scatter
    whole = held_out_misfits(found.sums, prior_product, scatter, every)
    kept = []
    for place, joint in enumerate(joints):
        if found.at_bound[place]:
            continue
        without = np.delete(every, products.columns + place)
        fall = (held_out_misfits(found.sums, prior_product, scatter, without) - whole)[:, joint]
        if fall.sum() > _CLEAR * float(np.std(fall, ddof=1)) * np.sqrt(FOLDS):
            kept.append(joint)
    return tuple(kept)


def certainty(products: Products, plain: Solution, prior: PriorRows) -> tuple[float, PriorRows]:
    """Return the certainty of the URDF's inertias, as a factor, and the resulting prior of the parameters.

    There are many base parameters, and in a short motion each fits some of the noise. The prior holds them near the
    URDF's values. The factor is the one that gives the best prediction of held-out stretches.
    """
    if not prior.target.size:
        return 0.0, prior
    every = np.arange(products.columns)
    found = []
    for factor in _CERTAINTIES:
        prior_product = prior.tightened(factor).scaled(products.norms)
        found.append(
            float(held_out_misfits(products.sums, prior_product, plain.scatter, every).sum())
        )
    factor = _CERTAINTIES[int(np.argmin(found))]
    return factor, prior.tightened(factor)


def held_out_misfits(
    sums: Array, prior_product: Array, scatter: Array, columns: NDArray[np.int64]
) -> Array:
    """Return the weighted squared residuals of each stretch and joint, with values fitted to the other stretches."""
    both = np.append(columns, sums.shape[-1] - 1)
    part = sums[:, :, both[:, None], both]
    each = np.array([weighted(fold, scatter) for fold in part])
    whole = each.sum(axis=0) + prior_product[np.ix_(both, both)]
    found = np.empty(sums.shape[:2])
    for fold in range(FOLDS):
        rest = whole - each[fold]
        values = np.linalg.lstsq(rest[:-1, :-1], rest[:-1, -1], rcond=1e-12)[0]
        found[fold] = powers(part[fold], values) / scatter**2
    return found
