"""A sensor whose reading is late by some milliseconds."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.velocity import LAG, SIGNAL_LAG

_SENSOR_LAG = 1.0  # sample periods between motion and sensor
_SURE_OF_SENSOR = 20.0  # standard errors; ripple of the sensor is not white: be surer


def _find(evidence: Evidence) -> Iterator[Finding]:
    for inspected in evidence.inspections:
        recording, velocity = inspected.recording, inspected.found.agreement
        if velocity is not None and abs(velocity.lag) > LAG * recording.sample_period:
            continue  # reported already: the velocity is what lags
        lag, error = inspected.found.sensor_lag
        periods = abs(lag) / recording.sample_period
        if periods > _SENSOR_LAG and abs(lag) > _SURE_OF_SENSOR * error:
            late, early = ("sensor", "motion") if lag > 0.0 else ("motion", "sensor")
            yield SIGNAL_LAG.finding(
                f"the {late} lags the {early} by about {1e3 * abs(lag):.2g} ms ({periods:.1f} sample periods), as a "
                "filter or a slower bus does",
                Action("inspect", text="filter and bus, and remove the delay or shift the column"),
                evidence={
                    "lag": Measured(lag, "s"),
                    "lag_error": Measured(error, "s"),
                    "lag_periods": Measured(periods),
                },
                parameters=("sensor_gain",) if "sensor_gain" in evidence.parameters else (),
            )


CHECK = Check(_find, (SIGNAL_LAG,))
