"""Residuals that are not noise and have no known cause."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.noisy_velocity import moved_by_noise
from jointid.identification.warnings.undetermined import listed, wide, with_partners

STRUCTURED_RESIDUAL = FindingType(
    code="structured_residual",
    meaning="the model lacks an effect, and no known cause explains the residual. The residuals of neighbouring "
    "windows have a correlation above 0.5, or a parameter is uncertain. Info: every parameter is well determined",
    advice="look at the residuals in the report. Standard errors include the correlation; values may still be biased",
    picture="windows",
)
_CORRELATED = 0.5
_ROOM = 50  # characters of names in a title


def _find(evidence: Evidence) -> Iterator[Finding]:
    # Running integrals of white noise are always correlated.
    if evidence.penalty.cumulative or named(evidence):
        return
    correlation = evidence.residuals.autocorrelation
    uncertain = _unexplained(evidence) if evidence.causes is not None else ()
    if not uncertain and (correlation <= _CORRELATED or harmless(evidence)):
        return
    makes = f"uncertain: {listed(uncertain)}" if uncertain else ""
    title = (
        f"an effect is missing: residuals of neighbouring windows correlate (r = {correlation:.2f})"
    )
    if not correlation > _CORRELATED:  # only the uncertain values show it
        title = f"uncertain although the motion is good: {listed(uncertain, _ROOM)}"
        makes = (
            "the model lacks an effect, or the windows are too long to show this effect; residuals of neighbouring "
            f"windows correlate (r = {correlation:.2f})"
        )
    # If all intervals are narrow, including the effect of the residual, the finding is an info.
    yield STRUCTURED_RESIDUAL.finding(
        title,
        Action("inspect", text="the residuals over time and velocity"),
        details="; ".join(filter(None, (excluded(evidence), makes))),
        evidence={"autocorrelation": Measured(correlation)} | excluded_number(evidence),
        parameters=uncertain,
        severity=None if uncertain else "info",
    )


def _unexplained(evidence: Evidence) -> tuple[str, ...]:
    """Return uncertain values; none if noise of the velocity, which has its own finding, changes them all."""
    found = with_partners(evidence, wide(evidence))
    noisy = with_partners(evidence, moved_by_noise(evidence))
    return () if set(found) <= set(noisy) else found


def named(evidence: Evidence) -> bool:
    """Return whether a harmful cause of the residual is found."""
    return evidence.causes is not None and bool(evidence.causes.found)


def harmless(evidence: Evidence) -> bool:
    """Return whether a harmless cause of the residual is found; it has its own info."""
    return evidence.causes is not None and bool(evidence.causes.harmless)


def excluded(evidence: Evidence, what: str = "the residual") -> str:
    """Return a harmless cause, or the number of excluded causes, as a clause.

    `Causes.excluded` has the names.
    """
    if evidence.causes is not None and evidence.causes.harmless:
        cause = evidence.causes.harmless[0]
        return f"{cause.meaning} explains {percent(cause.share)} of {what} and is harmless"
    count = len(evidence.causes.excluded) if evidence.causes is not None else 0
    return f"none of {count} known causes explains {what}" if count else ""


def excluded_number(evidence: Evidence) -> dict[str, Measured]:
    """Return the share of a harmless cause, or the number of excluded causes, as evidence."""
    if evidence.causes is None:
        return {}
    if evidence.causes.harmless:
        return {"share": Measured(evidence.causes.harmless[0].share)}
    return {"causes_excluded": Measured(float(len(evidence.causes.excluded)))}


CHECK = Check(_find, (STRUCTURED_RESIDUAL,))
