"""Rows of a plain inverse-dynamics regression, and their least-squares solution."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.problem.low_pass import low_passed, reach
from jointid.robot.balance.inertia import InertiaColumns
from jointid.robot.links.models import LOAD, is_asymmetric, is_loaded, linear_terms, shaped_term
from jointid.robot.links.parameters import DIFFERENCE, MOTOR_TERMS, VISCOUS
from jointid.robot.links.robot import Robot
from jointid.robot.motion.plain_motion import PlainSignals, link_columns

Array = NDArray[np.float64]
Whole = NDArray[np.int64]
Label = tuple[int | None, str]

BETTER = 0.8  # of a residual: a delay, or a recorded velocity, is used only below this ratio
_THINNED = 3  # rows in half an average: further rows add no information
_FEWEST = 40  # smallest number of rows of a joint
# [s] of motion that counts as one observation, and the smallest number of them
_BLOCK, _BLOCKS = 0.5, 12
_RANK = 1e-9  # of the largest eigenvalue of the scaled normal equations
_UNSEEN = 1e-6
_AS_GOOD = 1.05  # ratio of a residual with another delay, below which the rows do not decide between the delays


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Block:
    """Rows of one joint."""

    labels: tuple[Label, ...]  # of the columns
    matrix: Array  # (rows, columns)
    targets: Array  # (rows, delays), the torque minus its known part
    stretch: Whole  # (rows,), number of the stretch of time; a stretch is one observation
    size: float  # root mean square of the torque


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Rows:
    """One joint's columns in a stretch, the samples that are rows, and the known torque there."""

    kept: Whole
    labels: tuple[Label, ...]
    matrix: Array
    known: Array


