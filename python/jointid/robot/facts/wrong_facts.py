"""Facts that may be wrong if a robot's balance has a large residual: an alternative of each is tried.

Such facts are exchanged columns of two joints, a sign, and a coupling that is missing or has another sign. With the
URDF's inertias, such an error leaves a large residual, and the right fact a much smaller one. A wrong fact is
reported, not corrected, because only the user knows.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.robot.fit.quick_fit import quick_fit_of, thinned
from jointid.robot.links.inertia_modes import FREE, URDF
from jointid.robot.links.parameters import LINEAR_FRICTION
from jointid.robot.links.robot import Robot
from jointid.robot.motion.motion import Motion

Array = NDArray[np.float64]

_BETTER = 0.5  # summed fall of the logarithms of the motors' residuals: required of another fact
_BETTER_COUPLED = 0.15  # the same for a coupling, which light joints hardly show
_CLEARLY = 0.05  # advantage over the next fact that is required
_LEAST = 0.01  # of a motor's torque: a smaller residual does not decide
_BLOCKS = 20  # number of blocks of windows
_SURE = 3.0  # standard errors, over the blocks, by which another fact must be better
_SLOW = 0.02  # of the peak speed: slower motion is a standstill in a quick fit


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WrongFact:
    """An alternative fact that fits clearly better than the stated one."""

    # "swapped_joints", "swapped_torques", "wrong_sign", "wrong_torque_sign", "wrong_motion_sign" or "wrong_coupling"
    kind: str
    joints: tuple[str, ...]
    # coupling matrix: right value in the row of the first joint, at the second joint
    coupling: float | None
    # residual over measured torque, of the joints that change most, with the URDF's inertias
    before: float
    after: float  # the same with the corrected fact
    robot: Robot  # with the corrected fact
    # order of the position columns in the recording, if they should be exchanged
    order: NDArray[np.int64] | None = None
    torque_order: NDArray[np.int64] | None = None  # the same for the torques
    # the same coupling with another factor, or the sign of another joint, that fits nearly as well
    others: tuple[WrongFact, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Trial:
    kind: str
    joints: tuple[int, ...]
    robot: Robot
    motions: list[Motion]
    coupling: float | None = None
    order: NDArray[np.int64] | None = None
    torque_order: NDArray[np.int64] | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _MotorFit:
    """Residuals and torques of each motor in each window, and the amount of friction below 0."""

    residual: Array
    torque: Array
    held: int


def wrong_fact(
    robot: Robot, motions: Sequence[Motion], duration: float, suspects: Sequence[int]
) -> WrongFact | None:
    """Return the one fact about joints with a poor balance that explains most if it is changed, or None."""
    thin = [thinned(motion) for motion in motions]
    given = {mode: _motor_fit(robot, thin, duration, mode) for mode in (URDF, FREE)}
    falls = []
    for trial in _trials(robot, thin, set(suspects)):
        # The effect of a coupling is as small as the errors of a light wrist's inertias.
        mode = FREE if trial.kind == "wrong_coupling" else URDF
        was, other = given[mode], _motor_fit(trial.robot, trial.motions, duration, mode)
        if was is None or other is None:
            continue
        before, after = _relative(was, other)
        plain = given[URDF]
        if mode == FREE and plain is not None:
            # With another wrong fact, free inertias may be far from the truth; this is no evidence for a coupling.
            before = np.minimum(before, _relative(plain, other)[0])
        fall = float(np.log(before / after).sum())
        if not _is_certain(was, other):
            continue
        if mode == FREE and other.held > was.held and fall < _BETTER:
            continue  # friction would not dissipate power, and the balance is hardly better
        falls.append((fall, trial, before, after))
    if not falls:
        return None
    falls.sort(key=lambda each: each[0], reverse=True)
    best, trial, before, after = falls[0]
    least = _BETTER_COUPLED if trial.kind == "wrong_coupling" else _BETTER
    if best < least:
        return None
    others = [
        (fall, each) for fall, each, _, _ in falls[1:] if fall > max(best - _CLEARLY, 0.5 * best)
    ]
    # For an arm that moves in one plane, the mirror image fits as well: the other joint turns in reverse.
    same = [
        each
        for _, each in others
        if (each.joints == trial.joints and each.coupling)
        or each.kind == trial.kind == "wrong_sign"
    ]
    if len(same) < len(others):
        return None
    most = int(np.argmax(before / after))
    found = [
        WrongFact(
            kind=each.kind,
            joints=tuple(robot.names[joint] for joint in each.joints),
            coupling=each.coupling,
            before=float(before[most]),
            after=float(after[most]),
            robot=each.robot,
            order=each.order,
            torque_order=each.torque_order,
        )
        for each in (trial, *same)
    ]
    if trial.kind == "wrong_sign":
        rivals = [(each, [other for other in found if other is not each]) for each in found]
        found = [replace(each, others=tuple(rest)) for each, rest in rivals]
    return replace(found[0], others=tuple(found[1:]))


def _motor_fit(
    robot: Robot, motions: Sequence[Motion], duration: float, mode: str
) -> _MotorFit | None:
    fit = quick_fit_of(robot, motions, duration, mode)
    if fit is None:
        return None
    couplings = robot.couplings if motions[0].at_motor else np.eye(robot.n)
    residual, torque = fit.of_motors(couplings)
    held = sum(name in LINEAR_FRICTION for _, name in fit.held)
    return _MotorFit(residual=residual, torque=torque, held=held)


def _relative(given: _MotorFit, other: _MotorFit) -> tuple[Array, Array]:
    """Return each motor's residual over its torque, in the windows that two fits have in common."""
    common = np.isfinite(given.residual) & np.isfinite(other.residual)
    found = []
    for fit in (given, other):
        both = (fit.residual, fit.torque)
        left, size = (np.linalg.norm(np.where(common, each, 0.0), axis=1) for each in both)
        found.append(np.maximum(left / np.where(size > 0.0, size, 1.0), _LEAST))
    return found[0], found[1]


