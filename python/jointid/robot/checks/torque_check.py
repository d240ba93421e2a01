"""Check that the torques are torques: one sign, one factor, a magnitude, degrees. It runs before all other checks.

The torques are regressed on the torque of the URDF's links, with friction, a rotor and an offset of each joint. All
other findings would only be consequences of such a fault, so it is the only finding.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.problem.unsigned_torque import BETTER, is_magnitude, is_one_sided, without
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.checks.exchanged_columns import joint_order
from jointid.robot.checks.link_factors import LinkFactor, link_factor, link_rows
from jointid.robot.checks.plain_regression import Block
from jointid.robot.links.parameters import CONSTANT
from jointid.robot.links.position_drive import facts_of_scales
from jointid.robot.links.robot import Robot
from jointid.robot.motion.plain_motion import PlainSignals
from jointid.robot.result.finding_types import TYPES, listed

Array = NDArray[np.float64]

_FAR = 1.6  # a factor on all torques: a URDF's total weight is never wrong by this factor
_CERTAIN = 2.5  # a factor that no unknown load or link explains
_OFF = 0.1  # of a logarithm: a joint's factor differs from 1
_NEAR = 0.03  # of a torque: with a smaller residual no other reading is tried
_LINK = 0.5  # of the squared residual with a changed weight of one link: required of a factor
_BOTH = 0.2  # smallest share of the rows in each direction
_RANGE = 2.0  # of the URDF's range: no joint moves further
_DEGREES = np.pi / 180.0
_MOVES = 0.05  # [rad or m]


def wrong_torques(
    recordings: Sequence[RobotRecording], signals: Sequence[PlainSignals], robot: Robot
) -> Finding | None:
    """Return the blocking finding of torques, or positions, with a wrong meaning."""
    if not signals:
        return None
    blocks = link_rows(signals, robot)
    found = _unsigned(recordings, robot, blocks)
    if found is not None or not blocks:
        return found
    given = {joint: link_factor(block) for joint, block in blocks.items()}
    common = _common(given)
    if common is not None and not 1.0 / _FAR < common < _FAR:
        if max(abs(common), 1.0 / abs(common)) < _CERTAIN and common > 0.0:
            one_link = _otherwise(signals, robot)
            if not sum(each.left for each in given.values()) < _LINK * one_link:
                return None
        turned = _tried(signals, robot, -1.0) if common < 0.0 else {}
        if _fits(turned, given):
            return _reversed(robot, (_common(turned) or 1.0) < 0.0)
        return _scaled(robot, given, common)
    if any(each.sure and each.value < 0.0 for each in given.values()):
        turned = _tried(signals, robot, -1.0)
        if _fits(turned, given):
            return _reversed(robot, (_common(turned) or 1.0) < 0.0)
    several = _several(signals, robot, given)
    if several is not None or all(each.sure and each.left < _NEAR**2 for each in given.values()):
        return several
    if _far(signals, robot):
        return _in_degrees(signals, robot)
    for factor in (-1.0, _DEGREES):
        other = _tried(signals, robot, factor)
        if _fits(other, given):
            if factor != -1.0:
                return _in_degrees(signals, robot)
            return _reversed(robot, (_common(other) or 1.0) < 0.0)
    return joint_order(recordings, robot, given)


def _several(
    signals: Sequence[PlainSignals], robot: Robot, given: Mapping[int, LinkFactor]
) -> Finding | None:
    """Return the finding of a factor for each joint, if several differ from 1 and no single link explains this."""
    sure = {joint: each for joint, each in given.items() if each.sure}
    off = [
        joint for joint, each in sure.items() if each.value < 0.0 or abs(np.log(each.value)) > _OFF
    ]
    if len(off) < 2 or 2 * len(sure) < robot.n or _agree(sure.values()):
        return None
    left, before = (sum(getattr(e, name) for e in sure.values()) for name in ("left", "given"))
    if left > BETTER * before or left > _LINK * _otherwise(signals, robot):
        return None
    factors = [sure[joint].value if joint in off else 1.0 for joint in range(robot.n)]
    one = "gain" if robot.drive is not None else "gear ratio or torque constant"
    names = [robot.names[joint] for joint in off]
    shown = ", ".join(f"{robot.names[joint]} {sure[joint].value:.3g}" for joint in off)
    return TYPES["different_factors"].finding(
        f"the torques of {listed(names)} differ from the weight of the URDF's links, each by its own factor",
        _divided(robot, factors),
        details=f"factors: {shown}; the same {one} was probably used for all joints; "
        f"{percent(float(np.sqrt(left / len(sure))))} of the torques stays unexplained with these factors, "
        f"{percent(float(np.sqrt(before / len(sure))))} without these factors",
        evidence={robot.names[joint]: Measured(sure[joint].value) for joint in off},
    )


def _agree(factors: Iterable[LinkFactor]) -> bool:
    """Return whether one factor on all torques fits all joints."""
    values = np.array([each.value for each in factors])
    return bool(np.all(values > 0.0) and np.ptp(np.log(values)) < _OFF)


def _otherwise(signals: Sequence[PlainSignals], robot: Robot) -> float:
    """Return the smallest squared residual of all torques if one link had another weight and centre."""
    n = robot.n
    moments = [10 * link + k for link in range(n) for k in range(4)]
    links = np.kron(np.eye(n), np.ones((10, 1))) * robot.tree.inertias.reshape(-1, 1)
    blocks = link_rows(signals, robot, np.hstack([links, np.eye(10 * n)[:, moments]]))
    rests = []
    for block in blocks.values():
        first = block.matrix.shape[1] - 5 * n - 1
        target = block.targets - block.matrix[:, [first]]
        values = np.column_stack([target, block.matrix[:, first + 1 :]])
        size = float(np.linalg.norm(block.targets)) or 1.0
        rests.append(without(block.matrix[:, :first], values) / size)
    rest, found = np.vstack(rests), []
    for link in range(n):
        mine = rest[:, 1 + np.array([link, *range(n + 4 * link, n + 4 * link + 4)])]
        changes = np.linalg.lstsq(mine, rest[:, 0], rcond=1e-6)[0]
        found.append(float(np.sum((rest[:, 0] - mine @ changes) ** 2)))
    return min(found)


def _tried(signals: Sequence[PlainSignals], robot: Robot, factor: float) -> dict[int, LinkFactor]:
    """Return the joints' factors if all positions were multiplied by `factor`."""
    moved = [
        replace(each, position=factor * each.position, velocity=factor * each.velocity)
        for each in signals
    ]
    return {joint: link_factor(block) for joint, block in link_rows(moved, robot).items()}


