"""Series of own terms: the integral of each term from the first sample to every sample.

A window's integral is then the difference of two samples of the series. Signals are linear between samples, like a
measured torque and the velocity.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.joint.own_terms import CENTRED, POSITION, OwnTerm, OwnTerms
from jointid.recording.derived import derived_velocity
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_ROUNDING = 1e-12  # of a signal's size


def own_series(own: OwnTerms, recording: Recording) -> list[tuple[str, Array]]:
    """Return key and series of every own term.

    Parameters
    ----------
    own : OwnTerms
        Own terms with centres, from `centred`.
    recording : Recording

    Returns
    -------
    list of (str, ndarray of shape (n,))

    Raises
    ------
    InputError
        The recording lacks a signal.
    """
    result: list[tuple[str, Array]] = []
    rates: dict[str, Array] = {}
    for each in own.each:
        values = signal_of(each, recording)
        if each.rate:
            if each.signal not in rates:
                rates[each.signal] = rate_of(recording, values)
            values = rates[each.signal]
        result += zip(each.keys, _series(each, values, recording), strict=True)
    return result


def signal_of(own: OwnTerm, recording: Recording) -> Array:
    """Return the signal of an own term.

    Raises
    ------
    InputError
        The recording does not have the signal.
    """
    if own.signal == POSITION:
        return recording.position
    if own.signal not in recording.extra:
        present = ", ".join(recording.extra) or "none"
        raise InputError(
            f"the recording has no extra signal of this name; its extra signals: {present}",
            argument="terms",
            value=own.signal,
            remedy=Action("call", {"extra": {own.signal: ...}}, function="load"),
        )
    return recording.extra[own.signal]


def known_torque(own: OwnTerms, recording: Recording) -> Array | None:
    """Return the sum of the known torques; None without one."""
    known = [
        signal_of(each, recording) for each in own.each if each.kind == "known" and not each.rate
    ]
    return np.sum(known, axis=0) if known else None


def rate_of(recording: Recording, values: Array) -> Array:
    """Return the rate of change of a signal, computed like a derived velocity."""
    if float(np.ptp(values)) <= _ROUNDING * float(np.abs(values).max()):
        return np.zeros(len(values))  # a constant would leave only rounding errors
    period = recording.sample_period
    return np.asarray(derived_velocity(recording.time, values, recording.gaps, period).velocity)


def centred(own: OwnTerms, recordings: Sequence[Recording]) -> OwnTerms:
    """Return own terms with a centre for each function of an angle: the middle of the range, to six digits.

    Raises
    ------
    InputError
        A recording lacks a signal, or the joint is prismatic.
    """
    if not own.each:
        return own
    made = []
    for each in own.each:
        signals = [signal_of(each, recording) for recording in recordings]
        if each.kind in CENTRED:
            if each.signal == POSITION and recordings[0].kind == "prismatic":
                raise InputError(
                    "the position of a prismatic joint is not an angle",
                    argument=f"terms.{POSITION}",
                    value=str(each),
                )
            if each.centre is None:
                low = min(float(values.min()) for values in signals)
                high = max(float(values.max()) for values in signals)
                each = replace(each, centre=float(f"{0.5 * (low + high):.6g}"))
        made.append(each)
    return OwnTerms(tuple(made))


def unit_of(key: str, own: OwnTerms, recording: Recording) -> str | None:
    """Return the unit of an own term's parameter if the signal's unit is known; None: the core's unit."""
    each = next((each for each in own.each if key in each.keys), None)
    if each is None:
        return None
    known = recording.unit(each.signal) if each.signal in recording.extra else ""
    torque = "N" if recording.kind == "prismatic" else "N·m"
    if not known:
        return None
    shown = _per_second(known) if each.rate else known
    if each.kind == "viscous":
        return _ratio(torque, shown)
    if each.kind == "coupling":
        return _ratio(f"{torque}·s", shown)
    if each.kind in ("known", "scaled") and shown != torque:
        return _ratio(torque, shown)
    return None


def _per_second(unit: str) -> str:
    return f"{unit}/s"


def _ratio(above: str, unit: str) -> str:
    """Return the quotient of two units: N·m over rad/s is N·m·s/rad."""
    top, _, below = unit.partition("/")
    if below == "s" and above.endswith("·s"):
        return f"{above}²/{top}"
    raised = f"{above}·{below}" if below else above
    return raised if top == "1" else f"{raised}/{top}"


def _series(own: OwnTerm, signal: Array, recording: Recording) -> list[Array]:
    if own.kind in ("viscous", "known", "scaled"):
        return [_integral(_middle(signal), recording)]
    if own.kind == "coulomb":
        return [_integral(_mean_sign(signal), recording)]
    if own.kind == "coupling":
        return [signal]
    if own.kind in ("inertia", "scaled_inertia"):
        return [_momentum(signal, recording, 0.0)]
    if own.kind == "inertia_own":
        return [_momentum(signal, recording, 0.5)]
    if own.kind == "inertia_others":
        return [_momentum(signal, recording, 1.0)]
    angle = signal - (own.centre or 0.0)
    functions = (np.cos(angle) - 1.0, np.sin(angle))
    if own.kind == "torque_over":
        return [_integral(_middle(each), recording) for each in functions]
    share = 0.5 if own.signal == POSITION else 1.0
    return [_momentum(each, recording, share) for each in functions]


def _middle(signal: Array) -> Array:
    return np.asarray(0.5 * (signal[1:] + signal[:-1]))


def _mean_sign(signal: Array) -> Array:
    """Return the mean sign over each interval of a signal that is linear between samples."""
    sign = np.sign(signal)
    size = np.abs(signal)
    total = size[:-1] + size[1:]
    crossing = sign[:-1] * sign[1:] < 0.0
    with np.errstate(invalid="ignore", divide="ignore"):
        part = sign[:-1] * (size[:-1] - size[1:]) / total
    # If a signal is exactly 0 at one end of an interval, the whole interval has the sign of the other end.
    return np.asarray(np.where(crossing, part, np.sign(sign[:-1] + sign[1:])))


def _integral(mean: Array, recording: Recording) -> Array:
    return _summed(mean * np.diff(recording.time))


def _momentum(inertia: Array, recording: Recording, share: float) -> Array:
    """Return the integral of J a + share * (dJ/dt) v, computed without the acceleration."""
    v = recording.velocity
    return _summed(_middle(inertia) * np.diff(v) + share * np.diff(inertia) * _middle(v))


def _summed(steps: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(steps)])
