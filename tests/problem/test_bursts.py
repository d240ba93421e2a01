"""Stamps of a bus that delivers samples in bursts: no sample period; the even rate is proposed."""

from __future__ import annotations

import numpy as np
import pytest
from defects import changed
from plain_joint import COULOMB, INERTIA, VISCOUS, recorded

import jointid as jid

RUN = recorded(period=0.002)


def in_bursts(rows: int) -> jid.Recording:
    """Each burst is stamped when it arrives, one row 20 µs behind the other."""
    number = np.arange(len(RUN))
    arrival = np.minimum((number // rows + 1) * rows, len(RUN)) - 1
    return changed(RUN, time=RUN.time[arrival] + 2e-5 * (number % rows))


@pytest.mark.parametrize("rows", [4, 10, 32])
def test_samples_in_bursts_are_refused_and_their_rate_is_proposed(rows: int) -> None:
    with pytest.raises(
        jid.InputError, match=r"intervals are gaps, .* load with sample_period"
    ) as error:
        jid.identify(in_bursts(rows))
    (advice,) = (each for each in error.value.remedy if not isinstance(each, str))
    assert advice.arguments["sample_period"] == pytest.approx(0.002, rel=0.01)
    even = changed(RUN, time=advice.arguments["sample_period"] * np.arange(len(RUN)))
    found = jid.identify(even).parameters
    for name, true in {"inertia": INERTIA, "coulomb": COULOMB, "viscous": VISCOUS}.items():
        assert found[name].value == pytest.approx(true, rel=0.03), name


def test_a_log_with_pauses_is_no_burst() -> None:
    paused = changed(RUN, time=RUN.time + 10.0 * (np.arange(len(RUN)) // 1000))
    assert jid.identify(paused).verdict.level == "usable"
