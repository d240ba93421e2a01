"""Signals that are late against the position."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.delays import Delay
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

SIGNAL_LAG = FindingType(
    code="signal_lag",
    meaning="torque, sensor or velocity is late against the position, as a filter, a slow bus or a backward "
    "difference makes it, and was not shifted",
    advice="shift the signal by the delay that is stated, or remove its cause",
)
DELAY_REMOVED = FindingType(
    code="delay_removed",
    severity="info",
    meaning="torque, sensor or velocity was late against the position, and was shifted before the identification",
    advice="nothing; to keep the signal as it is, shift it by 0",
)
_HALF = 0.2  # of a sample period: so near to half a period early, a torque is one that is held


def _find(evidence: Evidence) -> Iterator[Finding]:
    certain = [delay for delay in evidence.delays.values() if delay.certain]
    left = [delay for delay in certain if delay.applied != delay.value]
    removed = [delay for delay in certain if delay.applied == delay.value]
    for delay in left:
        if not delay.fits:
            # A delay of one signal alone would make the balance worse: others are as late.
            yield SIGNAL_LAG.finding(
                f"{_described(delay, evidence)}, but the torque balance does not fit better without it: other "
                "signals may be as late, or filtered alike",
                Action(
                    "inspect", text="the filters and the clocks of position, velocity and torque"
                ),
                evidence=_measured(delay, evidence),
                parameters=_concerned(delay, evidence),
            )
            continue
        whole = {each.signal: each.applied for each in evidence.delays.values() if each.applied}
        yield SIGNAL_LAG.finding(
            f"{_described(delay, evidence)}, which biases the values",
            Action("call", {"shift": {**whole, delay.signal: round(delay.value, 7)}}),
            evidence=_measured(delay, evidence),
            parameters=_concerned(delay, evidence),
        )
    for delay in removed:
        yield DELAY_REMOVED.finding(
            f"{_described(delay, evidence)}; it was shifted before the identification",
            *_instead(delay, evidence),
            evidence=_measured(delay, evidence),
            parameters=_concerned(delay, evidence),
        )


def _described(delay: Delay, evidence: Evidence) -> str:
    side = "late" if delay.value > 0.0 else "early"
    periods = abs(delay.value) / _period(evidence)
    return (
        f"the {delay.signal} is {side} by {1e3 * abs(delay.value):.3g} ± {1e3 * delay.stderr:.2g} ms "
        f"({periods:.1f} sample periods) against the position"
    )


def _instead(delay: Delay, evidence: Evidence) -> tuple[Action, ...]:
    """A torque that seems half a sample early is a command that is held."""
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
        "lag": Measured(delay.value, "s"),
        "lag_error": Measured(delay.stderr, "s"),
        "lag_periods": Measured(delay.value / _period(evidence)),
    }


def _concerned(delay: Delay, evidence: Evidence) -> tuple[str, ...]:
    gain = delay.signal == "sensor" and "sensor_gain" in evidence.parameters
    return ("sensor_gain",) if gain else ()


CHECK = Check(_find, (SIGNAL_LAG, DELAY_REMOVED))
