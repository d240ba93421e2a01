"""Errors of parameters when an offset and the difference of two Coulomb frictions look the same in the data."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.balance.covariance import Covariance
from jointid.identification.search.domain import SearchDomain
from jointid.joint.joint import Joint
from jointid.problem.constant_torque import Undivided

_SYMMETRY = "10 %"  # tolerance of the symmetry of Coulomb friction, if the joint sets none
_NORMAL = 1.959964


def divided(free: list[int], names: list[str], groups: tuple[Undivided, ...]) -> list[int]:
    """Return the free parameters without one offset of each group, because only these have a covariance."""
    dropped = {each.offset for each in groups}
    return [index for index in free if names[index] not in dropped]


def with_undivided(
    spread: Covariance,
    kept: list[int],
    free: list[int],
    names: list[str],
    groups: tuple[Undivided, ...],
) -> Covariance:
    """Return the covariance of all free parameters from that of the kept ones.

    A dropped offset gets an infinite variance and no covariance. The other parameters of its group keep the covariance
    at a fixed offset. It gives the variance of each determined quantity, such as the sum of both Coulomb
    frictions. The standard error of each parameter of the group is infinite.
    """
    if not groups:
        return spread
    count = len(free)
    places = [free.index(index) for index in kept]
    matrix = np.zeros((count, count))
    matrix[np.ix_(places, places)] = spread.matrix
    onto = np.zeros((count, len(kept)))
    onto[places] = np.eye(len(kept))
    correlation = np.eye(count)
    correlation[np.ix_(places, places)] = spread.correlation
    stderr = np.zeros(count)
    stderr[places] = spread.stderr
    freedom = np.full(count, spread.freedom.min(initial=np.inf))
    freedom[places] = spread.freedom
    weakest = np.zeros(count)
    for each in groups:
        members = [free.index(names.index(name)) for name in each.change]
        signs = np.array(list(each.change.values()))
        dropped = free.index(names.index(each.offset))
        matrix[dropped, dropped] = np.inf
        for name, sign in each.change.items():  # a common change of the group has no information
            if name != each.offset and names.index(name) in kept:
                onto[dropped, kept.index(names.index(name))] = -sign / each.change[each.offset]
        stderr[members] = np.inf
        correlation[members, :] = correlation[:, members] = 0.0
        correlation[np.ix_(members, members)] = np.outer(signs, signs)
        weakest[members] = signs
    return replace(
        spread,
        matrix=matrix,
        information=onto @ spread.information @ onto.T,
        stderr=stderr,
        freedom=freedom,
        correlation=correlation,
        condition=float("inf"),
        weakest=weakest / np.linalg.norm(weakest),
    )


def of_symmetry(
    joint: Joint | None, domain: SearchDomain, best: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """Return the error of a sensor offset because friction is not equal in both directions.

    If the model has symmetric friction, the offset contains half the difference of the two directions, and no log
    separates both. The tolerance counts as a 95 % interval. Return None without Coulomb friction or a free offset.
    """
    tolerances = (Joint() if joint is None else joint).tolerances
    if tolerances.symmetry is None:
        tolerances = replace(tolerances, symmetry=_SYMMETRY)
    moved = np.zeros(len(best))
    for index, name in enumerate(domain.names):
        base, _, run = name.partition("[")
        if base == "sensor_offset" and not domain.fixed(name):
            dry = "coulomb"
            own = f"{dry}[{run}"
            dry = own if own in domain.names else dry
            if dry in domain.names:
                value = float(best[domain.names.index(dry)])
                moved[index] = (tolerances.size("symmetry", value) or 0.0) / _NORMAL
    return moved if moved.any() else None
