"""A constant torque, which no motion can separate from different Coulomb frictions in the two directions.

While the joint moves, an offset has the same effect as more Coulomb friction in one direction and less in the other.
A recording determines only ``coulomb_positive + offset`` and ``coulomb_negative - offset``. The third direction of
these parameters is undetermined, even if a few samples at rest seem to determine it.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass

Array = NDArray[np.float64]

_SIGNS = {"coulomb_positive": 1.0, "coulomb_negative": -1.0}
_OFFSETS = {"torque_offset": -1.0, "sensor_offset": -1.0}
_ROLES = _SIGNS | _OFFSETS


@dataclass(frozen=True, slots=True, kw_only=True)
class Undivided:
    """Parameters that can change together without any effect.

    Attributes
    ----------
    change : mapping of str to float
        Direction of the change: parameter → 1 or -1, an offset first.
    """

    change: Mapping[str, float]

    @property
    def offset(self) -> str:
        """First offset; if it is fixed, the others are determined."""
        return next(iter(self.change))


def undivided(names: Collection[str]) -> tuple[Undivided, ...]:
    """Return the undetermined directions of free parameters with these names.

    Parameters
    ----------
    names : collection of str
        The free parameters; "torque_offset[1]" belongs to one recording.
    """
    runs = sorted({name.partition("[")[2] for name in names if name.partition("[")[0] in _ROLES})
    groups: list[dict[str, float]] = []
    for run in runs if len(runs) == 1 else [run for run in runs if run]:
        group = {}
        for role, sign in (_OFFSETS | _SIGNS).items():
            name = f"{role}[{run}" if run and f"{role}[{run}" in names else role
            if name in names:
                group[name] = sign
        if len(group) < len(_SIGNS) + 1:
            return ()  # one is known in one recording, which determines the others
        groups.append(group)
    joined: list[dict[str, float]] = []
    for group in groups:  # recordings with a shared parameter change together
        apart = []
        for other in joined:
            if group.keys() & other.keys():
                group = other | group
            else:
                apart.append(other)
        joined = [*apart, group]
    order = list(_OFFSETS) + list(_SIGNS)
    return tuple(
        Undivided(
            change=dict(
                sorted(g.items(), key=lambda e: (order.index(e[0].partition("[")[0]), e[0]))
            )
        )
        for g in joined
    )


def balanced(names: Sequence[str], lower: Array, upper: Array, values: Array) -> Array:
    """Return equivalent values with equal Coulomb frictions, or as equal as the bounds allow.

    All such values fit equally well; this choice is a convention.
    """
    free = [name for name, low, high in zip(names, lower, upper, strict=True) if low < high]
    result = values.copy()
    for each in undivided(free):
        places = [names.index(name) for name in each.change]
        signs = np.array(list(each.change.values()))
        coulomb = [
            [values[names.index(n)] for n in each.change if n.partition("[")[0] == role]
            for role in _SIGNS
        ]
        step = 0.5 * (float(np.mean(coulomb[1])) - float(np.mean(coulomb[0])))
        ends = np.sort(
            [(lower[places] - values[places]) / signs, (upper[places] - values[places]) / signs],
            axis=0,
        )
        step = float(np.clip(step, ends[0].max(), ends[1].min()))
        result[places] = np.clip(values[places] + step * signs, lower[places], upper[places])
    return result


def with_fixed_offset(
    names: Sequence[str], lower: Array, upper: Array, values: Array
) -> tuple[Array, Array]:
    """Return bounds that fix one offset of each undetermined group, so that a refit cannot drift."""
    low, high = lower.copy(), upper.copy()
    free = [name for name, a, b in zip(names, lower, upper, strict=True) if a < b]
    for each in undivided(free):
        place = names.index(each.offset)
        low[place] = high[place] = values[place]
    return low, high
