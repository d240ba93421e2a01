"""A model that explains too little."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.structured_residual import excluded, excluded_number, named

POOR_FIT = FindingType(
    code="poor_fit",
    meaning="the model explains less than 95 % of the signal's variance, and neither noise nor a known cause explains "
    "the rest. Or the model explains less than 5 % of the variance, even if the rest is noise. Blocking: the model "
    "fits worse than the signal's mean",
    advice="check units, signs and gear ratio",
    picture="windows",
)
POORLY_EXPLAINED = 0.95
_NOTHING = 0.05


def _find(evidence: Evidence) -> Iterator[Finding]:
    explained = evidence.residuals.r_squared
    actions = (
        *_of_the_weight(evidence),
        Action("inspect", text="units, signs and gear ratio"),
        Action("inspect", text="the residuals over time and over velocity"),
    )
    measured = {"r_squared": Measured(explained)}
    if explained < 0.0 and not named(evidence):
        yield POOR_FIT.finding(
            f"the model fits worse than the signal's mean (R² = {explained:z.2f})",
            *actions,
            details="the values cannot be used",
            evidence=measured,
            severity="blocking",
        )
        return
    # Noise alone is no fault of the model, and the errors contain it, unless only noise was measured.
    limit = _NOTHING if evidence.white else POORLY_EXPLAINED
    if explained < limit and not named(evidence):
        yield POOR_FIT.finding(
            f"the model explains only {100.0 * explained:.1f} % of the signal's variance",
            *actions,
            details=excluded(evidence, "the rest"),
            evidence=measured | excluded_number(evidence),
        )


def _of_the_weight(evidence: Evidence) -> tuple[Action, ...]:
    """Return advice to check a link's weight: a wrong weight makes all values wrong."""
    model = evidence.problem.choice.model
    if model.resolved.gravity != "known":
        return ()
    return (
        Action("inspect", text="mass, centre of mass and angle of the link"),
        Action("call", {"model": str(model.replace(gravity="free"))}),
    )


CHECK = Check(_find, (POOR_FIT,))
