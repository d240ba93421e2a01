"""Time stamps that are not when the samples were taken."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.repeated import REPEATED

TIME_JITTER = FindingType(
    code="time_jitter",
    meaning="position and time stamps disagree by more than 2 % of a sample period",
    advice="stamp samples where they are taken; give even time stamps if the samples are even",
)
_JITTER = 0.02  # sample periods


def _find(evidence: Evidence) -> Iterator[Finding]:
    for inspected in evidence.inspections:
        recording = inspected.recording
        if inspected.stale_share("position") > REPEATED:
            continue  # copies have no time of their own, and that is reported already
        as_stamped, as_uniform = inspected.found.timing_errors
        period = recording.sample_period
        if as_stamped < _JITTER * period:
            continue
        even = as_uniform < 0.3 * as_stamped
        seen = "; the samples themselves look evenly spaced" if even else ""
        advice = "even time stamps" if even else "time stamps where the samples are taken"
        yield TIME_JITTER.finding(
            f"position and time stamps disagree by {1e6 * as_stamped:.3g} µs a sample ({percent(as_stamped / period)} "
            f"of the sample period), as stamps of a busy computer do{seen}",
            Action("record", text=advice),
            evidence={
                "scatter": Measured(as_stamped, "s"),
                "scatter_about_even_times": Measured(as_uniform, "s"),
                "share_of_period": Measured(as_stamped / period),
            },
        )


CHECK = Check(_find, (TIME_JITTER,))
