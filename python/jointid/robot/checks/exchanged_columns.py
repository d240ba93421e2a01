"""Check whether the joints' columns, or only their torques, are in another order than the robot's joints."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.checks.link_factors import LinkFactor, link_factor, link_rows
from jointid.robot.links.robot import Robot
from jointid.robot.motion.column_order import reordered
from jointid.robot.motion.plain_motion import plain_signals, stretches
from jointid.robot.result.finding_types import TYPES, listed, titled

Array = NDArray[np.float64]
Whole = NDArray[np.int64]
Order = tuple[int, ...]

_STRETCHES = 2  # stretches of the recordings for each order that is tried
_LEAST = 1e-4  # of a squared torque: a smaller residual does not decide between orders
_CLEARLY = 0.5  # summed fall of the logarithms of the squared residuals: required for an exchange
_WELL = 0.1  # of the torques, root mean square: residual of the right order at most, and of a wrong order at least
_POOR = 0.05  # of the torques: a smaller residual is not examined
_BETTER = 0.1  # of the squared residual of the original order


@dataclass(frozen=True, slots=True, kw_only=True)
class _Found:
    order: Order
    score: float
    left: float  # mean residual, relative to the squared torques


def joint_order(
    recordings: Sequence[RobotRecording], robot: Robot, given: Mapping[int, LinkFactor]
) -> Finding | None:
    """Return the blocking finding of another order of all signals or of the torques, if only that explains the torques.

    `given` are the factors from the joints' rows in their present order.
    """
    before = float(_left(given, robot.n).mean())
    if robot.n < 2 or before < _POOR**2:
        return None
    few = stretches(recordings, _STRETCHES)
    torques = _climbed(robot.n, _score_of_torques(few, robot))
    found = [("torques", torques)]
    if not _explains(torques, before):
        found.append(("joints", _climbed(robot.n, _score_of_joints(few, robot))))
    for kind, each in found:
        if _explains(each, before):
            return _finding(kind, each, before, robot, recordings[0])
    return None


def _explains(found: _Found, before: float) -> bool:
    moved = found.order != tuple(range(len(found.order)))
    return moved and found.left < _WELL**2 and found.left < _BETTER * before


def _climbed(n: int, score: Callable[[Order], _Found]) -> _Found:
    """Return the order that no exchange of two joints improves, with as few exchanges as possible."""
    best = score(tuple(range(n)))
    while True:
        pairs = itertools.combinations(range(n), 2)
        tried = [score(_exchanged(best.order, *pair)) for pair in pairs]
        other = min(tried, key=lambda each: each.score)
        if other.score > best.score - _CLEARLY:
            return best
        best = other


def _found(order: Order, left: Array) -> _Found:
    score = float(np.log(np.maximum(left, _LEAST)).sum())
    return _Found(order=order, score=score, left=float(left.mean()))


def _exchanged(order: Order, first: int, second: int) -> Order:
    found = list(order)
    found[first], found[second] = found[second], found[first]
    return tuple(found)


def _score_of_torques(
    recordings: Sequence[RobotRecording], robot: Robot
) -> Callable[[Order], _Found]:
    """Return the score of an order of the torques; the rows of each joint with each torque are computed once."""
    n = robot.n
    table = np.ones((n, n))  # joint and torque
    for turn in range(n):
        order = np.roll(np.arange(n), turn)
        for joint, each in _factors(recordings, robot, None, order).items():
            table[joint, order[joint]] = each.given

    def score(order: Order) -> _Found:
        return _found(order, table[np.arange(n), list(order)])

    return score


def _score_of_joints(
    recordings: Sequence[RobotRecording], robot: Robot
) -> Callable[[Order], _Found]:
    known: dict[Order, _Found] = {}

    def score(order: Order) -> _Found:
        if order not in known:
            each = np.array(order)
            known[order] = _found(order, _left(_factors(recordings, robot, each, each), robot.n))
        return known[order]

    return score


def _factors(
    recordings: Sequence[RobotRecording], robot: Robot, order: Whole | None, torque_order: Whole
) -> dict[int, LinkFactor]:
    runs = [reordered(run, robot, order, torque_order) for run in recordings]
    rows = link_rows(plain_signals(runs, robot), robot)
    return {joint: link_factor(block) for joint, block in rows.items()}


def _left(factors: Mapping[int, LinkFactor], n: int) -> Array:
    return np.array([factors[joint].given if joint in factors else 1.0 for joint in range(n)])


def _finding(
    kind: str, found: _Found, before: float, robot: Robot, recording: RobotRecording
) -> Finding:
    columns = robot.columns_of(recording)
    own = [recording.names[columns[place]] for place in range(robot.n)]
    right = [own[place] for place in found.order]
    moved = [robot.names[j] for j in range(robot.n) if found.order[j] != j]
    is_named = set(own) & set(robot.names)
    code = {"torques": "swapped_torques", "joints": "swapped_joints"}[kind]
    if len(moved) > 2:
        code = "joint_order"
    torques = "torques" if robot.drive is None else "wanted positions"
    what = "columns" if kind == "joints" else torques
    order = f"the right order of the {what} is {', '.join(right)}"
    advice = Action("inspect", text=f"the order and names of the columns: {order}")
    if kind == "joints" and not is_named:
        advice = Action("call", {"joints": right}, function="load_robot")
    title = (
        f"the {what} of {listed(moved)} are exchanged"
        if len(moved) == 2
        else f"the {what} of {len(moved)} joints are in another order"
    )
    was, after = percent(float(np.sqrt(before))), percent(float(np.sqrt(found.left)))
    pairs = zip(robot.names, right, strict=True)
    return TYPES[code].finding(
        titled(title, f"{was} unexplained, {after} if corrected"),
        advice,
        details="; ".join(
            f"the {what} of {column} hold the values of {name}"
            for name, column in pairs
            if name in moved
        ),
        severity="blocking",
        evidence={"before": Measured(np.sqrt(before)), "after": Measured(np.sqrt(found.left))},
    )
