"""One identification of a robot with the present facts and delays."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.balance.covariance import Covariance
from jointid.base.errors import InputError
from jointid.joint.model import AUTO
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.balance.balance import Balance, balance_of
from jointid.robot.balance.choice import certainty, with_shapes
from jointid.robot.balance.fit import Fit
from jointid.robot.balance.inertia import InertiaColumns, basis_of, inertia_columns
from jointid.robot.balance.loads import loaded
from jointid.robot.balance.products import Products
from jointid.robot.balance.shaped_terms import ShapedTerms, solved_with_shapes
from jointid.robot.balance.solving import PriorRows, solved
from jointid.robot.fit.conclusion import concluded
from jointid.robot.fit.resampling import draws_of
from jointid.robot.fit.zeros import Zeros, zeros_of
from jointid.robot.links.models import PLAIN, SHAPED, is_loaded, name_of, renamed
from jointid.robot.links.parameters import POSITION_GAIN
from jointid.robot.links.robot import Robot
from jointid.robot.motion.motion import Motion, part_of
from jointid.robot.motion.request import duration_of
from jointid.robot.motion.shifts import on_the_clock_of_positions
from jointid.robot.result.result import RobotEstimate

Array = NDArray[np.float64]

_PIECE = 120_000  # samples of a long recording that are processed at once
_TURNS = 3  # rounds of friction under load and links: each depends on the other
_EXCERPTS = 4  # number of recordings with excerpts, which are used to check facts


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Request:
    """Options of a call, without recordings and robot."""

    inertia: str
    models: tuple[str, ...]  # one for each joint
    windows: float | None
    slowest: Array  # (n,), least speed of each joint
    mask_standstill: bool
    # joints with the velocity from the recording instead of the derived one
    recorded: tuple[int, ...] = ()
    lag: Array | None = None  # (n,), time constants of the torques' filters, to undo [s]
    # further modes of inertia for which the balance has columns
    further_modes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Attempt:
    """An estimate and its inputs."""

    robot: Robot  # with the zero offsets that were found
    delay: Array  # (n,), removed delay of the torques [s]
    estimate: RobotEstimate  # without settings
    fit: Fit
    balance: Balance
    # excerpts: the beginnings of some recordings, by the number of their piece in the balance
    excerpts: Mapping[int, Motion]
    duration: float  # of the windows [s]
    zeros: Zeros | None  # None if they are stated
    runs: tuple[int, ...]  # the recording of each piece


def attempted(
    recordings: Sequence[RobotRecording], robot: Robot, request: Request, delay: Array
) -> Attempt:
    """Return the identification of recordings on even clocks, with a delay of each torque removed [s]."""
    runs = [on_the_clock_of_positions(run, robot, delay, request.lag) for run in recordings]
    pieces = _pieces(runs)
    numbers = [number for number, _, _ in pieces]
    firsts = [numbers.index(number) for number in range(len(runs))][:_EXCERPTS]

    def motion(place: int) -> Motion:
        number, low, high = pieces[place]
        part = part_of(runs[number], low, high)
        return Motion.of(part, robot, request.slowest, request.mask_standstill, request.recorded)

    excerpts = {place: motion(place) for place in firsts}
    total = sum(run.duration for run in runs)
    duration = duration_of(request.windows, list(excerpts.values()), total)
    zeros = None
    gainless = robot.drive is not None and bool(robot.drive.free)
    if robot.zero_offsets is None and not gainless and not robot.gravity_free:
        zeros = zeros_of(robot, list(excerpts.values()), duration)
        if zeros.found:
            robot = replace(robot, zero_offsets=zeros.offsets)
            excerpts = {place: motion(place) for place in firsts}

    def every() -> Iterator[Motion]:
        return (
            excerpts[place] if place in excerpts else motion(place) for place in range(len(pieces))
        )

    basis = np.hstack([basis_of(robot, mode) for mode in (request.inertia, *request.further_modes)])
    balance = balance_of(robot, every(), duration, basis)
    if not balance.rows.torque.size:
        raise InputError(
            "no joint moves faster than the noise of its velocity",
            argument="recordings",
            value=runs[0].name,
            remedy="if a joint moves in the recording, check for late time stamps or lost rows",
        )
    fit, prior = fitted(robot, balance, request.inertia, request.models)
    if robot.drive is not None and gainless:
        gains = _gains(fit, fit.covariance(balance))
        robot = replace(robot, drive=robot.drive.with_gains(gains))
        excerpts = {place: motion(place) for place in firsts}
        balance = balance_of(robot, every(), duration, basis)
    covariance = fit.covariance(balance)
    estimate = concluded(robot, balance, request.inertia, fit, covariance, duration, numbers)
    estimate = replace(estimate, draws=draws_of(balance, fit, prior))
    return Attempt(
        robot=robot,
        delay=delay,
        estimate=estimate,
        fit=fit,
        balance=balance,
        excerpts=excerpts,
        duration=duration,
        zeros=zeros,
        runs=tuple(numbers),
    )


def _gains(fit: Fit, covariance: Covariance) -> dict[int, float]:
    """Return the gains that the motion determines, by joint."""
    errors = dict(zip(np.flatnonzero(~fit.at_bound).tolist(), covariance.stderr, strict=True))
    return {
        joint: float(fit.values[place])
        for place, (joint, name) in enumerate(fit.labels)
        if name == POSITION_GAIN and joint is not None
        if errors.get(place, np.inf) < fit.values[place]
    }


def fitted(
    robot: Robot, balance: Balance, mode: str, models: Sequence[str]
) -> tuple[Fit, PriorRows]:
    """Return the values of all parameters and their prior; the balance must have columns for the mode.

    Friction under load uses the torque of the URDF's links first. If the links are identified, it then uses the
    identified links.
    """
    columns = inertia_columns(robot, mode)
    links = columns.start
    turns = _TURNS if links.size and any(map(is_loaded, models)) else 1
    for _ in range(turns):
        with_loads = loaded(balance, models, columns.loading(links))
        fit, prior = _fitted(with_loads, columns, models)
        first = len(balance.columns_of(fit.models, columns.dropped))
        links = fit.values[first : first + links.size]
    return fit, prior


def _fitted(
    balance: Balance, columns: InertiaColumns, models: Sequence[str]
) -> tuple[Fit, PriorRows]:
    chosen = [joint for joint, model in enumerate(models) if name_of(model) == AUTO]
    models = _renamed(models, chosen, SHAPED)
    kept = balance.columns_of(models, columns.dropped)
    target = balance.rows.torque - columns.known(balance)
    inertial = columns.columns(balance)
    blocks = [
        np.column_stack(
            [
                balance.matrix[place][:, kept],
                inertial[place],
                target[place],
            ]
        )
        for place in balance.places
    ]
    products = Products.of(blocks, list(balance.places), balance.rows)
    least = np.append(balance.least[kept], np.full(len(columns.names), -np.inf))
    prior = columns.prior_rows(len(kept))
    if prior.target.size:
        _, prior = certainty(products, solved(products, least, prior), prior)
    shaped = ShapedTerms.of(balance, models)
    found = solved_with_shapes(shaped, products, least, prior)
    if chosen:
        needed = with_shapes(found, products, shaped, prior)
        models = _renamed(models, [joint for joint in chosen if joint not in needed], PLAIN)
        left = ShapedTerms.of(balance, models)
        if left.joints != shaped.joints:
            start = [float(found.logs[shaped.joints.index(joint)]) for joint in left.joints]
            shaped = left
            found = solved_with_shapes(shaped, products, least, prior, start)
    return Fit.of(balance, columns, models, products, shaped, found), prior


def _renamed(models: Sequence[str], joints: Collection[int], name: str) -> list[str]:
    """Return the models with another name for some joints."""
    return [
        renamed(model, name) if joint in joints else model for joint, model in enumerate(models)
    ]


def _pieces(runs: Sequence[RobotRecording]) -> list[tuple[int, int, int]]:
    """Return the parts of the recordings that are processed at once: number of the recording, first sample, end."""
    found = []
    for number, run in enumerate(runs):
        count = max(1, -(-run.samples // _PIECE))
        edges = np.linspace(0, run.samples, count + 1).round().astype(int).tolist()
        found += [(number, low, high) for low, high in itertools.pairwise(edges)]
    return found
