"""Where nothing divides back-EMF from viscous friction, the share with the middle one of all free swings is taken."""

from dataclasses import replace

import numpy as np
import pytest
from simulated_servo import SUPPLY, Truth, bench_runs, servo_joint, with_truth

import jointid as jid

TRUTH = Truth()


def swing(total: float, share: float) -> np.ndarray:
    """A load that is let go, with this share of what brakes as back-EMF."""
    time = np.arange(0.0, 6.0, 0.002)
    extra = {"duty": 0.0 * time, "driven": 0.0 * time}
    run = jid.Recording(time=time, position=np.full(len(time), 1.2), extra=extra)
    joint = with_truth(replace(TRUTH, viscous=(1.0 - share) * total), servo_joint(supply=SUPPLY))
    return jid.rollout(joint, run).runs[0].position


def test_the_swing_of_the_share_is_in_the_middle_of_all_swings() -> None:
    runs = bench_runs(TRUTH, seed=1, runs=8, free=False)
    found = jid.identify_servo(runs, servo_joint(), draws=0)
    total = found["back_emf"] + found["viscous"]
    share = found["back_emf"] / total
    both = [swing(total, 0.0), swing(total, 1.0)]
    own = swing(total, share)
    near, far = sorted(float(np.abs(own - each).mean()) for each in both)
    assert near > 0.7 * far
    # Half of the number is not the middle: it is nearly all the way to the strongest friction.
    half = swing(total, 0.5)
    assert np.abs(half - both[0]).mean() < 0.3 * np.abs(half - both[1]).mean()
    finding = next(each for each in found.findings if each.code == "inseparable_back_emf")
    assert f"{round(100.0 * share)} %" in finding.cause


def test_a_resistance_or_a_constant_needs_no_share() -> None:
    runs = bench_runs(TRUTH, seed=1, runs=8, free=False)
    found = jid.identify_servo(runs, servo_joint(resistance=TRUTH.resistance), draws=0)
    assert found["viscous"] == pytest.approx(TRUTH.viscous, rel=0.25)
    assert not any(each.code == "inseparable_back_emf" for each in found.findings)
