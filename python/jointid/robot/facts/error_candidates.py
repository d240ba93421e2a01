"""Small errors of facts. Each is one to four further columns; the error that explains most is the cause.

Examples are a tilted base, a zero that is off by a few degrees, a torque constant, an unknown body, a link's weight
or its centre of mass. Each changes the balances of all joints in its own pattern. The explained share of a column is
counted on stretches of motion that were not used for its value.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance.inertia import moment_columns
from jointid.robot.fit.attempt import Attempt
from jointid.robot.fit.excerpt_rows import ExcerptRows, Share
from jointid.robot.fit.fact_derivatives import moved_zeros, tilted_gravity
from jointid.robot.links.inertia_modes import FREE, SCALED
from jointid.robot.links.robot import Robot

Array = NDArray[np.float64]

_EXPLAINED = 0.03  # of the held-out squared residual
_CERTAIN = 2.0  # standard errors of that share, by its scatter over stretches
_WALD = 150.0  # Wald statistic per column; so large because the model's errors also exceed chance
_AS_GOOD = 0.93  # of the best explained share: above it, a simpler cause is preferred
_SETTLED = 0.02  # of an error: the remainder that is ignored
_MAY_BE = 0.97  # of the best explained share: above it, another cause is also named
TILT, ZERO, TORQUE, LINK, CENTRE, PAYLOAD = (
    *("tilted_base", "wrong_zero", "wrong_torque_scale"),
    *("wrong_inertia", "wrong_centre", "payload"),
)
_MATTERS = {
    TILT: np.deg2rad(1.0),
    ZERO: np.deg2rad(1.0),
    TORQUE: 0.03,
    LINK: 0.05,
    CENTRE: 0.005,  # [m]
    PAYLOAD: 0.02,  # of the robot's moving mass
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SmallError:
    """A small error of a fact.

    Its values depend on the kind. Tilt: further gravity along the base's two other axes, relative to gravity. Zero:
    missing angle or distance [rad or m]. Torque or link: scale minus 1. Centre: further first moments [kg·m]. Payload:
    mass, then first moments.
    """

    kind: str  # one of the names above, which are also codes of findings
    joint: int | None  # joint of the zero, torque or link
    values: Array
    errors: Array
    # explained share of the squared residuals of held-out stretches, weighted by joint
    share: float
    given: Robot  # with the facts as stated
    robot: Robot  # with the fact corrected
    others: tuple[tuple[str, int | None], ...] = ()  # kinds and joints that explain nearly as much


_Told = tuple[str, int | None, Share]
"""Kind, joint, and explained share."""


def small_errors(attempt: Attempt) -> list[SmallError]:
    """Return the small error that explains most of an attempt's residual, or an empty list.

    A simpler error that explains nearly as much comes before it. The residuals after correction decide.
    """
    found = [
        (kind, joint, share)
        for kind, joint, share in _shares(attempt)
        if share.share > _EXPLAINED
        and share.certainty > _CERTAIN
        and share.wald > _WALD
        and _size(attempt, kind, joint, share.values) > _MATTERS[kind]
        and not (kind in (TORQUE, LINK) and share.values[0] <= -1.0)  # a wrong sign, or no body
    ]
    if not found:
        return []
    best = max(found, key=lambda each: each[2].share)
    near = [each for each in found if each[2].share >= _AS_GOOD * best[2].share]
    simple = min(near, key=lambda each: (each[2].values.size, -each[2].share))
    simpler = simple[2].values.size < best[2].values.size
    return [_error(attempt, near, each) for each in ((simple, best) if simpler else (simple,))]


def _error(attempt: Attempt, near: list[_Told], of: _Told) -> SmallError:
    """Return one of several errors that explain nearly the same, with the alternatives."""
    kind, joint, share = of
    best = max(each.share for _, _, each in near)
    others = tuple(
        (other, place)
        for other, place, each in near
        if (other, place) != (kind, joint)
        and each.share >= _MAY_BE * best
        and each.values.size == share.values.size
    )
    return SmallError(
        kind=kind,
        joint=joint,
        values=share.values,
        errors=share.errors,
        share=share.share,
        given=attempt.robot,
        robot=_corrected(attempt, kind, joint, share.values),
        others=others,
    )


def refined(error: SmallError, attempt: Attempt) -> SmallError | None:
    """Return the error plus the remainder that a corrected attempt shows, or None if the remainder is negligible.

    The balances change with a tilt or a zero by sine and cosine. The first step follows their slope, so that a
    remainder is left.
    """
    if error.kind not in (TILT, ZERO):
        return None
    share = next(
        share
        for kind, joint, share in _shares(attempt)
        if (kind, joint) == (error.kind, error.joint)
    )
    if np.linalg.norm(share.values) < _SETTLED * np.linalg.norm(error.values):
        return None
    other = _corrected(attempt, error.kind, error.joint, share.values)
    return replace(error, robot=other, errors=share.errors)


def tilts(gravity: Array) -> Array:
    """Return two directions perpendicular to gravity, with gravity's size, shape (2, 3)."""
    size = float(np.linalg.norm(gravity))
    axes = np.eye(3)[np.argsort(np.abs(gravity), kind="stable")[:2]]
    first = np.cross(gravity, np.cross(axes[0], gravity))
    first = first / np.linalg.norm(first)
    return size * np.array([first, np.cross(gravity / size, first)])