def _is_certain(given: _MotorFit, other: _MotorFit) -> bool:
    """Return whether another fact reaches the required fall by three standard errors, over blocks."""
    common = np.isfinite(given.residual) & np.isfinite(other.residual)
    size = np.linalg.norm(np.where(common, given.torque, 0.0), axis=1, keepdims=True)
    logs = []
    for fit in (given, other):
        left = np.where(common, fit.residual, 0.0) / np.where(size > 0.0, size, 1.0)
        used = (left**2)[:, common.any(axis=0)]
        sums = np.array([part.sum(axis=1) for part in np.array_split(used, _BLOCKS, axis=1)])
        logs.append(np.log(np.maximum(sums, _LEAST**2 / _BLOCKS)).sum(axis=1))
    falls = logs[0] - logs[1]
    return bool(falls.mean() > _SURE * falls.std(ddof=1) / np.sqrt(falls.size))


def _trials(robot: Robot, motions: list[Motion], suspects: set[int]) -> Iterator[_Trial]:
    n = robot.n
    # A drive computes other torques from exchanged columns.
    pairs = itertools.combinations(range(n), 2) if robot.drive is None else ()
    for i, j in pairs:
        # A joint that fits well has the right columns.
        if suspects >= {i, j} or (len(suspects) == 1 and suspects & {i, j}):
            order = np.arange(n)
            order[[i, j]] = j, i
            both = [_remade(each, robot, order=order, torque=order) for each in motions]
            yield _Trial(
                kind="swapped_joints",
                joints=(i, j),
                robot=robot,
                motions=both,
                order=order,
                torque_order=order,
            )
            torques = [_remade(each, robot, torque=order) for each in motions]
            yield _Trial(
                kind="swapped_torques",
                joints=(i, j),
                robot=robot,
                motions=torques,
                torque_order=order,
            )
    for i in sorted(suspects):
        sign = np.ones(n)
        sign[i] = -1.0
        turned = [_remade(each, robot, sign=sign) for each in motions]
        directions = tuple((sign * (robot.directions or 1.0)).tolist())
        other = replace(robot, directions=directions)
        yield _Trial(kind="wrong_sign", joints=(i,), robot=other, motions=turned)
        scales = tuple((sign * (robot.torque_scales or 1.0)).tolist())
        pushed = [_remade(each, robot, torque_sign=sign) for each in motions]
        other = replace(robot, torque_scales=scales)
        yield _Trial(kind="wrong_torque_sign", joints=(i,), robot=other, motions=pushed)
        moved = [_remade(each, robot, torque_sign=sign) for each in turned]
        other = replace(robot, directions=directions, torque_scales=scales)
        yield _Trial(kind="wrong_motion_sign", joints=(i,), robot=other, motions=moved)
    if not (motions[0].at_motor or robot.coupled.any()):
        return  # joints' own torques and positions: couplings do not show
    for i, j in np.argwhere(robot.couplings - np.diag(np.diag(robot.couplings))).tolist():
        matrix = robot.couplings.copy()
        matrix[i, j], matrix[j, i] = 0.0, matrix[i, j]
        yield _coupled(robot, motions, matrix, (j, i))
    for i in range(n):
        for j in (i - 1, i + 1):
            if not 0 <= j < n or not suspects & {i, j}:
                continue
            for value in {0.0, 1.0, -1.0} - {float(robot.couplings[i, j])}:
                matrix = robot.couplings.copy()
                matrix[i, j] = value
                if abs(np.linalg.det(matrix)) < 1e-9:
                    continue
                yield _coupled(robot, motions, matrix, (i, j))


