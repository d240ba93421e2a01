"""`find_causes`: find the causes of the residual, the parameters that they change, and advice against them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.estimate.causes import Cause, Causes
from jointid.estimate.delays import Delay
from jointid.estimate.findings import Measured
from jointid.estimate.record import EstimateRecord
from jointid.estimate.statistics import ParameterEstimate
from jointid.identification.causes.attributed import Attributed
from jointid.identification.causes.candidates import Candidate
from jointid.identification.causes.changes import from_to, of_a_scale
from jointid.identification.causes.families import BY_NAME, listed_candidates
from jointid.identification.causes.fitted import Fitted
from jointid.identification.causes.fitted_balance import FittedBalance
from jointid.identification.causes.harm import ERRORS, MOVED, error_of, harm_of, scale_of
from jointid.identification.causes.sizes import off_scale
from jointid.problem.problem import Problem

Array = NDArray[np.float64]

_MOST = 60_000  # largest number of windows; stretches of a longer recording give the same result
_LATE = 2.0  # standard errors; a smaller delay counts as 0
_NOTICED = 0.8  # share of the harm limit; a shift to first order may be too small by this factor
_LEAST_SCALE = 0.02  # smallest relevant share of a fixed inertia, which is rarely known better
_KNOWN = 3e-4  # [s]; largest standard error of a delay that decides whether a delay matters
# Smallest relevant shares of a value, for any number of standard errors. A directly measured cause is more certain than
# a cause from the residual.
_LEAST, _LEAST_OF_MEASURED = 0.003, 0.002
_FAINT = 1e-3  # share of the friction that sampling leaves as residual without noise


def find_causes(
    problem: Problem,
    penalty: _core.Penalty,
    parameters: Mapping[str, ParameterEstimate],
    *,
    torque_level: float,
    delays: Mapping[str, Delay],
    signals: Mapping[str, Array] | None = None,
) -> Causes:
    """Find the causes of an estimate's residual.

    Parameters
    ----------
    problem : Problem
    penalty : Penalty
        Penalty over the windows of the fit.
    parameters : mapping of str to ParameterEstimate
    torque_level : float
        Root mean square of the torque [N·m or N], as the reference of an offset.
    delays : mapping of str to Delay
        Estimated delays of the signals relative to the position.
    signals : mapping of str to ndarray, optional
        Further signals of the first recording, one value per sample.
    """
    from jointid.identification.causes.attribution import attribute  # not needed for every fit

    late = "velocity" in delays and delays["velocity"].certain
    given = (problem, penalty, parameters, signals, _prompt(delays), late, _MOST)
    fit = whole = _fitted(*given)
    if whole.group > 1:
        fit = _fitted(*given, beside=whole)
    tried = listed_candidates(fit)
    causes = attribute(fit, tried, None if fit is whole else whole)
    if causes is None:
        fit, tried = whole, listed_candidates(whole)
        causes = attribute(fit, tried) or ()
    return _causes(fit, causes, tried, parameters, torque_level, delays)


def causes_of(
    fit: FittedBalance, parameters: Mapping[str, ParameterEstimate], torque_level: float
) -> Causes:
    """Find the causes of any balance's residual; arguments as for `find_causes`."""
    from jointid.identification.causes.attribution import attribute

    tried = listed_candidates(fit)
    return _causes(fit, attribute(fit, tried) or (), tried, parameters, torque_level, {})


def _causes(
    fit: FittedBalance,
    causes: Sequence[Attributed],
    tried: Sequence[Candidate],
    parameters: Mapping[str, ParameterEstimate],
    torque_level: float,
    delays: Mapping[str, Delay],
) -> Causes:
    """Return the attributed causes with their effects, divided into harmful and harmless ones."""
    found: list[Cause] = []
    harmless: list[Cause] = []
    errors = np.inf if fit.is_faint(_FAINT) else ERRORS
    for each in causes:
        if each.candidate.name == "wrong_scale" and abs(off_scale(fit, each)) < _LEAST_SCALE:
            continue
        cause = _cause(fit, each, parameters, torque_level, delays, errors=errors)
        (found if cause.harmful else harmless).append(cause)
    wanted = dict.fromkeys([*(each.name for each in tried), "delay", "disturbance"])
    return Causes(found=tuple(found), harmless=tuple(harmless), tried=tuple(wanted))