def _common(factors: Mapping[int, LinkFactor]) -> float | None:
    """Return the factor on which the joints with a valid factor agree; None if they do not agree or there are none."""
    sure = np.array([each.value for each in factors.values() if each.sure])
    if not sure.size or 2 * sure.size < len(factors) or not np.all(sure * sure[0] > 0.0):
        return None
    middle = float(np.median(np.abs(sure)))
    spread = float(np.abs(sure).max() / np.abs(sure).min())
    if spread > max(middle, 1.0 / middle, _FAR):  # an unknown link or load
        return None
    common = float(np.copysign(middle, sure[0]))
    if any(each.contradicts(common) for each in factors.values() if not each.sure):
        return None
    return common


def _fits(other: Mapping[int, LinkFactor], given: Mapping[int, LinkFactor]) -> bool:
    """Return whether the torques have the URDF's size with another reading of the positions, and only with it."""
    common = _common(other)
    if common is None or not 1.0 / _FAR < abs(common) < _FAR:
        return False
    both = [joint for joint in other if joint in given]
    falls = [other[joint].left / max(given[joint].left, 1e-12) for joint in both]
    return bool(both) and float(np.median(falls)) < BETTER


def _far(signals: Sequence[PlainSignals], robot: Robot) -> bool:
    """Return whether most joints move over far more than the URDF's range."""
    spans = np.array(robot.tree.spans or (np.inf,) * robot.n)
    moved = np.max([np.ptp(each.position, axis=1) for each in signals], axis=0)
    known = (spans > 0.0) & np.isfinite(spans) & ~np.array(robot.tree.prismatic) & (moved > _MOVES)
    return (
        bool(known.any())
        and 2 * np.count_nonzero(moved[known] > _RANGE * spans[known]) > known.sum()
    )


def _unsigned(
    recordings: Sequence[RobotRecording], robot: Robot, blocks: Mapping[int, Block]
) -> Finding | None:
    """Return the joints with a torque that is never negative, although it must be at times."""
    if robot.drive is not None:  # its torques are computed, not recorded
        return None
    lowest, highest = np.full(robot.n, np.inf), np.full(robot.n, -np.inf)
    for run in recordings:
        drives = (run.torque, run.motor_torque, run.current)
        values = next((each for each in drives if each is not None), None)
        if values is None:
            return None
        of_joints = values[:, robot.columns_of(run)]
        lowest = np.minimum(lowest, of_joints.min(axis=0))
        highest = np.maximum(highest, of_joints.max(axis=0))
    folded = [
        joint
        for joint, block in blocks.items()
        if is_one_sided(lowest[joint], highest[joint]) and _folded(block)
    ]
    if not folded:
        return None
    names = [robot.names[joint] for joint in folded]
    return TYPES["unsigned_torque"].finding(
        f"the torque of {names[0]} is never negative: its sign is missing"
        if len(names) == 1
        else f"the torques of {listed(names)} are never negative: their signs are missing",
        Action(
            "inspect",
            text="whether the driver has a signed value (otherwise use the sign of the servo's position error)",
        ),
        details="the joints move in both directions, and the values fit the magnitude of a torque that changes its sign"
        + (f"; joints: {', '.join(names)}" if len(names) > 1 else ""),
        parameters=()
        if len(folded) == robot.n
        else tuple(f"{name}.{CONSTANT.name}" for name in names),
        evidence={name: Measured(float(lowest[j])) for name, j in zip(names, folded, strict=True)},
    )


