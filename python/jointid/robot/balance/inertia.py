"""Identified parameters of the links' inertias: none, one scale for each link, or base parameters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance.balance import Balance
from jointid.robot.balance.prior import Prior
from jointid.robot.balance.solving import PriorRows
from jointid.robot.links.inertia_modes import FREE, SCALED, URDF
from jointid.robot.links.link_tree import INERTIAL, INERTIAL_UNITS
from jointid.robot.links.momentum import columns_of
from jointid.robot.links.robot import Robot

Array = NDArray[np.float64]

_STATES = 64  # number of random states: far more rows than parameters
_DEPENDENT = 1e-8  # share of a column's length that other columns do not explain
_SHOWN = 1e-6  # smallest coefficient that a combination shows


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class InertiaColumns:
    """Columns of the identified inertia, and the inertia that stays as in the URDF."""

    # one for each column: joint number of a scale, combination of a base parameter
    names: tuple[str, ...]
    units: tuple[str, ...]
    joints: tuple[int, ...]  # link of each column
    directions: Array  # (10 n, columns), inertial parameters of all links per unit of each column
    given: Array  # (10 n,), inertial parameters that are not identified
    start: Array  # (columns,), values in the URDF
    # motors with an inertia that no motion separates from the links' inertias
    dropped: tuple[int, ...] = ()
    # (columns,), True for base parameters that contain a rotor's inertia
    of_rotors: NDArray[np.bool_] | None = None
    # Links with a scale that no motion separates from the rotors' inertias or other scales; they stay at 1.
    fixed: tuple[int, ...] = ()
    scales: bool = False  # whether the columns are scales
    prior: Prior | None = None  # prior of base parameters from the URDF

    def inertial(self, values: Array) -> Array:
        """Return the inertial parameters of all links that have these values, shape (10 n,)."""
        if self.prior is not None:
            return self.prior.completed(values)
        return np.asarray(self.given + self.directions @ values)

    def loading(self, values: Array) -> Array:
        """Return the inertial parameters that give the load of the gears, shape (10 n,).

        A base parameter that also contains a rotor's inertia has the URDF's value: a rotor does not load its gear.
        """
        if self.of_rotors is not None:
            values = np.where(self.of_rotors, self.start, values)
        return np.asarray(self.given + self.directions @ values)

    def prior_rows(self, others: int) -> PriorRows:
        """Return the prior's rows, with the parameters of the prior after `others` other parameters."""
        if self.prior is None:
            return PriorRows.nothing(others + len(self.names))
        empty = np.zeros((len(self.names), others))
        return PriorRows(
            matrix=np.hstack([empty, self.prior.root]), target=self.prior.root @ self.prior.mean
        )

    def columns(self, balance: Balance) -> Array:
        """Return the columns' integrals."""
        return np.asarray(balance.inertia @ within(balance.basis, self.directions))

    def known(self, balance: Balance) -> Array:
        """Return the integrals of the inertia that is not identified."""
        return np.asarray(balance.inertia @ within(balance.basis, self.given) + balance.known)


def within(basis: Array, changes: Array) -> Array:
    """Return changes of the inertial parameters as combinations of a basis that contains them."""
    return np.asarray(np.linalg.lstsq(basis, changes, rcond=None)[0])


def basis_of(robot: Robot, mode: str) -> Array:
    """Return the changes of inertial parameters that a mode needs, shape (10 n, directions).

    For the URDF's inertias, unchanged or scaled, the first directions are the links one by one. After them come the
    directions that name an error of the URDF: see `moment_columns`.
    """
    if mode == FREE:
        return inertia_columns(robot, FREE).directions
    single = [10 * link + k for link in range(robot.n) for k in range(4)]
    return np.hstack([_links(robot), np.eye(10 * robot.n)[:, single]])


def moment_columns(robot: Robot, link: int) -> slice:
    """Return the directions of a link's mass and first moments in the basis of the URDF's inertias."""
    first = robot.n + 4 * link
    return slice(first, first + 4)


def _links(robot: Robot) -> Array:
    directions = np.zeros((10 * robot.n, robot.n))
    for link in range(robot.n):
        directions[10 * link : 10 * link + 10, link] = robot.tree.inertias[link]
    return directions


