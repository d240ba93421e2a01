"""Own terms that say the same as another term: refused by name, because nothing divides the torque between them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.identification.search.domain import SearchDomain
from jointid.joint.own_terms import OwnTerms

Array = NDArray[np.float64]

_SAME = 1e-4  # of a column's squares that another column leaves
_SPANNED = 1e-9  # of a column's squares that all others together leave
_NAMED = 0.01  # of the largest part in a sum
_NOTHING = 1e-12  # of the torque's size


def refuse_duplicates(penalty: _core.Penalty, domain: SearchDomain, own: OwnTerms) -> None:
    """Refuse an own term whose column is that of another term, or a sum of others.

    Parameters
    ----------
    penalty : Penalty
    domain : SearchDomain
    own : OwnTerms

    Raises
    ------
    InputError
        Names both.
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
    scaled = columns / np.where(present, sizes, 1.0)
    mine = [
        index
        for index, name in enumerate(names)
        if name.partition("[")[0] in own.keys_in_core and present[index]
    ]
    free = [not domain.fixed(name) for name in names]
    products = np.einsum("ni,nj->ij", scaled, scaled)
    for index in mine:
        for other in range(count):
            both = free[index] and free[other]
            if other == index or not present[other] or not (both or other in mine):
                continue
            if 1.0 - products[index, other] ** 2 < _SAME and (both or free[index] == free[other]):
                raise _refused(names[index], [names[other]], "the same torque as")
    for index in [index for index in mine if free[index]]:
        others = [k for k in range(count) if k != index and free[k] and present[k]]
        if not others:
            continue
        found, *_ = np.linalg.lstsq(scaled[:, others], scaled[:, index], rcond=1e-12)
        left = scaled[:, index] - scaled[:, others] @ found
        if float(left @ left) < _SPANNED:
            parts = np.abs(found) > _NAMED * np.abs(found).max()
            alike = [names[k] for k, part in zip(others, parts, strict=True) if part]
            raise _refused(names[index], alike, "a sum of")


def _refused(name: str, others: list[str], relation: str) -> InputError:
    alike = " and ".join(others)
    return InputError(
        f"it is {relation} {alike} throughout these recordings, so nothing divides the torque between them",
        argument="terms",
        value=name,
        remedy=(
            "leave one of them out",
            Action("call", {"parameters": {name: ...}}, text="which fixes it"),
        ),
    )