def _folded(block: Block) -> bool:
    """Return whether a joint's rows fit the magnitude of the modelled torque, not its value."""
    target = block.targets[:, 0]
    direction = block.matrix[
        :, block.labels.index(next(e for e in block.labels if e[1] == CONSTANT.name))
    ]
    if min(np.mean(direction > 0.5), np.mean(direction < -0.5)) < _BOTH:
        return False
    return is_magnitude(block.matrix, target, (block.matrix[:, -1] + 1e-12 * direction, direction))


def _scales(robot: Robot, factors: Sequence[float]) -> list[float]:
    before = robot.torque_scales or (1.0,) * robot.n
    return [float(f"{old / factor:.3g}") for old, factor in zip(before, factors, strict=True)]


def _divided(robot: Robot, factors: Sequence[float]) -> Action:
    """Return the call that removes factors from the torques."""
    return Action(
        "call",
        facts_of_scales(robot.drive, _scales(robot, factors), robot.torque_scales),
        text="use these factors until the true factors are known",
        function="Robot.from_urdf",
    )


def _scaled(robot: Robot, given: Mapping[int, LinkFactor], common: float) -> Finding:
    """Return the finding that the torques fit the URDF's links only with a common factor or the opposite sign."""
    if 1.0 / _FAR < abs(common) < _FAR:
        return TYPES["reversed_torques"].finding(
            "all torques have the opposite sign to the weight of the URDF's links",
            Action(
                "call",
                {"torque_scales": _scales(robot, [-1.0] * robot.n)},
                function="Robot.from_urdf",
            ),
            evidence={"factor": Measured(common)},
        )
    sure = {joint: factor.value for joint, factor in given.items() if factor.sure}
    size = abs(common)
    times = f"{1.0 / size:.2g} times smaller" if size < 1.0 else f"{size:.2g} times larger"
    sign = ", and have the opposite sign" if common < 0.0 else ""
    left = percent(float(np.sqrt(np.median([e.left for e in given.values()]))))
    what = (
        "the stated gains or the URDF's masses probably differ from the robot's"
        if robot.drive is not None
        else "the torques are probably currents or motor-side torques"
        if size < 1.0
        else "the torques are probably in another unit, or the URDF's masses differ from the robot's masses"
    )
    return TYPES["scaled_torques"].finding(
        f"all torques are about {times} than the weight of the URDF's links{sign}",
        _divided(robot, [sure.get(joint, common) for joint in range(robot.n)]),
        details=f"{what}; with one factor for each joint, {left} of the torques stays unexplained",
        evidence={
            "factor": Measured(common),
            **{robot.names[joint]: Measured(value) for joint, value in sure.items()},
        },
    )


def _reversed(robot: Robot, torques_too: bool) -> Finding:
    """Return the finding that all positions have the opposite sign."""
    before = robot.directions or (1.0,) * robot.n
    found: dict[str, object] = {"directions": [-each for each in before]}
    if not torques_too:  # a direction changes the sign of position and torque
        found["torque_scales"] = [-each for each in robot.torque_scales or (1.0,) * robot.n]
    with_torques = " and torques" if torques_too else ""
    return TYPES["reversed_positions"].finding(
        f"all positions{with_torques} have the opposite sign to the URDF's axes",
        Action("call", found, function="Robot.from_urdf"),
        details="the measured torques fit the weight of the links only with the opposite sign",
    )


def _in_degrees(signals: Sequence[PlainSignals], robot: Robot) -> Finding:
    moved = np.max([np.ptp(each.position, axis=1) for each in signals], axis=0)
    joint = int(np.argmax(np.where(robot.tree.prismatic, 0.0, moved)))
    size = float(moved[joint])
    return TYPES["implausible_unit"].finding(
        f"positions are probably in degrees, not radians: {robot.names[joint]} would move by {size:.3g} rad",
        Action("call", {"units": {"position": "deg"}}, function="load_robot"),
        severity="blocking",
        evidence={"range": Measured(size, "rad")},
    )
