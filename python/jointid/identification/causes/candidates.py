"""Candidates for effects that a model lacks, as integrals over windows: one function for each row of `families`."""

from __future__ import annotations

import functools
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.identification.causes.fitted_balance import LATE, FittedBalance
from jointid.identification.causes.samples import Samples, all_samples
from jointid.recording.order_statistics import quantile_of_sizes

Array = NDArray[np.float64]

_PERIOD = np.pi  # [rad] smallest phase of a harmonic that the motion must cover
_OF_TYPICAL = (0.05, 0.2, 0.6)  # shares of a fast speed that scale the shape of a friction term
_MOST_RUNS = 3  # largest number of single recordings to test


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Candidate:
    """One regressor, or a few that belong together.

    Attributes
    ----------
    name : str
        Name of the cause.
    columns : ndarray, shape (windows, m)
        Integrals of torque for a coefficient of 1.
    detail : str
        Variant of the cause, for example the order of a harmonic. "@" stands for the unit of length.
    numbers : tuple
        Numbers in `detail`: name, value, and the part of the unit after "@".
    unit : str
        Unit of the coefficient if the coefficient is the size: for a revolute joint, and after a bar for a prismatic
        one. Default: not shown.
    family : str
        Common name of causes that a recording hardly separates. Default: the cause's own name.
    finest : bool
        Whether only single windows, not sums of windows, can show it.
    """

    name: str
    columns: Array
    detail: str = ""
    numbers: tuple[tuple[str, float, str], ...] = ()
    unit: str = ""
    family: str = ""
    finest: bool = False


def nothing(_: FittedBalance) -> Iterator[Candidate]:
    """Return no candidates, for a cause that is found without columns."""
    return iter(())


