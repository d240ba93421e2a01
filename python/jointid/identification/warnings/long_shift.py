"""A delay that was taken away and is longer than drives, filters and buses make one."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

LONG_SHIFT = FindingType(
    code="long_shift",
    meaning="a signal was shifted by more than 0.1 s and 20 sample periods, which no filter or bus makes late",
    advice="state delays in seconds: 1 ms is 0.001",
)
_LONG = 0.1  # [s]
_PERIODS = 20.0  # of a slow log, 0.1 s is a few samples


def _find(evidence: Evidence) -> Iterator[Finding]:
    shift = dict(evidence.problem.shift)
    period = evidence.recordings[0].sample_period
    long = {
        name: delay for name, delay in shift.items() if abs(delay) > max(_LONG, _PERIODS * period)
    }
    if long:
        shown = " and ".join(f"{name} by {delay:g} s" for name, delay in long.items())
        yield LONG_SHIFT.finding(
            f"{shown} is shifted, {max(map(abs, long.values())) / period:.0f} sample periods: delays are in seconds",
            Action("inspect", text="whether milliseconds were meant: 1 ms is 0.001"),
            evidence={name: Measured(delay, "s") for name, delay in long.items()},
        )


CHECK = Check(_find, (LONG_SHIFT,))
