"""The balances of all joints over their windows, as one linear system."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.balance.windows import Windows, torque_integrals
from jointid.robot.balance.columns import Column, Summing, linear_columns, rotor_values
from jointid.robot.balance.integrals import inertia_integrals
from jointid.robot.links.models import is_asymmetric, terms_of
from jointid.robot.links.parameters import DIFFERENCE
from jointid.robot.links.robot import Robot
from jointid.robot.motion.motion import Motion

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_LEAST = 0.2  # smallest usable share of a window
_STEP = 5e-4  # [s], step of the derivative of the torque by the delay of commands


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rows:
    """Windows of all joints and recordings, in the order of time: (rows,), one row for each joint and window."""

    joint: Whole
    piece: Whole  # number of the piece, counted through all recordings
    window: Whole  # number of the window in its piece
    start: Array  # [s]
    stop: Array  # [s]
    duration: Array  # integrated time [s]
    velocity: Array  # mean velocity of the joint
    torque: Array  # integral of the measured torque [N·m·s]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Balance:
    """The linear system: torque = matrix x parameters + inertia x inertial parameters + known."""

    rows: Rows
    labels: tuple[tuple[int, str], ...]  # joint and name of each parameter of `matrix`
    # keys of their terms in the core's table; empty for parameters that every joint has
    keys: tuple[str, ...]
    least: Array  # lower bounds of the parameters
    matrix: Array  # (rows, parameters)
    inertia: Array  # (rows, directions), integrals per change of the inertial parameters
    basis: Array  # (10 n, directions), these changes, for the inertial parameters of all links
    known: Array  # (rows,), integral of the torque of the stated rotor inertias
    # (rows,), change of the torque's integral with the delay of commands [N·m]; 0 if no delay is searched
    by_delay: Array
    standing: Array  # (n,), share of the time that is left out of each joint's balance
    samples: int
    velocity_noise: Array  # (n,)
    summings: tuple[Summing, ...]  # one for each piece: for columns that are not linear
    places: tuple[Whole, ...]  # row numbers of each joint

    def columns_of(self, models: Sequence[str], dropped: Collection[int] = ()) -> list[int]:
        """Return the positions of the columns of joints with these models, without the inertia of some rotors."""
        friction = [{"", *(term.key for term in terms_of(model))} for model in models]
        return [
            place
            for place, ((joint, name), key) in enumerate(zip(self.labels, self.keys, strict=True))
            if key in friction[joint]
            and (name != DIFFERENCE or is_asymmetric(models[joint]))
            and (name != "rotor_inertia" or joint not in dropped)
        ]

    def windows_of(self, joint: int, piece: int) -> Whole:
        """Return the windows of a joint's rows in a piece, in their order."""
        rows, mine = self.rows, self.places[joint]
        return np.asarray(rows.window[mine[rows.piece[mine] == piece]])


def balance_of(robot: Robot, motions: Iterable[Motion], duration: float, basis: Array) -> Balance:
    """Return the balances of a robot's joints over windows of a duration [s]; `basis` is as in `Balance`.

    The motions are processed one after the other. Only the velocities and windows of each motion are kept.
    """
    parts = [_part(robot, motion, number, duration, basis) for number, motion in enumerate(motions)]
    first = parts[0]
    time = np.array([float(part.summings[0].step.sum()) for part in parts])
    rows = Rows(
        **{
            name: np.concatenate([getattr(part.rows, name) for part in parts])
            for name in Rows.__dataclass_fields__
        }
    )
    return Balance(
        rows=rows,
        labels=first.labels,
        keys=first.keys,
        least=first.least,
        matrix=np.concatenate([part.matrix for part in parts]),
        inertia=np.concatenate([part.inertia for part in parts]),
        basis=basis,
        known=np.concatenate([part.known for part in parts]),
        by_delay=np.concatenate([part.by_delay for part in parts]),
        standing=np.average([part.standing for part in parts], axis=0, weights=time),
        samples=sum(part.samples for part in parts),
        velocity_noise=np.mean([part.velocity_noise for part in parts], axis=0),
        summings=tuple(summing for part in parts for summing in part.summings),
        places=tuple(np.flatnonzero(rows.joint == joint) for joint in range(robot.n)),
    )


def _part(robot: Robot, motion: Motion, number: int, duration: float, basis: Array) -> Balance:
    """Return the balances of one recording."""
    windows = Windows.of(motion.time, duration)
    summing = Summing.of(robot, motion, windows)
    columns = linear_columns(robot, motion, summing)
    inertia = inertia_integrals(robot.tree, motion, summing.usable, windows)
    given = {
        motor: (float(value), rotor_values(motor, robot, motion, summing))
        for motor, value in enumerate(robot.rotor_inertias)
        if value is not None
    }
    starts, stops = motion.time[windows.edges[:-1]], motion.time[windows.edges[1:]]
    by_delay = _by_delay(robot, motion)
    rows, matrices, inertias, known, late = [], [], [], [], []
    for joint in range(robot.n):
        used = summing(joint, summing.step)
        kept = np.flatnonzero(used >= _LEAST * duration)
        matrix = np.zeros((kept.size, len(columns)))
        for place, column in enumerate(columns):
            if joint in column.values:
                matrix[:, place] = column.values[joint][kept]
        carried = [10 * link + k for link in inertia[joint].links for k in range(10)]
        spread = inertia[joint].columns[kept] @ basis[carried]
        sure = np.zeros(kept.size)
        for value, values in given.values():
            if joint in values:
                sure += value * values[joint][kept]
        travel = summing(joint, np.diff(motion.position[joint]))[kept]
        pushed = torque_integrals(motion.torque[joint], summing.step, motion.torque_held)
        torque = summing(joint, pushed)[kept]
        change = torque_integrals(by_delay[joint], summing.step, motion.torque_held)
        late.append(summing(joint, change)[kept])
        rows.append(
            Rows(
                joint=np.full(kept.size, joint),
                piece=np.full(kept.size, number),
                window=kept,
                start=starts[kept],
                stop=stops[kept],
                duration=used[kept],
                velocity=travel / used[kept],
                torque=torque,
            )
        )
        matrices.append(matrix)
        inertias.append(spread)
        known.append(sure)
    order = np.lexsort(
        (np.concatenate([row.joint for row in rows]), np.concatenate([row.start for row in rows]))
    )
    total = float(summing.step.sum())
    return Balance(
        rows=Rows(
            **{
                name: np.concatenate([getattr(row, name) for row in rows])[order]
                for name in Rows.__dataclass_fields__
            }
        ),
        labels=tuple((column.joint, column.name) for column in columns),
        keys=tuple(column.key for column in columns),
        least=np.array([column.least for column in columns]),
        matrix=np.concatenate(matrices)[order],
        inertia=np.concatenate(inertias)[order],
        basis=basis,
        known=np.concatenate(known)[order],
        by_delay=np.concatenate(late)[order],
        standing=1.0 - summing.usable @ summing.step / total,
        samples=motion.time.size,
        velocity_noise=motion.velocity_noise,
        summings=(summing,),
        places=(),
    )


def _by_delay(robot: Robot, motion: Motion) -> Array:
    """Return the change of the torques with the delay of commands, (n, samples); 0 if no delay is searched."""
    if robot.drive is None or robot.drive.delay is not None:
        return np.zeros_like(motion.torque)
    step = np.full(robot.n, _STEP)
    return (motion.torque_late_by(step) - motion.torque_late_by(-step)) / (2.0 * _STEP)


__all__ = ["Balance", "Column", "Rows", "balance_of"]
