"""What a model may lack as integrals over the windows: one function for each row in the table of `families`."""

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

_PERIOD = np.pi  # [rad] of a harmonic that the motion covers, at least
_OF_TYPICAL = (0.05, 0.2, 0.6)  # of a fast speed: speeds by which a friction's shape is scaled
_MOST_RUNS = 3  # recordings of which each is tried by itself


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Candidate:
    """One regressor or a few that belong together.

    Attributes
    ----------
    name : str
        Name of the cause.
    columns : ndarray, shape (windows, m)
        Integrals of torque for a coefficient of 1.
    detail : str
        Which of its kind, e.g. the order of a harmonic.
    numbers : tuple
        Name, value and unit behind the length of the numbers in `detail`, where @ is the unit of length.
    unit : str
        Unit of its coefficient, if that is its size: for a revolute joint, then after a bar for a prismatic one.
        Default: not shown.
    family : str
        Causes that a recording hardly separates share one.
    finest : bool
        Whether only the windows as they are can show it.
    """

    name: str
    columns: Array
    detail: str = ""
    numbers: tuple[tuple[str, float, str], ...] = ()
    unit: str = ""
    family: str = ""
    finest: bool = False


def nothing(_: FittedBalance) -> Iterator[Candidate]:
    """No columns: it is found otherwise."""
    return iter(())


def gravity(fit: FittedBalance) -> Iterator[Candidate]:
    """Without a sensor, which feels the link's: beside one it would take the place of a wrong gain.

    Also beside the weight of a link as described, which may be described wrongly.
    """
    free = {fit.names[index] for index in fit.free}
    there = fit.knows_link or "sensor_gain" in fit.names or {"gravity_cos", "gravity_sin"} & free
    if _revolute(fit) and not there and not _has_order(fit, "position", 1.0):
        yield Candidate(name="gravity", columns=_angle(fit, 1.0))


def inertia_varies(fit: FittedBalance) -> Iterator[Candidate]:
    """From Lagrange's equation of an inertia M(q): M a + M' v² / 2, integrated without the acceleration."""
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
    """Means of cosine and sine of a multiple of the angle over all samples."""
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
    """Cosine and sine of a multiple of the angle at all samples, shape (samples, 2)."""
    return np.concatenate([_pair(order * run.position) for run in fit.runs])


def load_friction(fit: FittedBalance) -> Iterator[Candidate]:
    """With the load from the sensor, or from the model's gravity and inertia; never from the drive's torque."""
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
    """Size of a load times the direction."""
    turned = fit.integral_of_each(lambda _, run: np.sign(run.velocity)) / fit.duration
    return np.asarray(np.abs(load) * turned)


def drift(fit: FittedBalance) -> Iterator[Candidate]:
    """Coefficients that change evenly with time."""
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
    """Of orders of which the motion covers enough; the first is gravity's, or of a wrong centre of mass."""
    if not (_revolute(fit) and fit.has_torque):
        return
    reach = max(float(np.ptp(run.position)) for run in fit.runs)
    for order in range(2, 7):
        # Less than half a period is a slope, which other candidates are, too.
        if order * reach > _PERIOD and not _has_order(fit, "position", float(order)):
            yield Candidate(name="harmonic", columns=_angle(fit, float(order)), detail=str(order))


def ripple(fit: FittedBalance) -> Iterator[Candidate]:
    """Over longer windows only the ripple at reversals is left, which any cause at reversals resembles."""
    gear = fit.gear_ratio
    if gear == 1.0 or not _revolute(fit) or fit.group > 1:
        return
    for order in (0.5, 1.0, 2.0, 3.0, 4.0):
        if not _has_order(fit, "ripple", order):
            columns = _angle(fit, order * gear)
            yield Candidate(name="ripple", columns=columns, detail=f"{order:g}", finest=True)


def delay(fit: FittedBalance) -> Iterator[Candidate]:
    """To first order, the integral of a signal that is late changes by its rise over the window.

    If the delay of a signal was measured directly, that measurement says more than the residual of the balance.
    """
    for signal in LATE:
        change = fit.late(signal)
        if change is not None:
            yield Candidate(name="delay", columns=change[:, None], detail=signal)


def other_laws() -> list[_core.Term]:
    """Return the terms of friction of the speed alone that no other cause stands for.

    Friction that is there at rest is dry, or low-speed friction; so is dry friction that rises with the speed.
    """
    of_speed = [t for t in _core.terms() if t.friction and not (t.needs_load or t.side)]
    dry = [term for term in of_speed if term.at_rest or term.settles]
    return [term for term in of_speed if term not in dry and term.basis != "linear"]


def other_law(fit: FittedBalance) -> Iterator[Candidate]:
    """Friction of the core's table that the model lacks; with a shape in proportion to a power of usual speeds."""
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
    """In proportion to the speed: half the difference of constant friction is an offset."""
    if fit.is_asymmetric:
        return
    speed = fit.integral_of_each(lambda _, run: np.abs(run.velocity))
    yield Candidate(name="asymmetry", columns=speed[:, None])


def offset(fit: FittedBalance) -> Iterator[Candidate]:
    """Where the model has none."""
    if not {"torque_offset", "sensor_offset"} & set(fit.names):
        yield Candidate(name="offset", columns=fit.duration[:, None])


def wrong_scale(fit: FittedBalance) -> Iterator[Candidate]:
    """A given inertia that does not fit the torque's scale; one at its bound was not given."""
    if "inertia" in fit.given:
        column = fit.columns[:, fit.names.index("inertia")]
        yield Candidate(name="wrong_scale", columns=column[:, None])


def other_signal(fit: FittedBalance) -> Iterator[Candidate]:
    """Signals beside those of the model, and the friction's change with them."""
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
    """Values of its own of one recording; of many recordings those that are most likely to have them."""
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
    """Cosine and sine without their means, so that they leave an offset where it is."""
    columns = fit.integral_of_each(lambda _, run: _pair(order * run.position))
    if not {"torque_offset", "sensor_offset"} & set(fit.names):
        return columns
    mean = columns.sum(axis=0) / fit.duration.sum()
    return np.asarray(columns - fit.duration[:, None] * mean)


def typical_speed(fit: FittedBalance) -> float:
    """Return a fast speed of the joint."""
    # Of a joint that rests nearly all the time it is that of the little motion.
    usual = max(quantile_of_sizes(run.velocity, 0.9) for run in fit.runs)
    return usual or max(float(np.abs(run.velocity).max()) for run in fit.runs)