def _shares(attempt: Attempt) -> Iterator[tuple[str, int | None, Share]]:
    """Yield the explained share of each possible error, with its kind and joint."""
    robot, balance, fit = attempt.robot, attempt.balance, attempt.fit
    rows = ExcerptRows(balance, fit, attempt.excerpts, free=True)
    mechanics = (robot.tree, balance, rows, attempt.excerpts, fit.inertial)
    if np.linalg.norm(robot.tree.gravity) > 0.0:
        axes = tilts(robot.tree.gravity)
        yield TILT, None, rows.share(tilted_gravity(*mechanics, axes))
    zeros = moved_zeros(*mechanics)
    for joint in np.flatnonzero(~np.array(robot.tree.prismatic)).tolist():
        yield ZERO, joint, rows.share(zeros[:, joint : joint + 1])
    # A joint's modelled torque is the column of its scale. Without friction, this torque also depends on other joints.
    explained = (balance.rows.torque - fit.residual)[rows.kept]
    for joint in range(robot.n):
        mine = np.where(rows.joint == joint, explained, 0.0)
        yield TORQUE, joint, rows.share(mine[:, None])
    if attempt.estimate.inertia == FREE:
        return
    inertia = balance.inertia[rows.kept]
    for link in range(robot.n):
        moments = inertia[:, moment_columns(robot, link)]
        if attempt.estimate.inertia != SCALED:
            yield LINK, link, rows.share(inertia[:, link : link + 1])
        yield CENTRE, link, rows.share(moments[:, 1:])
        if link not in robot.tree.parents:
            yield PAYLOAD, link, rows.share(moments)


def _size(attempt: Attempt, kind: str, joint: int | None, values: Array) -> float:
    inertias = attempt.robot.tree.inertias
    if kind == CENTRE:
        return float(np.linalg.norm(values)) / max(float(inertias[joint, 0]), 1e-300)
    if kind == PAYLOAD:
        # A payload makes the link heavier.
        return float(values[0]) / float(inertias[:, 0].sum())
    return float(np.linalg.norm(values))


def _corrected(attempt: Attempt, kind: str, joint: int | None, values: Array) -> Robot:
    robot = attempt.robot
    if kind == TILT:
        gravity = robot.tree.gravity + values @ tilts(robot.tree.gravity)
        gravity *= np.linalg.norm(robot.tree.gravity) / np.linalg.norm(gravity)
        return replace(robot, tree=replace(robot.tree, gravity=gravity))
    if kind == ZERO:
        offsets = np.array(robot.zero_offsets or (0.0,) * robot.n)
        offsets[joint] += values[0]
        return replace(robot, zero_offsets=tuple(offsets.tolist()))
    if kind == TORQUE:
        scales = np.array(robot.torque_scales or (1.0,) * robot.n)
        scales[joint] /= 1.0 + values[0]
        return replace(robot, torque_scales=tuple(scales.tolist()))
    inertias = robot.tree.inertias.copy()
    if kind == LINK:
        inertias[joint] *= 1.0 + values[0]
    elif kind == CENTRE:
        inertias[joint, 1:4] += values
    else:
        inertias[joint, :4] += values
    return replace(robot, tree=replace(robot.tree, inertias=inertias))
