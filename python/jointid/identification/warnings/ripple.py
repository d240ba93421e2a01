"""Ripple that the model lacks: a peak of the residual at a multiple of the motor's or the joint's angle."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.model_advice import add_ripple
from jointid.identification.warnings.undetermined import wide, with_partners
from jointid.problem.problem import Problem
from jointid.recording.order_statistics import median

Array = NDArray[np.float64]

RIPPLE = FindingType(
    code="ripple",
    meaning="the residual oscillates with a multiple of the motor angle. Info: the ripple changes each value by at "
    "most 5 % and at most two standard errors",
    advice="add ripple of the named order to the model, e.g. `stribeck:ripple=2`",
    picture="windows",
)

_HALVES = 16  # number of multiples of half the motor's angle that are examined: 0.5 to 8
_SHARE = 0.05  # of the residual's variance
_CHANCE = 30.0  # times the share of one multiple in white noise
_OUTSTANDING = 10.0  # times the median share of all multiples: a sharp event contains all of them
_FINE = 2.2  # sample periods per window: longer windows average fast ripple out


@dataclass(frozen=True, slots=True, kw_only=True)
class _Peak:
    multiple: float
    amplitude: float
    share: float


def _highest_peak(problem: Problem, best: Array) -> _Peak | None:
    """Return the multiple of the motor's angle that explains most of the residual over windows of two samples.

    Windows of fast motion are omitted, because they average the highest multiple out.
    """
    if abs(problem.choice.gear_ratio) == 1.0 or problem.recordings[0].kind == "prismatic":
        return None
    period = min(recording.sample_period for recording in problem.recordings)
    try:
        windows, power, sums = problem.ripple(best, _HALVES, _FINE * period)
    except InputError:
        return None
    if windows < 50:
        return None
    shares = 2.0 * sums**2 / (windows * max(power, 1e-300))
    highest = int(np.argmax(shares))
    chance = 2.0 / windows
    if shares[highest] < max(_SHARE, _CHANCE * chance, _OUTSTANDING * median(shares)):
        return None
    return _Peak(
        multiple=0.5 * (highest + 1),
        amplitude=float(2.0 * sums[highest] / windows),
        share=float(shares[highest]),
    )


def _find(evidence: Evidence) -> Iterator[Finding]:
    peak = _highest_peak(evidence.problem, evidence.best)
    if peak is not None:
        cause = evidence.cause_of("ripple", f"{peak.multiple:g}", min(peak.share, 1.0))
        harmful = cause is None or cause.harmful
        does = "the ripple biases gain and static friction" if cause is None else cause.does
        measured = {
            "multiple": Measured(peak.multiple),
            "amplitude": Measured(peak.amplitude, "N·m"),
            "share_of_variance": Measured(peak.share),
        }
        if cause is not None:
            measured |= {f"{name}.shift": Measured(share) for name, share in cause.shares.items()}
        yield RIPPLE.finding(
            f"ripple of {peak.amplitude:.2g} N·m at {peak.multiple:g} × motor angle explains "
            f"{percent(peak.share)} of the residual",
            *((add_ripple(evidence, peak.multiple),) if harmful else ()),
            details=f"{does}; strain-wave gears have such ripple",
            evidence=measured,
            parameters=_concerned(evidence) if harmful else (),
            severity=None if harmful else "info",
        )


def _concerned(evidence: Evidence) -> tuple[str, ...]:
    """Return gain and static friction, and the other parameters that become uncertain."""
    biased = ("sensor_gain", "static", "static_positive", "static_negative")
    names = (name for name in biased if name in evidence.parameters)
    return with_partners(evidence, (*names, *wide(evidence)))


CHECK = Check(_find, (RIPPLE,))