def _coupled(robot: Robot, motions: list[Motion], matrix: Array, at: tuple[int, int]) -> _Trial:
    other = replace(robot, couplings=matrix)
    made = [_remade(each, other, coupled_before=robot.couplings) for each in motions]
    return _Trial(
        kind="wrong_coupling", joints=at, robot=other, motions=made, coupling=float(matrix[at])
    )


def _remade(
    motion: Motion,
    robot: Robot,
    *,
    order: NDArray[np.int64] | None = None,
    torque: NDArray[np.int64] | None = None,
    sign: Array | None = None,
    torque_sign: Array | None = None,
    coupled_before: Array | None = None,
) -> Motion:
    """Return the motion with other facts: columns in another order, other signs, other couplings."""
    before = robot.couplings if coupled_before is None else coupled_before
    shift = np.array(robot.zero_offsets or (0.0,) * robot.n)[:, None]
    # As recorded: at the motors, or at the joints.
    matrix = before if motion.at_motor else np.eye(robot.n)
    position, velocity = matrix @ (motion.position - shift), matrix @ motion.velocity
    pushed = np.linalg.solve(matrix.T, motion.torque)
    if order is not None:
        position, velocity = position[order], velocity[order]
    if torque is not None:
        pushed = pushed[torque]
    if sign is not None:
        position, velocity, pushed = (sign[:, None] * each for each in (position, velocity, pushed))
    if torque_sign is not None:
        pushed = torque_sign[:, None] * pushed
    matrix = robot.couplings if motion.at_motor else np.eye(robot.n)
    back = np.linalg.inv(matrix)
    joints, speeds = back @ position, back @ velocity
    motors, rates = robot.couplings @ joints, robot.couplings @ speeds
    return replace(
        motion,
        position=joints + shift,
        velocity=speeds,
        torque=matrix.T @ pushed,
        motor_position=motors,
        motor_velocity=rates,
        moving=_moving(speeds),
        motor_moving=_moving(rates),
    )


def _moving(velocity: Array) -> NDArray[np.bool_]:
    fast = np.abs(velocity) > _SLOW * np.abs(velocity).max(axis=1, keepdims=True)
    return np.asarray(fast[:, 1:] & fast[:, :-1])
