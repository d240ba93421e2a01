"""Errors of parameters where nothing divides an offset from the difference of two Coulomb frictions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from jointid.identification.inference.covariance import Covariance
from jointid.problem.constant_torque import Undivided


def divided(free: list[int], names: list[str], groups: tuple[Undivided, ...]) -> list[int]:
    """Return the free parameters without one offset of each group: those have a covariance."""
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

    An offset that was dropped has an infinite variance and no covariance, the others of its group keep
    theirs at a given offset: of whatever is determined, such as the sum of the two Coulomb frictions, the
    variance follows. Their own standard errors are infinite.
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
        for name, sign in each.change.items():  # along the change of all there is no information
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
