"""A torque without its sign is named as that; one that only pushes one way, because it lifts, is not."""

from __future__ import annotations

import numpy as np
import pytest
from defects import changed
from plain_joint import recorded

import jointid as jid


def weighed(run: jid.Recording, weight: float, level: float = 0.0) -> jid.Recording:
    """The same motion under a weight, and a constant."""
    return changed(run, torque=np.asarray(run.torque) + weight * np.cos(run.position) + level)


@pytest.mark.parametrize("weight", [0.0, 4.0])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_magnitude_is_the_first_finding(weight: float, seed: int) -> None:
    run = weighed(recorded(seed=seed), weight)
    estimate = jid.identify(changed(run, torque=np.abs(np.asarray(run.torque))))
    assert estimate.findings[0].code == "unsigned_torque"
    assert estimate.findings[0].severity == "blocking"
    assert "reversed_sign" not in {each.code for each in estimate.findings}


@pytest.mark.parametrize("level", [0.0, 20.0])
def test_a_torque_that_lifts_is_none(level: float) -> None:
    run = weighed(recorded(), 30.0 - level, level)
    assert np.min(np.asarray(run.torque)) > 0.0
    estimate = jid.identify(run)
    assert "unsigned_torque" not in {each.code for each in estimate.findings}
    assert estimate.parameters["coulomb"].value == pytest.approx(3.0, rel=0.02)