def inertia_columns(robot: Robot, mode: str) -> InertiaColumns:
    """Return the columns of a mode."""
    every = robot.tree.inertias.ravel()
    free = [motor for motor, value in enumerate(robot.rotor_inertias) if value is None]
    if mode == URDF:
        nothing = np.zeros((every.size, 0))
        return InertiaColumns(
            names=(), units=(), joints=(), directions=nothing, given=every, start=np.zeros(0)
        )
    links, rotors = _structure(robot)
    if mode == SCALED:
        directions = _links(robot)
        kept, _ = independent(np.hstack([rotors[:, free], links @ directions]))
        scaled = [place - len(free) for place in kept if place >= len(free)]
        others = [link for link in range(robot.n) if link not in scaled]
        return InertiaColumns(
            names=tuple(f"scale of {robot.names[link]}" for link in scaled),
            units=("",) * len(scaled),
            joints=tuple(scaled),
            directions=directions[:, scaled],
            given=directions[:, others].sum(axis=1),
            start=np.ones(len(scaled)),
            fixed=tuple(others),
            scales=True,
        )
    structure = np.hstack([links, rotors[:, free]])
    kept, combined = independent(structure)
    base = [place for place in kept if place < every.size]
    separate = {free[place - every.size] for place in kept if place >= every.size}
    dropped = tuple(motor for motor in free if motor not in separate)
    merged = [every.size + free.index(motor) for motor in dropped]
    directions = np.zeros((every.size, len(base)))
    directions[base, np.arange(len(base))] = 1.0
    prior = Prior.of(robot, combined[: len(base)], free)
    return InertiaColumns(
        names=tuple(_combination(robot, combined[row], free) for row in range(len(base))),
        units=tuple(INERTIAL_UNITS[place % 10] for place in base),
        joints=tuple(place // 10 for place in base),
        directions=directions,
        given=np.zeros(every.size),
        start=combined[: len(base), : every.size] @ every,
        prior=prior,
        dropped=dropped,
        of_rotors=np.any(combined[: len(base), merged] != 0.0, axis=1),
    )


def _structure(robot: Robot) -> tuple[Array, Array]:
    """Return momentum and force of random states, per parameter of the links and motors."""
    tree, n = robot.tree, robot.n
    generator = np.random.default_rng(0)
    position = generator.uniform(-np.pi, np.pi, (n, _STATES))
    velocity = generator.uniform(-1.0, 1.0, (n, _STATES))
    momentum, force = columns_of(tree, position, velocity)
    links, rotors = np.zeros((2, n, _STATES, 10 * n)), np.zeros((2, n, _STATES, n))
    for number, (joint, link) in enumerate(tree.pairs):
        place = slice(10 * link, 10 * link + 10)
        links[0, joint, :, place] = momentum[number].T
        links[1, joint, :, place] = force[number].T
    speed = robot.couplings @ velocity
    for motor in range(n):
        rotors[0, :, :, motor] = robot.couplings[motor][:, None] * speed[motor]
    return links.reshape(-1, 10 * n), rotors.reshape(-1, n)


def independent(matrix: Array) -> tuple[list[int], Array]:
    """Return the columns that are independent of those before them, and a matrix that combines them to all columns."""
    basis = np.zeros((matrix.shape[0], 0))
    kept: list[int] = []
    nothing = _DEPENDENT * float(np.linalg.norm(matrix, axis=0).max(initial=0.0))
    for place in range(matrix.shape[1]):
        column = matrix[:, place]
        length = float(np.linalg.norm(column))
        rest = column - basis @ (basis.T @ column)
        rest = rest - basis @ (basis.T @ rest)
        left = float(np.linalg.norm(rest))
        if length > nothing and left > _DEPENDENT * length:
            basis = np.column_stack([basis, rest / left])
            kept.append(place)
    if not kept:
        return kept, np.zeros((0, matrix.shape[1]))
    combined: Array = np.linalg.lstsq(matrix[:, kept], matrix, rcond=None)[0].astype(np.float64)
    combined[np.abs(combined) < _SHOWN * np.abs(combined).max()] = 0.0
    return kept, combined


def _combination(robot: Robot, weights: Array, free: list[int]) -> str:
    """Return a base parameter as text: ``Izz_1 + Iyy_2 + 0.2 mx_2``."""
    names = [f"{what}_{link + 1}" for link in range(robot.n) for what in INERTIAL]
    names += [f"rotor_{motor + 1}" for motor in free]
    parts = []
    for name, weight in zip(names, weights, strict=True):
        if weight == 0.0:
            continue
        size = "" if abs(abs(weight) - 1.0) < _SHOWN else f"{abs(weight):.4g} "
        sign = "-" if weight < 0.0 else "+"
        parts.append(f"{sign} {size}{name}")
    return " ".join(parts).removeprefix("+ ")
