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
from jointid.identification.causes.attribution import Attributed, attribute
from jointid.identification.causes.candidates import FILTERED, inertia_basis, listed_candidates
from jointid.identification.causes.fitted import Fitted
from jointid.identification.causes.remedies import advice_against
from jointid.problem.problem import Problem

Array = NDArray[np.float64]

_LATE = 2.0  # standard errors of a delay that is none
_NORMAL = 1.959964  # standard errors of half a 95 % interval
_MOVED, _ERRORS = 0.04, 1.8  # share of a value, and standard errors, from which a cause matters
_UNKNOWN, _CLEARLY = 0.5, 2.0  # a value with a larger error is hardly known: it must move by more
_PART = 0.05  # of the variance of what was measured
_KNOWN = 3e-4  # [s]; standard error of a delay that says whether one matters
_LEAST = 0.003  # share of a value: a smaller change matters to nobody, however certain
_FAINT = 1e-3  # of the friction: what sampling leaves of a log without noise


def find_causes(
    problem: Problem,
    penalty: _core.Penalty,
    parameters: Mapping[str, ParameterEstimate],
    *,
    torque_level: float,
    r_squared: float,
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
    r_squared : float
        Share of the variance that the model explains.
    delays : mapping of str to Delay
        Of the signals against the position, as estimated before.
    signals : mapping of str to ndarray, optional
        Further signals of the first recording, one value a sample.
    """
    names = list(penalty.names)
    best = np.array([parameters[name].value for name in names])
    free = tuple(
        index
        for index, name in enumerate(names)
        if parameters[name].vary and parameters[name].at_bound is None
    )
    late = "velocity" in delays and delays["velocity"].certain
    fit = Fitted.of(problem, penalty, best, free, signals, _prompt(delays), late)
    tried = listed_candidates(fit)
    found: list[Cause] = []
    harmless: list[Cause] = []
    errors = np.inf if fit.is_faint(_FAINT) else _ERRORS
    for each in attribute(fit, tried):
        cause = _cause(fit, each, parameters, torque_level, delays, errors)
        # A large part of what was measured matters, however badly the values are known without it.
        matters = cause.relative or cause.share * (1.0 - r_squared) > _PART
        (found if matters else harmless).append(cause)
    wanted = dict.fromkeys([*(each.name for each in tried), "delay", "disturbance"])
    return Causes(found=tuple(found), harmless=tuple(harmless), tried=tuple(wanted))


def attributed(
    problem: Problem,
    penalty: _core.Penalty,
    estimate: Estimate,
    signals: Mapping[str, ArrayLike],
) -> Causes:
    """Attribute the misfit of an estimate, with further signals of its recording.

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
    length = len(problem.recordings[0])
    found = {}
    for name, values in signals.items():
        series = np.asarray(values, dtype=np.float64)
        if series.shape != (length,):
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
        found[name] = series
    torque = np.asarray(penalty.target) / np.asarray(penalty.usable_duration)
    return find_causes(
        problem,
        penalty,
        estimate.parameters,
        torque_level=float(np.sqrt(np.mean(torque**2))),
        r_squared=estimate.residuals.r_squared,
        delays=estimate.delays,
        signals=found,
    )


def _prompt(delays: Mapping[str, Delay]) -> frozenset[str]:
    """Signals that are not late, or no longer: much resembles a delay, and its own estimate says more.

    A torque of which only some parts seem late is not late: something else is amiss there.
    """
    found = set()
    for each in delays.values():
        left = abs(each.value - each.applied)
        parts = each.signal == "torque" and not each.certain and each.stderr < _KNOWN
        if left <= _LATE * each.stderr or parts:
            found.add(each.signal)
    return frozenset(found)


def _cause(
    fit: Fitted,
    each: Attributed,
    parameters: Mapping[str, ParameterEstimate],
    torque_level: float,
    delays: Mapping[str, Delay],
    errors: float,
) -> Cause:
    shifts = {
        fit.names[index]: float(shift) for index, shift in zip(fit.free, each.shifts, strict=True)
    }
    shifts |= _of_itself(fit, each)
    scales = {name: _scale(parameters[name], parameters, torque_level) for name in shifts}
    relative = {
        name: share
        for name, shift in shifts.items()
        if (share := _matters(parameters[name], shift, 1.0 - each.share, scales[name], errors))
        is not None
    }
    detail, size, numbers = _described(fit, each, delays)
    return Cause(
        name=each.candidate.name,
        detail=detail,
        share=each.share,
        scale=each.factor * float(fit.penalty.window_duration),
        size=size,
        numbers=numbers,
        shifts=shifts,
        relative=relative,
        alike=each.alike,
        advice=advice_against(fit, each),
    )


def _matters(
    p: ParameterEstimate, shift: float, left: float, scale: float, least: float
) -> float | None:
    """The shift as a share of the value where it is noticeable, else None.

    Parameters
    ----------
    left : float
        Share of the misfit that is left with the cause in the model: the error falls with it.
    scale : float
        What the shift is held against.
    least : float
        Standard errors from which a small shift matters, too.
    """
    if scale == 0.0:
        return None
    share = abs(shift) / scale
    # With what is systematic: a shift that the interval states already is nothing new.
    error = (p.interval[1] - p.interval[0]) / (2.0 * _NORMAL) if p.interval is not None else 0.0
    errors = abs(shift) / error if error > 0.0 else 0.0
    after = error * np.sqrt(max(left, 0.0))
    if after > _UNKNOWN * scale and abs(shift) < _CLEARLY * after:
        return None
    if share > _MOVED or (errors > least and share > _LEAST):
        return float(np.copysign(share, shift))
    return None


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
    return {}


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
    elif name == "inertia_varies":
        range_of_it = _half_range(fit, each) / (abs(fit.value("inertia")) or 1.0)
        size, numbers["range"] = f"±{100.0 * range_of_it:.2g} %", Measured(range_of_it)
    if name in ("harmonic", "ripple", "inertia_varies"):
        orders = detail.split(" and ")
        detail = " and ".join(f"{order} × {_OF.get(name, '')}angle" for order in orders)
        numbers |= {f"order_{order}": Measured(float(order)) for order in orders}
    for unit in ("@/s", "@"):
        detail = detail.replace(unit, unit.replace("@", length))
    return detail, size, numbers


_OF = {"ripple": "motor "}
