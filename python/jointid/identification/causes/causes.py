"""`find_causes`: the causes of a misfit, with what they move and what to do about them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.estimate.causes import Cause, Causes
from jointid.estimate.delays import Delay
from jointid.estimate.estimate import Estimate
from jointid.estimate.findings import Measured
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import percent
from jointid.identification.causes.attribution import Attributed, attribute
from jointid.identification.causes.candidates import FILTERED, inertia_basis, listed_candidates
from jointid.identification.causes.changes import from_to, of_a_scale
from jointid.identification.causes.fitted import Fitted
from jointid.identification.causes.remedies import advice_against
from jointid.problem.problem import Problem

Array = NDArray[np.float64]

_MOST = 60_000  # windows of an attribution: of a long recording, neighbours are summed
_LATE = 2.0  # standard errors of a delay that is none
_NORMAL = 1.959964  # standard errors of half a 95 % interval
_MOVED, _ERRORS = 0.05, 2.0  # share of a value, and standard errors, from which a cause does harm
_NOTICED = 0.8  # of that: a first-order shift may be so much too small
_UNKNOWN, _CLEARLY = 0.5, 2.0  # a value with a larger error is hardly known: it must move by more
_LEAST_SCALE = 0.02  # of a given inertia: it is seldom known better
_KNOWN = 3e-4  # [s]; standard error of a delay that says whether one matters
# Shares of a value: a smaller change matters to nobody, however many errors it is. A cause that is measured by
# itself is more than a guess from the misfit.
_LEAST, _LEAST_OF_MEASURED = 0.003, 0.002
_FAINT = 1e-3  # of the friction: what sampling leaves of a log without noise


def find_causes(
    problem: Problem,
    penalty: _core.Penalty,
    parameters: Mapping[str, ParameterEstimate],
    *,
    torque_level: float,
    delays: Mapping[str, Delay],
    signals: Mapping[str, Array] | None = None,
) -> Causes:
    """Attribute the misfit of an estimate.

    Parameters
    ----------
    problem : Problem
    penalty : Penalty
        Over the windows used.
    parameters : mapping of str to ParameterEstimate
    torque_level : float
        Root mean square of the torque [N·m or N]; what an offset is held against.
    delays : mapping of str to Delay
        Of the signals against the position, as estimated before.
    signals : mapping of str to ndarray, optional
        Further signals of the first recording, one value a sample.
    """
    late = "velocity" in delays and delays["velocity"].certain
    fit = _fitted(problem, penalty, parameters, signals, _prompt(delays), late, _MOST)
    tried = listed_candidates(fit)
    found: list[Cause] = []
    harmless: list[Cause] = []
    errors = np.inf if fit.is_faint(_FAINT) else _ERRORS
    for each in attribute(fit, tried):
        if each.candidate.name == "wrong_scale" and abs(_off_scale(fit, each)) < _LEAST_SCALE:
            continue
        cause = _cause(fit, each, parameters, torque_level, delays, errors=errors)
        (found if cause.harmful else harmless).append(cause)
    wanted = dict.fromkeys([*(each.name for each in tried), "delay", "disturbance"])
    return Causes(found=tuple(found), harmless=tuple(harmless), tried=tuple(wanted))


def cause_of(
    problem: Problem,
    penalty: _core.Penalty,
    parameters: Mapping[str, ParameterEstimate],
    torque_level: float,
    name: str,
    detail: str,
    share: float,
    size: float | None = None,
    removed: bool = False,
) -> Cause | None:
    """Return what a cause that is known from elsewhere does to the values; None of one without a candidate.

    Parameters
    ----------
    name, detail : str
        Of the cause, e.g. "ripple", "2", or "delay", "torque".
    share : float
        Share of a misfit that it explains.
    size : float, optional
        Its coefficient where that is known, too. Default: fitted.
    removed : bool
        Whether the values are those without it. What it moved is then held against the errors that they
        would have had with it.
    """
    fit = _fitted(problem, penalty, parameters)
    for each in listed_candidates(fit, name):
        if each.detail != detail:
            continue
        if size is None:
            steps = fit.solve(np.column_stack([fit.jacobian, each.columns]), fit.residual)
        else:
            known = fit.residual - size * each.columns[:, 0]
            steps = np.append(fit.solve(fit.jacobian, known), -size)
        found = Attributed(
            candidate=each,
            share=share,
            factor=1,
            coefficients=-steps[len(fit.free) :],
            shifts=steps[: len(fit.free)],
        )
        beside = removed and size is not None
        more = fit.errors_beside((size or 0.0) * each.columns[:, 0]) if beside else None
        return _cause(fit, found, parameters, torque_level, {}, _LEAST_OF_MEASURED, more=more)
    return None


def _fitted(
    problem: Problem,
    penalty: _core.Penalty,
    parameters: Mapping[str, ParameterEstimate],
    signals: Mapping[str, Array] | None = None,
    prompt: frozenset[str] = frozenset(),
    filtered: bool = False,
    most: int | None = None,
) -> Fitted:
    found = [parameters[name] for name in penalty.names]
    best = np.array([p.value for p in found])
    free = tuple(index for index, p in enumerate(found) if p.vary and p.at_bound is None)
    given = frozenset(p.name for p in found if not p.vary)
    return Fitted.of(problem, penalty, best, free, signals, prompt, filtered, most, given)


def attributed(
    problem: Problem,
    penalty: _core.Penalty,
    estimate: Estimate,
    signals: Mapping[str, ArrayLike],
    times: Array,
) -> Causes:
    """Attribute the misfit of an estimate, with further signals of its recording.

    They have a value at each of `times` [s], the recorded ones, or at each that was fitted.

    Raises
    ------
    InputError
        Signals for several recordings, or one with another number of values.
    """
    if signals and len(problem.recordings) > 1:
        raise InputError(
            "further signals need an estimate of one recording",
            argument="signals",
            value=list(signals),
        )
    fitted = problem.recordings[0].time  # without samples at the edges where a delay is taken away
    length, kept = len(times), np.searchsorted(times, fitted)
    found = {}
    for name, values in signals.items():
        series = np.asarray(values, dtype=np.float64)
        if series.shape not in ((length,), (len(fitted),)):
            raise InputError(
                f"one value for each of the {length} samples is expected",
                argument=f"signals.{name}",
                value=f"shape {series.shape}",
            )
        wrong = np.flatnonzero(~np.isfinite(series))
        if wrong.size:
            raise InputError(
                f"its values must be finite; {wrong.size} of {length} are not, the first at sample {wrong[0]}",
                argument=f"signals.{name}",
                value=float(series[wrong[0]]),
            )
        found[name] = series if len(series) == len(fitted) else series[kept]
    torque = np.asarray(penalty.target) / np.asarray(penalty.usable_duration)
    return find_causes(
        problem,
        penalty,
        estimate.parameters,
        torque_level=float(np.sqrt(np.mean(torque**2))),
        delays=estimate.delays,
        signals=found,
    )


def _prompt(delays: Mapping[str, Delay]) -> frozenset[str]:
    """Signals that are not late, or no longer: much resembles a delay, and its own estimate says more.

    A torque of which only some parts seem late is not late: something else is amiss there. Nor is a velocity
    that the position's rate shows to be late by too little to matter, however certain that little is.
    """
    found = set()
    for each in delays.values():
        left = abs(each.value - each.applied)
        known = each.signal != "sensor" and not each.certain and each.stderr < _KNOWN
        if left <= _LATE * each.stderr or known:
            found.add(each.signal)
    return frozenset(found)


def _cause(
    fit: Fitted,
    each: Attributed,
    parameters: Mapping[str, ParameterEstimate],
    torque_level: float,
    delays: Mapping[str, Delay],
    least: float = _LEAST,
    errors: float = _ERRORS,
    more: Mapping[str, float] | None = None,
) -> Cause:
    shifts = {
        fit.names[index]: float(shift) for index, shift in zip(fit.free, each.shifts, strict=True)
    }
    wrong = each.candidate.name == "wrong_scale"
    effect = of_a_scale(parameters, shifts, _off_scale(fit, each)) if wrong else ""
    shifts |= _of_itself(fit, each)
    shares = {
        name: shift / scale
        for name, shift in shifts.items()
        if (scale := _scale(parameters[name], parameters, torque_level)) > 0.0
    }
    harm = {
        name: _harm(
            _error_of(parameters[name], more),
            shifts[name],
            share,
            1.0 - each.share,
            least,
            errors,
        )
        for name, share in shares.items()
    }
    known = {name: _error_of(parameters[name]) for name in shifts}
    detail, size, numbers = _described(fit, each, delays)
    return Cause(
        name=each.candidate.name,
        detail=detail,
        share=each.share,
        scale=each.factor * fit.group * float(fit.penalty.window_duration),
        size=size,
        numbers=numbers,
        shifts=shifts,
        relative={name: share for name, share in shares.items() if harm[name] > _NOTICED},
        shares=shares,
        uncertain={
            name: abs(shifts[name]) / known[name]
            for name, share in shares.items()
            if abs(share) > _MOVED and harm[name] <= 1.0 and known[name] > 0.0
        },
        near_zero=from_to(parameters, shifts, shares, known, before=more is not None),
        effect=effect,
        harmful=max(harm.values(), default=0.0) > 1.0,
        alike=each.alike,
        advice=advice_against(fit, each),
    )


def _harm(
    error: float, shift: float, share: float, left: float, least: float, errors: float
) -> float:
    """The shift over the least one that does harm.

    Parameters
    ----------
    error : float
        Of the value.
    share : float
        The shift as a share of what it is held against.
    left : float
        Share of the misfit that is left with the cause in the model: the error falls with it.
    least : float
        Share below which a number of errors says nothing.
    errors : float
        Standard errors from which a small shift does harm, too.
    """
    moved = abs(shift) / error if error > 0.0 else 0.0
    after = error * np.sqrt(max(left, 0.0))
    scale = abs(shift / share) if share else 0.0
    if after > _UNKNOWN * scale and abs(shift) < _CLEARLY * after:
        return 0.0
    harm = abs(share) / _MOVED
    return max(harm, moved / errors) if abs(share) > least else harm


def _error_of(p: ParameterEstimate, more: Mapping[str, float] | None = None) -> float:
    """Its error with what is systematic: a shift that the interval states already is nothing new.

    Of what was removed the interval states nothing: chance is what hides it, with `more` by the removed itself.
    """
    if more is not None:
        return float(np.hypot(p.stderr or 0.0, more.get(p.name, 0.0)))
    return (p.interval[1] - p.interval[0]) / (2.0 * _NORMAL) if p.interval is not None else 0.0


def _scale(
    p: ParameterEstimate, parameters: Mapping[str, ParameterEstimate], level: float
) -> float:
    """What a shift is held against: an offset, or one phase of a harmonic, may be zero."""
    if "offset" in p.name:
        return max(abs(p.value), level)
    for one, other in (("_cos", "_sin"), ("_sin", "_cos")):
        pair = parameters.get(p.name.replace(one, other)) if one in p.name else None
        if pair is not None:
            return float(np.hypot(p.value, pair.value))
    return abs(p.value)


def _of_itself(fit: Fitted, each: Attributed) -> dict[str, float]:
    """A coefficient that is no constant: half of its range."""
    name, detail = each.candidate.name, each.candidate.detail
    if name == "drift" and detail in fit.names:
        return {detail: float(0.5 * each.coefficients[0] * _span(fit))}
    if name == "inertia_varies" and "inertia" in fit.names:
        return {"inertia": _half_range(fit, each)}
    if name == "asymmetry" and "viscous" in fit.names:
        return {"viscous": float(each.coefficients[0])}
    if name == "wrong_scale":
        return _of_a_scale(fit, _off_scale(fit, each))
    return {}


def _off_scale(fit: Fitted, each: Attributed) -> float:
    """By what share the torque shows a larger inertia than the given one."""
    return float(each.coefficients[0]) / (fit.value("inertia") or 1.0)


def _of_a_scale(fit: Fitted, share: float) -> dict[str, float]:
    """A wrong torque scales the friction with it; a wrong inertia does not, and nothing tells which it is."""
    frictions = [
        fit.names[index]
        for index, term in enumerate(fit.penalty.terms)
        if term.friction and index in fit.free and not term.needs_load
    ]
    return {name: -share * fit.value(name) for name in frictions}


def _half_range(fit: Fitted, each: Attributed) -> float:
    """Half of the range of an inertia that varies, over the angles of the recordings."""
    orders = [float(order) for order in each.candidate.detail.split(" and ")]
    basis = np.hstack([inertia_basis(fit, order) for order in orders])
    return 0.5 * float(np.ptp(basis @ each.coefficients))


def _span(fit: Fitted) -> float:
    return max(run.duration for run in fit.problem.recordings)


def _described(
    fit: Fitted, each: Attributed, delays: Mapping[str, Delay]
) -> tuple[str, str, dict[str, Measured]]:
    """Detail and size as texts, and their numbers."""
    name, found = each.candidate.name, each.coefficients
    prismatic = fit.problem.recordings[0].kind == "prismatic"
    length, torque = ("m", "N") if prismatic else ("rad", "N·m")
    detail, size = each.candidate.detail, ""
    numbers = {key: Measured(value, length + unit) for key, value, unit in each.candidate.numbers}
    if name in ("gravity", "harmonic", "ripple"):
        amplitude = float(np.hypot(*found))
        size, numbers["amplitude"] = f"{amplitude:.3g} {torque}", Measured(amplitude, torque)
    elif name in ("offset", "disturbance"):
        size, numbers["torque"] = f"{found[0]:.3g} {torque}", Measured(float(found[0]), torque)
    elif name == "delay" and detail != FILTERED:
        late = float(found[0])
        known = delays.get(detail)
        if known is not None and known.certain and known.left:
            late = known.left
        side = "late" if late > 0.0 else "early"
        size, numbers["delay"] = f"{side} by about {1e3 * abs(late):.2g} ms", Measured(late, "s")
    elif name == "load_friction":
        size, numbers["coefficient"] = f"{found[0]:.3g} of the load", Measured(float(found[0]))
    elif name == "drift":
        rate = float(found[0]) / (abs(fit.value(detail)) or 1.0)
        change, minute = rate * _span(fit), 60.0 * rate
        size = f"{100.0 * change:+.3g} % over the recording, {100.0 * minute:+.3g} % a minute"
        numbers |= {"change": Measured(change), "change_a_minute": Measured(minute)}
    elif name == "wrong_scale":
        share = _off_scale(fit, each)
        size, numbers["ratio"] = f"{100.0 * share:+.2g} %", Measured(1.0 + share)
    elif name == "inertia_varies":
        range_of_it = _half_range(fit, each) / (abs(fit.value("inertia")) or 1.0)
        size, numbers["range"] = f"±{percent(range_of_it)}", Measured(range_of_it)
    if name in ("harmonic", "ripple", "inertia_varies"):
        orders = detail.split(" and ")
        detail = " and ".join(f"{order} × {_OF.get(name, '')}angle" for order in orders)
        numbers |= {f"order_{order}": Measured(float(order)) for order in orders}
    for unit in ("@/s", "@"):
        detail = detail.replace(unit, unit.replace("@", length))
    return detail, size, numbers


_OF = {"ripple": "motor "}
