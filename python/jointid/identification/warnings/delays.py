"""Signals with a delay against the position."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.delays import Delay
from jointid.estimate.findings import Finding, Measured, Severity
from jointid.estimate.wording import rounded, two_digits
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

SIGNAL_LAG = FindingType(
    code="signal_lag",
    meaning="torque, sensor or velocity lags or leads the position. The signal was not shifted. Possible causes: a "
    "filter, a slow bus, a backward difference. Info: the lag changes each value by at most 5 % and at most two "
    "standard errors",
    advice="shift the signal by its lag, or remove the cause of the lag",
)
DELAY_REMOVED = FindingType(
    code="delay_removed",
    severity="info",
    meaning="torque, sensor or velocity lagged or led the position. The signal was shifted before the identification. "
    "The shift changed each named parameter by more than 5 % or two standard errors",
    advice="do nothing. To keep the signal unchanged, state a shift of 0",
)
# Explanation of an early torque; a torque does not come before its motion.
_EARLY = "the position is late or coarse, the torque is early, or the gear is elastic"
_WHERE = "the position's filter and resolution, the clocks of both signals, and the backlash"
_FILTERS = "the filters and clocks of position, velocity and torque"
_UNSHIFTED = Action("inspect", text="the stated shift, and remove it")
_COARSE = 0.005  # of a delay: a smaller error is not shown
_NORMAL = 1.96  # standard errors of a 95 % interval
_SHARP = 3e-4  # [s]
_NONE = 3.0  # standard errors: a smaller delay is not shifted
_HALF = 0.2  # of a sample period: a torque early by half a period, within this, is probably held


def _find(evidence: Evidence) -> Iterator[Finding]:
    certain = [delay for delay in evidence.delays.values() if delay.certain]
    left = [delay for delay in certain if delay.left]
    removed = [delay for delay in certain if not delay.left]
    for delay in left:
        yield from _left(delay, evidence)
    for delay in removed:
        yield from _removed(delay, evidence)


def _left(delay: Delay, evidence: Evidence) -> Iterator[Finding]:
    """Yield the finding of a delay that was not removed, with the reason; an info if it is harmless."""
    described, measured = _described(delay, evidence), _measured(delay, evidence)
    concerned = _concerned(delay, evidence)
    early = delay.signal == "torque" and _size(delay) < 0.0
    cause = evidence.cause_of("delay", delay.signal, 0.0, delay.left)
    harmless = cause is not None and not cause.harmful
    severity: Severity | None = "info" if harmless else None
    if cause is not None:
        measured |= {f"{name}.shift": Measured(share) for name, share in cause.shares.items()}
        if cause.harmful:
            concerned = tuple(dict.fromkeys((*concerned, *cause.relative)))
    if not delay.fits:
        # Without the delay of this signal alone the balance would be worse, because others have the same delay.
        alike = "other signals may have the same delay or filter"
        yield SIGNAL_LAG.finding(
            described,
            Action("inspect", text=_WHERE if early else _FILTERS),
            details=_clauses(
                "removing this delay does not improve the fit of the torque balance",
                f"{alike}, or the gear is elastic" if early else alike,
                _interval(delay),
            ),
            evidence=measured,
            parameters=concerned,
            severity=severity,
        )
        return
    if early and delay.value < -_period(evidence) and not delay.applied:
        yield SIGNAL_LAG.finding(
            described,
            Action("inspect", text=_WHERE),
            details=_clauses(_EARLY, _interval(delay)),
            evidence=measured,
            parameters=concerned,
            severity=severity,
        )
        return
    whole = {each.signal: each.applied for each in evidence.delays.values() if each.applied}
    whole[delay.signal] = round(delay.value, 7)
    if abs(delay.value) < _NONE * delay.stderr:
        del whole[delay.signal]
    does = cause.harmless if harmless and cause is not None else "biases the values"
    yield SIGNAL_LAG.finding(
        described,
        Action("call", {"shift": whole}),
        *(() if whole else (_UNSHIFTED,)),
        details=_clauses(f"this {does}", _EARLY if early else "", _interval(delay)),
        evidence=measured,
        parameters=concerned,
        severity=severity,
    )


def _removed(delay: Delay, evidence: Evidence) -> Iterator[Finding]:
    """Yield the finding of a delay that was removed, with its effect on the values."""
    cause = evidence.cause_of("delay", delay.signal, 0.0, delay.applied, removed=True)
    measured, concerned = _measured(delay, evidence), _concerned(delay, evidence)
    did = ""
    if cause is not None:
        did = f"the shift {cause.did}"
        measured |= {f"{name}.shift": Measured(share) for name, share in cause.shares.items()}
        concerned = tuple(cause.relative) if cause.harmful else ()
    early = _EARLY if delay.signal == "torque" and delay.applied < 0.0 else ""
    yield DELAY_REMOVED.finding(
        _described(delay, evidence, "lagged", "led"),
        *_instead(delay, evidence),
        details=_clauses(
            "the signal was shifted before the identification", did, early, _interval(delay)
        ),
        evidence=measured,
        parameters=concerned,
    )


def _described(delay: Delay, evidence: Evidence, late: str = "lags", early: str = "leads") -> str:
    size = _size(delay)
    verb = late if size > 0.0 else early
    periods = abs(size) / _period(evidence)
    amount = f"{1e3 * abs(size):.3g}"
    if delay.stderr > _COARSE * abs(size):
        error = 1e3 * delay.stderr
        amount = f"{rounded(1e3 * abs(size), error)} ± {two_digits(error)}"
    shifted = delay.applied and delay.left
    after = f" after a shift of {1e3 * delay.applied:.3g} ms" if shifted else ""
    return f"{delay.signal} {verb} the position by {amount} ms ({periods:.1f} samples){after}"


def _clauses(*texts: str) -> str:
    return "; ".join(filter(None, texts))


def _interval(delay: Delay) -> str:
    """Return the 95 % interval if the delay is uncertain."""
    reach = _NORMAL * delay.stderr
    if reach < _SHARP:
        return ""
    size = abs(_size(delay))
    return f"95 % interval: {1e3 * (size - reach):.2f} to {1e3 * (size + reach):.2f} ms"


def _size(delay: Delay) -> float:
    """Return the delay that is left, or the removed delay if none is left [s]."""
    return delay.left or delay.value


def _instead(delay: Delay, evidence: Evidence) -> tuple[Action, ...]:
    """Return advice for a torque that seems half a sample early: it is probably a held command."""
    early = -delay.value / _period(evidence)
    held = evidence.problem.hold(0) == "zoh"
    if delay.signal != "torque" or held or abs(early - 0.5) > _HALF:
        return ()
    text = "if the torque is a command that is held between samples"
    return (Action("call", {"torque_hold": "zoh"}, text=text),)


def _period(evidence: Evidence) -> float:
    return evidence.recordings[0].sample_period


def _measured(delay: Delay, evidence: Evidence) -> dict[str, Measured]:
    return {
        "lag": Measured(_size(delay), "s"),
        "lag_error": Measured(delay.stderr, "s"),
        "lag_periods": Measured(_size(delay) / _period(evidence)),
    }


def _concerned(delay: Delay, evidence: Evidence) -> tuple[str, ...]:
    gain = delay.signal == "sensor" and "sensor_gain" in evidence.parameters
    return ("sensor_gain",) if gain else ()


CHECK = Check(_find, (SIGNAL_LAG, DELAY_REMOVED))