def share_of(
    name: str,
    problem: Problem,
    penalty: _core.Penalty,
    parameters: Mapping[str, ParameterEstimate],
) -> float:
    """Return the largest share of the residual that one candidate of a family explains alone; 0 if none does.

    Return 1 for a recording that is too long for this test, so that the caller makes the full attribution.

    Parameters
    ----------
    name : str
        Name of the family, for example "drift".
    """
    from jointid.identification.causes.attribution import shares

    if penalty.window_count > _MOST:
        return 1.0
    fit = _fitted(problem, penalty, parameters)
    return max(shares(fit, listed_candidates(fit, name)), default=0.0)


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
    """Return the effect of a known cause on the values; None if it has no candidate.

    Parameters
    ----------
    name, detail : str
        Name and detail of the cause, for example "ripple", "2", or "delay", "torque".
    share : float
        Share of the residual that it explains.
    size : float, optional
        Coefficient of the cause, if known. Default: fitted.
    removed : bool
        Whether the cause was removed before the fit. Its effect is then compared with the errors that the values
        would have with the cause.
    """
    fit = _fitted(problem, penalty, parameters)
    for each in listed_candidates(fit, name):
        if each.detail != detail:
            continue
        more = None
        if size is None:
            steps = fit.solve(np.column_stack([fit.jacobian, each.columns]), fit.residual)
        else:
            known = size * each.columns[:, 0]
            steps = np.append(fit.solve(fit.jacobian, fit.residual - known), -size)
            if removed:
                more = fit.errors_beside(known)
        found = Attributed(
            candidate=each,
            share=share,
            factor=1,
            coefficients=-steps[len(fit.free) :],
            shifts=steps[: len(fit.free)],
        )
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
    beside: Fitted | None = None,
) -> Fitted:
    found = [parameters[name] for name in penalty.names]
    best = np.array([p.value for p in found])
    free = tuple(index for index, p in enumerate(found) if p.vary and p.at_bound is None)
    given = frozenset(p.name for p in found if not p.vary)
    return Fitted.of(problem, penalty, best, free, signals, prompt, filtered, most, given, beside)


def attributed(
    problem: Problem,
    penalty: _core.Penalty,
    estimate: EstimateRecord,
    signals: Mapping[str, ArrayLike],
    times: Array,
) -> Causes:
    """Find the causes of an estimate's residual, with further signals of its recording.

    Each signal has one value for each of `times`, the recorded times [s], or for each fitted sample.

    Raises
    ------
    InputError
        The estimate has several recordings, or a signal has the wrong number of values.
    """
    if signals and len(problem.recordings) > 1:
        raise InputError(
            "further signals can be used only with an estimate of one recording",
            argument="signals",
            value=list(signals),
        )
    fitted = problem.recordings[0].time  # a removed delay removes samples at the edges
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
                f"all values must be finite; {wrong.size} of {length} values are not, the first at sample {wrong[0]}",
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
    """Return the signals without a delay, or without one after its removal, so that delay is no candidate for them.

    Many effects look like a delay, and a direct estimate of the delay is more reliable. If only some parts of the
    torque seem late, the torque is not late but something else is wrong. A velocity with a negligible delay counts as
    not late, even if the delay is significant.
    """
    found = set()
    for each in delays.values():
        left = abs(each.value - each.applied)
        known = each.signal != "sensor" and not each.certain and each.stderr < _KNOWN
        if left <= _LATE * each.stderr or known:
            found.add(each.signal)
    return frozenset(found)


def _cause(
    fit: FittedBalance,
    each: Attributed,
    parameters: Mapping[str, ParameterEstimate],
    torque_level: float,
    delays: Mapping[str, Delay],
    least: float = _LEAST,
    errors: float = ERRORS,
    more: Mapping[str, float] | None = None,
) -> Cause:
    shifts = {
        fit.names[index]: float(shift) for index, shift in zip(fit.free, each.shifts, strict=True)
    }
    wrong = each.candidate.name == "wrong_scale"
    effect = of_a_scale(parameters, shifts, off_scale(fit, each)) if wrong else ""
    family = BY_NAME[each.candidate.name]
    shifts |= family.changes(fit, each)
    shares = {
        name: shift / scale
        for name, shift in shifts.items()
        if (scale := scale_of(parameters[name], parameters, torque_level)) > 0.0
    }
    harm = {
        name: harm_of(
            error_of(parameters[name], more),
            shifts[name],
            share,
            1.0 - each.share,
            least,
            errors,
        )
        for name, share in shares.items()
    }
    known = {name: error_of(parameters[name]) for name in shifts}
    length, size = "m" if fit.kind == "prismatic" else "rad", family.size(fit, each, delays)
    numbers = {key: Measured(value, length + unit) for key, value, unit in each.candidate.numbers}
    return Cause(
        name=family.name,
        meaning=family.meaning,
        detail=(size.detail or each.candidate.detail).replace("@", length),
        share=each.share,
        scale=each.factor * fit.group * fit.window_duration,
        size=size.text,
        numbers={**numbers, **size.numbers},
        shifts=shifts,
        relative={name: share for name, share in shares.items() if harm[name] > _NOTICED},
        shares=shares,
        uncertain={
            name: abs(shifts[name]) / known[name]
            for name, share in shares.items()
            if abs(share) > MOVED and harm[name] <= 1.0 and known[name] > 0.0
        },
        near_zero=from_to(parameters, shifts, shares, known, before=more is not None),
        effect=effect,
        harmful=max(harm.values(), default=0.0) > 1.0,
        alike=each.alike,
        advice=family.advice(fit, each),
    )
