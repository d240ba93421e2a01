"""A velocity whose noise hides how it changes."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

NOISY_VELOCITY = FindingType(
    code="noisy_velocity",
    meaning="noise in the velocity is not small against its change over any admissible window: the "
    "estimated inertia is too small",
    advice="record the position with a finer resolution, or for longer",
)


def _find(evidence: Evidence) -> Iterator[Finding]:
    # Running integrals have no edges whose noise would count.
    if evidence.penalty.noise_limited and not evidence.penalty.cumulative:
        inertia = evidence.parameters.get("inertia")
        share = evidence.residuals.noise_share
        yield NOISY_VELOCITY.finding(
            f"noise makes up {percent(share)} of the change of the velocity over a window, and no window is long "
            "enough: the estimated inertia is too small",
            Action("record", text="the position with a finer resolution, or for longer"),
            evidence={"noise_share": Measured(share)},
            parameters=("inertia",) if inertia is not None and inertia.vary else (),
        )


CHECK = Check(_find, (NOISY_VELOCITY,))
