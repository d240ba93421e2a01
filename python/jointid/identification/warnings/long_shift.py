"""A stated shift that is longer than the delay of any drive, filter or bus."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

LONG_SHIFT = FindingType(
    code="long_shift",
    meaning="a signal was shifted by more than 0.1 s and 20 samples. No filter or bus causes such a long delay",
    advice="state shifts in seconds: 1 ms is 0.001",
)
_LONG = 0.1  # [s]
_PERIODS = 20.0  # sample periods: in a slow log, 0.1 s is only a few samples


def _find(evidence: Evidence) -> Iterator[Finding]:
    shift = dict(evidence.problem.shift)
    period = evidence.recordings[0].sample_period
    long = {
        name: delay for name, delay in shift.items() if abs(delay) > max(_LONG, _PERIODS * period)
    }
    if long:
        most = max(long, key=lambda name: abs(long[name]))
        samples = abs(long[most]) / period
        meant = {name: 1e-3 * delay if name in long else delay for name, delay in shift.items()}
        yield LONG_SHIFT.finding(
            f"{most} is shifted by {long[most]:g} s ({samples:.0f} samples): no bus has such a long delay",
            Action("call", {"shift": meant}, "if milliseconds were meant"),
            Action("inspect", text="the stated shift, and give it in seconds"),
            details="shifts are in seconds: 1 ms is 0.001",
            evidence={name: Measured(delay, "s") for name, delay in long.items()}
            | {f"{most}.samples": Measured(samples)},
        )


CHECK = Check(_find, (LONG_SHIFT,))
