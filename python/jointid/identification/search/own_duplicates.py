"""Refusal of own terms that duplicate another term, because the data cannot divide the torque between them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.identification.search.domain import SearchDomain
from jointid.joint.own_terms import OwnTerms
from jointid.problem.problem import Problem

Array = NDArray[np.float64]

# Share of a column's squares that other columns do not explain; below it, the column is a duplicate. Two methods to
# differentiate one signal, and intervals with a reversal, leave about 1e-5, which must not determine a coefficient.
_SAME = 1e-4
_NOISE = 4.0  # factor on the squared change of a column in a repeated measurement
_NAMED = 0.01  # smallest named part of a sum, relative to the largest part
_NOTHING = 1e-12  # smallest size of a column, relative to the torque


def refuse_duplicates(
    penalty: _core.Penalty, domain: SearchDomain, own: OwnTerms, again: Callable[[], Problem]
) -> None:
    """Refuse an own term with a free coefficient if its column equals another column or a sum of others.

    Columns count as equal if a repeated measurement with its noise changes them as much as they differ. Fixed terms may
    be equal, because their torques are only subtracted.

    Parameters
    ----------
    penalty : Penalty
    domain : SearchDomain
    own : OwnTerms
    again : callable
        Function that returns the problem with the noise of a repeated measurement.

    Raises
    ------
    InputError
        Two terms are equal; the error names both.
    """
    if not own.each:
        return
    count = penalty.coefficients
    names = list(penalty.names[:count])
    shapes = np.sqrt(np.maximum(domain.lower[count:] * domain.upper[count:], 0.0))
    columns = np.asarray(penalty.columns(shapes))
    sizes = np.linalg.norm(columns, axis=0)
    level = float(np.linalg.norm(np.asarray(penalty.target)))
    present = sizes > _NOTHING * level
    sizes_or_one = np.where(present, sizes, 1.0)
    scaled = columns / sizes_or_one
    mine = [
        index
        for index, name in enumerate(names)
        if name.partition("[")[0] in own.keys_in_core and present[index]
    ]
    free = [not domain.fixed(name) for name in names]
    products = np.einsum("ni,nj->ij", scaled, scaled)
    repeated = _columns_again(again(), penalty, shapes)
    changed = np.zeros_like(scaled) if repeated is None else repeated / sizes_or_one - scaled
    for index in [index for index in mine if free[index]]:
        others = [k for k in range(count) if k != index and free[k] and present[k]]
        if float(changed[:, index] @ changed[:, index]) > 1.0 / _NOISE:
            raise _no_signal(names[index])
        for other in others:
            if 1.0 - products[index, other] ** 2 < _SAME:
                raise _refused(names[index], [names[other]], "the same torque as")
        if not others:
            continue
        found, *_ = np.linalg.lstsq(scaled[:, others], scaled[:, index], rcond=1e-12)
        whole = np.zeros(count)
        whole[index], whole[others] = 1.0, -found
        left = float(np.sum(np.square(np.einsum("ni,i->n", scaled, whole))))
        noise = float(np.sum(np.square(np.einsum("ni,i->n", changed, whole))))
        if left < max(_SAME, _NOISE * noise):
            parts = np.abs(found) > _NAMED * np.abs(found).max()
            alike = [names[k] for k, part in zip(others, parts, strict=True) if part]
            raise _refused(
                names[index], alike, "a sum of" if len(alike) > 1 else "the same torque as"
            )


def _columns_again(problem: Problem, penalty: _core.Penalty, shapes: Array) -> Array | None:
    """Return the penalty's columns from a repeated measurement; None if its windows differ."""
    options = _core.WindowOptions(
        duration=penalty.window_duration, cumulative=bool(penalty.cumulative)
    )
    try:
        again = problem.penalty(options)
    except InputError:  # with the added noise, the joint seems to stand still
        return None
    same = np.array_equal(again.windows, penalty.windows)
    return np.asarray(again.columns(shapes)) if same else None


def _no_signal(name: str) -> InputError:
    return InputError(
        "the signal of this term changes less than its noise in these recordings",
        argument="terms",
        value=name,
        remedy=("leave the term out", Action("record", text="motion in which the signal changes")),
    )


def _refused(name: str, others: list[str], relation: str) -> InputError:
    alike = " and ".join(others)
    return InputError(
        f"this term is always {relation} {alike} in these recordings, so the data cannot separate the terms",
        argument="terms",
        value=name,
        remedy=(
            "leave one of these terms out",
            Action("call", {"parameters": {name: ...}}, text="which fixes it"),
        ),
    )
