"""Physically consistent inertial parameters, for an estimate with free inertia."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import two_digits
from jointid.robot.links.bodies import possible
from jointid.robot.links.possible_bodies import nearest_possible
from jointid.robot.result.finding_types import TYPES
from jointid.robot.result.result import RobotEstimate

if TYPE_CHECKING:
    from jointid.robot.balance.fit import Fit
    from jointid.robot.links.link_tree import LinkTree

Array = NDArray[np.float64]

_SINGULAR = 1e-6  # smallest eigenvalue of correlations


def with_possible_bodies(estimate: RobotEstimate, fit: Fit) -> RobotEstimate:
    """Return the estimate with physically consistent links, or with the finding that there are none near enough.

    Base parameters and friction do not change. If bodies can have exactly these base parameters, the links get them.
    Otherwise, if the distance may be chance, the links are the nearest consistent ones.
    """
    prior = fit.columns.prior
    if prior is None:  # without masses in the URDF, nothing selects one of many links
        return replace(estimate, consistent=possible(estimate.inertial))
    places = [place for place, (joint, _) in enumerate(fit.labels) if joint is None]
    found = nearest_possible(
        fit.values[places],
        prior.of_links,
        _precision(estimate, fit, places),
        prior.urdf.reshape(-1, 10),
        _discs(estimate.robot.tree, fit.columns.dropped),
    )
    if found.by_chance:
        return replace(
            estimate,
            inertial=found.inertial,
            consistent=True,
            impossible_by=found.distance,
        )
    return replace(estimate, consistent=False, impossible_by=found.distance)


def impossible_links(estimate: RobotEstimate) -> Iterator[Finding]:
    """Yield the finding that no bodies have the identified base parameters."""
    if estimate.consistent is not False or estimate.impossible_by is None:
        return
    distance = two_digits(estimate.impossible_by)
    yield TYPES["impossible_inertia"].finding(
        f"the base parameters are {distance} standard errors away from physically consistent values",
        details="no bodies can have the identified parameters; friction and the torque of motion may still be right",
        severity="info",
        evidence={"distance": Measured(estimate.impossible_by)},
    )


def _discs(tree: LinkTree, motors: Sequence[int]) -> Array:
    """Return what a unit of motor inertia adds to the moved links, as flat discs about the joints' axes."""
    turning = [motor for motor in motors if not tree.prismatic[motor]]
    found = np.zeros((tree.inertias.size, len(turning)))
    for column, motor in enumerate(turning):
        axis = tree.axes[motor]
        inertia = 0.5 * (np.eye(3) + np.outer(axis, axis))
        xx, xy, xz, yy, yz, zz = inertia[np.triu_indices(3)]
        found[10 * motor + 4 : 10 * motor + 10, column] = xx, xy, yy, xz, yz, zz
    return found


def _precision(estimate: RobotEstimate, fit: Fit, places: list[int]) -> Array:
    """Return the inverse of the base parameters' covariance, including their prior."""
    free = np.cumsum(~fit.at_bound) - 1
    mine = free[places]
    covariance = estimate.covariance[np.ix_(mine, mine)]
    known = np.flatnonzero(np.isfinite(np.diag(covariance)) & (np.diag(covariance) > 0.0))
    precision = np.zeros((len(places), len(places)))
    part = covariance[np.ix_(known, known)]
    scale = np.sqrt(np.diag(part))
    # With fewer segments than parameters, the correlation matrix is nearly singular.
    values, vectors = np.linalg.eigh(part / np.outer(scale, scale))
    inverse = (vectors / np.maximum(values, _SINGULAR)) @ vectors.T
    precision[np.ix_(known, known)] = inverse / np.outer(scale, scale)
    if estimate.draws is not None and estimate.draws.cells.sure_square is not None:
        precision += estimate.draws.cells.sure_square[np.ix_(places, places)]
    return precision