def gravity(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield gravity, but not with a torque sensor: it would hide a wrong sensor gain.

    It is also a candidate if gravity is known from a described link, because the description may be wrong.
    """
    free = {fit.names[index] for index in fit.free}
    there = fit.knows_link or "sensor_gain" in fit.names or {"gravity_cos", "gravity_sin"} & free
    if _revolute(fit) and not there and not _has_order(fit, "position", 1.0):
        yield Candidate(name="gravity", columns=_angle(fit, 1.0))


def inertia_varies(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield an inertia M(q) by Lagrange's equation, M a + M' v² / 2, integrated so that it needs no acceleration."""
    if fit.knows_link or not _revolute(fit):
        return
    parts = {}
    for order in (1.0, 2.0):
        mean = _mean_of_basis(fit, order)
        momentum = fit.rise_of_each(functools.partial(_momentum, order=order, mean=mean))
        turning = fit.integral_of_each(functools.partial(_centrifugal, order=order))
        parts[order] = momentum - 0.5 * turning
    for orders in ((1.0,), (2.0,), (1.0, 2.0)):
        detail = " and ".join(f"{order:g}" for order in orders)
        columns = np.hstack([parts[order] for order in orders])
        yield Candidate(name="inertia_varies", columns=columns, detail=detail)


def _mean_of_basis(fit: FittedBalance, order: float) -> Array:
    """Return the means of cosine and sine of a multiple of the angle over all samples."""
    sums, count = np.zeros(2), 0
    for run in fit.runs:
        for part in all_samples(run):
            sums += _pair(order * part.position).sum(axis=0)
        count += len(run.time)
    return sums / count


def _momentum(_: int, run: Samples, order: float, mean: Array) -> Array:
    return np.asarray((_pair(order * run.position) - mean) * run.velocity[:, None])


def _centrifugal(_: int, run: Samples, order: float) -> Array:
    return np.asarray(order * _slope(order * run.position) * run.velocity[:, None] ** 2)


def inertia_basis(fit: FittedBalance, order: float) -> Array:
    """Return cosine and sine of a multiple of the angle at all samples, shape (samples, 2)."""
    return np.concatenate([_pair(order * run.position) for run in fit.runs])


def load_friction(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield friction of a load from the sensor or from the model's gravity and inertia, not from the drive's torque."""
    if "load_friction" in fit.names:
        return
    if fit.load is not None:
        yield Candidate(name="load_friction", columns=_against_motion(fit, fit.load)[:, None])
        return
    from jointid.identification.causes.loads import (
        load_friction_of_sensor,
        load_frictions_of_motion,
    )

    if "sensor_gain" in fit.names:
        load = load_friction_of_sensor(fit)
        if load is not None:
            yield Candidate(name="load_friction", columns=load[:, None])
        return
    for load in load_frictions_of_motion(fit):
        yield Candidate(name="load_friction", columns=load[:, None])


def _against_motion(fit: FittedBalance, load: Array) -> Array:
    """Return the absolute value of a load times the direction of motion."""
    turned = fit.integral_of_each(lambda _, run: np.sign(run.velocity)) / fit.duration
    return np.asarray(np.abs(load) * turned)


def drift(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield each coefficient with a linear change over time."""
    middle = fit.integral_of_each(lambda _, run: run.time - run.begin) / fit.duration
    progress = middle - np.average(middle, weights=fit.duration)
    for index, term in enumerate(fit.terms):
        name = fit.names[index]
        if index not in fit.free:
            continue
        if (term is not None and term.friction) or name in (
            "torque_offset",
            "sensor_offset",
            "sensor_gain",
        ):
            column = progress * fit.columns[:, index]
            yield Candidate(name="drift", columns=column[:, None], detail=name)


def harmonic(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield harmonics of each order that the motion covers, from order 2; order 1 is gravity."""
    if not (_revolute(fit) and fit.has_torque):
        return
    reach = max(float(np.ptp(run.position)) for run in fit.runs)
    for order in range(2, 7):
        # Less than half a period looks like a slope, as other candidates do.
        if order * reach > _PERIOD and not _has_order(fit, "position", float(order)):
            yield Candidate(name="harmonic", columns=_angle(fit, float(order)), detail=str(order))


def ripple(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield ripple of each order, but not over sums of windows, where only the ripple at reversals remains."""
    gear = fit.gear_ratio
    if gear == 1.0 or not _revolute(fit) or fit.group > 1:
        return
    for order in (0.5, 1.0, 2.0, 3.0, 4.0):
        if not _has_order(fit, "ripple", order):
            columns = _angle(fit, order * gear)
            yield Candidate(name="ripple", columns=columns, detail=f"{order:g}", finest=True)


def delay(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield the delay of each signal; to first order, it changes an integral by the signal's rise over the window.

    A directly measured delay has priority, because it is more reliable than the residual of the balance.
    """
    for signal in LATE:
        change = fit.late(signal)
        if change is not None:
            yield Candidate(name="delay", columns=change[:, None], detail=signal)


def other_laws() -> list[_core.Term]:
    """Return the speed-dependent friction terms that no other cause covers.

    Not among them are dry and low-speed friction, which exist at rest, and dry friction that rises with speed.
    """
    of_speed = [t for t in _core.terms() if t.friction and not (t.needs_load or t.side)]
    dry = [term for term in of_speed if term.at_rest or term.settles]
    return [term for term in of_speed if term not in dry and term.basis != "linear"]


def other_law(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield the friction terms of the core that the model lacks, with shapes from typical speeds."""
    present = {term.basis for term in fit.terms if term is not None and term.friction}
    speeds = typical_speed(fit) * np.array(_OF_TYPICAL)
    for term in other_laws():
        if term.basis in present:
            continue
        rows = [_core.shape(name) for name in term.shapes]
        tried = {tuple(row.typical or speed**row.speed_power for row in rows) for speed in speeds}
        for shapes in sorted(tried):
            column = fit.integral_of_each(functools.partial(_of_term, term=term, shapes=shapes))
            yield Candidate(
                name="other_law",
                columns=column[:, None],
                detail=term.meaning,
                unit=f"{term.unit}|{term.unit_prismatic}",
            )


def _of_term(_: int, run: Samples, term: _core.Term, shapes: tuple[float, ...]) -> Array:
    return np.asarray(_core.friction_basis(term.key, run.velocity, np.array(shapes)))


def asymmetry(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield viscous friction that differs between directions; a difference of constant friction is an offset."""
    if fit.is_asymmetric:
        return
    speed = fit.integral_of_each(lambda _, run: np.abs(run.velocity))
    yield Candidate(name="asymmetry", columns=speed[:, None])


def offset(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield an offset if the model has none."""
    if not {"torque_offset", "sensor_offset"} & set(fit.names):
        yield Candidate(name="offset", columns=fit.duration[:, None])


def wrong_scale(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield a correction of a fixed inertia that does not match the scale of the torque."""
    if "inertia" in fit.given:
        column = fit.columns[:, fit.names.index("inertia")]
        yield Candidate(name="wrong_scale", columns=column[:, None])


def other_signal(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield each signal that the model does not use, and its rate of change."""
    for name, values in fit.further_signals.items():
        level = values - values.mean()

        def signal(_: int, run: Samples, level: Array = level) -> Array:
            return level[run.cut]

        yield Candidate(
            name="other_signal", columns=fit.integral_of_each(signal)[:, None], detail=name
        )
        yield Candidate(
            name="other_signal",
            columns=fit.rise_of_each(signal)[:, None],
            detail=f"the change of {name}",
        )


def other_run(fit: FittedBalance) -> Iterator[Candidate]:
    """Yield separate values for one recording; with many recordings, only the most likely ones."""
    runs = fit.runs
    if len(runs) == 1:
        return
    found = {}
    for number in range(len(runs) == 2, len(runs)):
        here = fit.run == number
        columns = np.where(here[:, None], fit.jacobian, 0.0)
        columns = columns[:, np.any(columns != fit.jacobian, axis=0) & np.any(columns, axis=0)]
        if columns.shape[1] and np.count_nonzero(here) > columns.shape[1]:
            along = np.linalg.qr(columns[here])[0].T @ fit.residual[here]
            found[number] = (float(along @ along), columns)
    names = fit.run_names
    for number in sorted(found, key=lambda each: -found[each][0])[:_MOST_RUNS]:
        detail = names[number] if len(runs) > 2 else f"{names[0]} and {names[1]}"
        yield Candidate(name="other_run", columns=found[number][1], detail=detail)


def _revolute(fit: FittedBalance) -> bool:
    return fit.kind == "revolute"


def _has_order(fit: FittedBalance, family: str, order: float) -> bool:
    return f"{family}_cos_{order:g}" in fit.names


def _pair(angle: Array) -> Array:
    return np.column_stack(_core.circle(angle))


def _slope(angle: Array) -> Array:
    cosine, sine = _core.circle(angle)
    return np.column_stack([-np.asarray(sine), cosine])


def _angle(fit: FittedBalance, order: float) -> Array:
    """Return integrals of cosine and sine, without their means if the model has an offset."""
    columns = fit.integral_of_each(lambda _, run: _pair(order * run.position))
    if not {"torque_offset", "sensor_offset"} & set(fit.names):
        return columns
    mean = columns.sum(axis=0) / fit.duration.sum()
    return np.asarray(columns - fit.duration[:, None] * mean)


def typical_speed(fit: FittedBalance) -> float:
    """Return a fast speed of the joint [rad/s or m/s]."""
    # If the joint rests nearly all the time, use its largest speed.
    usual = max(quantile_of_sizes(run.velocity, 0.9) for run in fit.runs)
    return usual or max(float(np.abs(run.velocity).max()) for run in fit.runs)
