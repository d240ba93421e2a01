"""Time stamps that differ from the times of the samples."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from jointid import _core
from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected
from jointid.identification.warnings.repeated import REPEATED
from jointid.recording.held_rows import fresh_rows
from jointid.recording.order_statistics import median
from jointid.recording.recording import Recording

TIME_JITTER = FindingType(
    code="time_jitter",
    meaning="the position shows that the time stamps have errors of more than 2 % of a sample period",
    advice="write the time stamp on the device that takes the sample. If samples are evenly spaced and no sample is "
    "repeated, use evenly spaced time stamps",
)
_JITTER = 0.02  # sample periods


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording = inspected.recording
    as_stamped, as_uniform = inspected.found.timing_errors
    period = recording.sample_period
    copies = inspected.stale_share("position") > REPEATED
    if copies:  # repeated rows have no own time
        as_stamped, period = _without_copies(recording)
    if as_stamped < _JITTER * period:
        return
    # Repeated rows make even stamps wrong, even if these look regular.
    even = not copies and as_uniform < 0.3 * as_stamped
    seen = "; the samples themselves look evenly spaced" if even else ""
    seen = "; repeated rows are not counted" if copies else seen
    advice = "even time stamps" if even else "time stamps on the device that takes the samples"
    yield TIME_JITTER.finding(
        f"time stamps are off by {1e6 * as_stamped:.3g} µs ({percent(as_stamped / period)} of the sample period)",
        Action("record", text=advice),
        details=f"the position shows these errors; a busy computer causes such time stamps{seen}",
        evidence={
            "scatter": Measured(as_stamped, "s"),
            "scatter_about_even_times": Measured(as_uniform, "s"),
            "share_of_period": Measured(as_stamped / period),
        },
    )


def _without_copies(recording: Recording) -> tuple[float, float]:
    """Return the scatter of the stamps and the median period [s] of the rows with a new position."""
    time, position = fresh_rows(recording.time, recording.position)
    if len(time) < 3:
        return 0.0, recording.sample_period
    period = median(np.diff(time))
    return _core.timing_errors(time, position, period)[0], period


CHECK = Check(None, (TIME_JITTER,), _in_recording)