@dataclass(frozen=True, slots=True, eq=False)
class Columns:
    """The parameters of a regression and its settings."""

    robot: Robot
    inertia: InertiaColumns
    slowest: Array  # (n,), speed of each joint below which there are no rows
    models: Sequence[str]  # one for each joint
    links: Array  # (10 n,), inertial parameters that give the load of friction
    # columns that were already computed, by signals, width and least speeds
    made: dict[tuple[int, int, tuple[float, ...]], list[_Rows]] = field(default_factory=dict)

    def blocks(
        self, signals: Sequence[PlainSignals], period: float, fastest: float, delays: Array
    ) -> dict[int, Block]:
        """Return the rows of the joints that move enough."""
        peaks = [np.abs(np.vstack([s.velocity, self._motors(s)])).max(axis=1) for s in signals]
        limit = fastest * np.max(peaks, axis=0)
        limit[: self.robot.n] = np.maximum(limit[: self.robot.n], self.slowest)
        total = sum(each.step * each.torque.shape[1] for each in signals)
        stretch = min(_BLOCK, total / _BLOCKS)
        parts = [
            self._part(each, period, limit, delays, (stretch, 100_000 * number))
            for number, each in enumerate(signals)
        ]
        found = {}
        for joint in range(self.robot.n):
            mine = [part[joint] for part in parts]
            if sum(len(each.targets) for each in mine) >= _FEWEST:
                targets = np.concatenate([each.targets for each in mine])
                found[joint] = Block(
                    labels=mine[0].labels,
                    matrix=np.concatenate([each.matrix for each in mine]),
                    targets=targets,
                    stretch=np.concatenate([each.stretch for each in mine]),
                    size=float(
                        np.sqrt(np.mean([each.size**2 for each in mine if each.size] or [0]))
                    ),
                )
        return found

    def _motors(self, signals: PlainSignals) -> Array:
        return np.asarray(self.robot.couplings @ signals.velocity)

    def _part(
        self,
        signals: PlainSignals,
        period: float,
        limit: Array,
        delays: Array,
        stretch: tuple[float, int],
    ) -> list[Block]:
        width = max(1, round(period * signals.period / signals.step))
        clock = signals.step * np.arange(signals.torque.shape[1])
        found = []
        for joint, rows in enumerate(self._rows(signals, width, limit)):
            late = [np.interp(clock + d, clock, signals.torque[joint]) for d in delays[joint]]
            torques = low_passed(np.array(late), width)[:, rows.kept]
            found.append(
                Block(
                    labels=rows.labels,
                    matrix=rows.matrix,
                    targets=(torques - rows.known).T,
                    stretch=stretch[1] + (clock[rows.kept] // stretch[0]).astype(np.int64),
                    size=float(np.sqrt(np.mean(torques[0] ** 2))) if rows.kept.size else 0.0,
                )
            )
        return found

    def _rows(self, signals: PlainSignals, width: int, limit: Array) -> list[_Rows]:
        """Return each joint's columns. They do not depend on the delay of the torque."""
        key = (id(signals), width, tuple(limit))
        if key not in self.made:
            self.made[key] = self._made(signals, width, limit)
        return self.made[key]

    def _made(self, signals: PlainSignals, width: int, limit: Array) -> list[_Rows]:
        robot, step, n = self.robot, signals.step, self.robot.n
        wide, half = reach(width), max(1, width // 2 // _THINNED)
        speed, motors = signals.velocity, self._motors(signals)
        wanted = np.column_stack([self.inertia.given, self.inertia.directions])
        links = link_columns(robot, signals.position, speed, step, wanted)
        change = np.gradient(motors, step, axis=1)
        given = self.links[:, None]
        loads = any(map(is_loaded, self.models))
        link_torques = (
            link_columns(robot, signals.position, speed, step, given)[:, 0] if loads else speed
        )
        slow = np.abs(np.vstack([speed, motors])) <= limit[:, None]
        names: tuple[Label, ...] = tuple(
            (link, "inertia_scale") if self.inertia.scales else (None, name)
            for link, name in zip(self.inertia.joints, self.inertia.names, strict=True)
        )
        found = []
        for joint in range(n):
            own = self._friction(joint, speed, motors, change)
            if is_loaded(self.models[joint]):
                torque = low_passed(link_torques[joint][None], width)[0]
                own[joint, LOAD.name] = np.abs(torque) * np.sign(speed[joint])
            bad = slow[joint] | ~signals.whole
            for motor in np.flatnonzero(robot.coupled & (robot.couplings[:, joint] != 0.0)):
                bad = bad | slow[n + motor]
            near = low_passed(bad.astype(float), 2 * wide // 3 + 1) > 1e-9
            kept = np.flatnonzero(~near)[::half]
            known = links[joint, 0] + own.pop((joint, "given"))
            rows = low_passed(np.vstack([known, *own.values(), links[joint, 1:]]), width)[:, kept]
            found.append(_Rows(kept=kept, labels=(*own, *names), matrix=rows[1:].T, known=rows[0]))
        return found

    def _friction(
        self, joint: int, speed: Array, motors: Array, change: Array
    ) -> dict[Label, Array]:
        """Return the columns of a joint's balance without the links; "given" is the known torque."""
        robot, own = self.robot, speed[joint]
        found: dict[Label, Array] = {
            (joint, term.name): _core.friction_basis(term.key, own, ())
            for term in linear_terms(self.models[joint])
            if not term.needs_load
        }
        shaped = shaped_term(self.models[joint])
        if shaped is not None and shaped.settles:  # rows are at speeds where it has risen
            found[joint, shaped.name] = np.sign(own)
        found[joint, "torque_offset"] = np.ones_like(own)
        found[joint, "given"] = np.zeros_like(own)
        if is_asymmetric(self.models[joint]):
            found[joint, DIFFERENCE] = np.abs(own)
        for motor in map(int, np.flatnonzero(robot.couplings[:, joint])):
            share, rotor = float(robot.couplings[motor, joint]), robot.rotor_inertias[motor]
            if robot.coupled[motor]:
                for name, term in MOTOR_TERMS.items():
                    basis = _core.friction_basis(term.key, motors[motor], ())
                    of_joint = share * own if term.basis == VISCOUS.basis else 0.0
                    found[motor, name] = share * (basis - of_joint)
            if rotor is not None:
                found[joint, "given"] = found[joint, "given"] + rotor * share * change[motor]
            elif motor not in self.inertia.dropped:
                found[motor, "rotor_inertia"] = share * change[motor]
        return found


def own_delays(
    blocks: dict[int, Block], grid: Array, better: float = BETTER
) -> tuple[dict[int, float], dict[int, float]]:
    """Return each joint's delay from its own rows, and the residual with it."""
    none = int(np.argmin(np.abs(grid)))
    found, left = {}, {}
    for joint, block in blocks.items():
        scaled = block.matrix / np.maximum(np.linalg.norm(block.matrix, axis=0), 1e-300)
        push = scaled.T @ block.targets
        solved = np.linalg.pinv(scaled.T @ scaled, rcond=_RANK, hermitian=True) @ push
        rest = np.linalg.norm(block.targets - scaled @ solved, axis=0)
        best = int(np.argmin(rest))
        taken = best if rest[best] < better * rest[none] else none
        found[joint], left[joint] = float(grid[taken]), max(float(rest[taken]), 1e-300)
    return found, left


def as_good(block: Block) -> Block:
    """Return a joint's rows with the second of two delays, if its residual is hardly larger than with the first."""
    basis = np.linalg.qr(block.matrix / np.maximum(np.linalg.norm(block.matrix, axis=0), 1e-300))[0]
    left = np.linalg.norm(block.targets - basis @ (basis.T @ block.targets), axis=0)
    return replace(block, targets=block.targets[:, [int(left[1] < _AS_GOOD * left[0])]])


def solved(blocks: dict[int, Block], n: int) -> tuple[dict[Label, float], dict[Label, float]]:
    """Return the values of all joints together, each joint weighted by its residual, and their clustered errors.

    A parameter that no row separates from the others has an infinite error.
    """
    every = list(dict.fromkeys(label for block in blocks.values() for label in block.labels))
    if not every:
        return {}, {}
    places = {j: np.array([every.index(each) for each in b.labels]) for j, b in blocks.items()}
    scatter, rest = dict.fromkeys(blocks, 1.0), {}
    for _ in range(3):
        gram, push = np.zeros((len(every),) * 2), np.zeros(len(every))
        for joint, block in blocks.items():
            weighted = block.matrix.T / scatter[joint] ** 2
            gram[np.ix_(places[joint], places[joint])] += weighted @ block.matrix
            push[places[joint]] += weighted @ block.targets[:, 0]
        size = np.sqrt(np.where(np.diag(gram) > 0.0, np.diag(gram), 1.0))
        powers, vectors = np.linalg.eigh(gram / np.outer(size, size))
        seen = powers > _RANK * powers[-1]
        inverse = (vectors[:, seen] / powers[seen]) @ vectors[:, seen].T / np.outer(size, size)
        values = inverse @ push
        rest = {j: b.targets[:, 0] - b.matrix @ values[places[j]] for j, b in blocks.items()}
        scatter = {j: max(float(np.sqrt(np.mean(each**2))), 1e-12) for j, each in rest.items()}
    stretches = np.unique(np.concatenate([block.stretch for block in blocks.values()]))
    scores = np.zeros((stretches.size, len(every)))
    for joint, block in blocks.items():
        each = block.matrix * (rest[joint] / scatter[joint] ** 2)[:, None]
        mine, first = np.unique(block.stretch, return_index=True)
        at = np.searchsorted(stretches, mine)
        scores[np.ix_(at, places[joint])] += np.add.reduceat(each, first, axis=0)
    half = scores @ inverse
    few = stretches.size / max(stretches.size - len(every) / n, 0.5 * stretches.size)
    errors = np.sqrt(few * np.einsum("ij,ij->j", half, half))
    errors[np.sum(vectors[:, ~seen] ** 2, axis=1) > _UNSEEN] = np.inf
    return dict(zip(every, values.tolist(), strict=True)), dict(
        zip(every, errors.tolist(), strict=True)
    )
