"""A joint that is stepped from outside moves as a simulated one does, to the bit."""

import math

import numpy as np
import pytest
from closed_loop import TRUTH, thesis_joint

import jointid as jid
from jointid.simulation.stepped import stepped_joint

TRUE = thesis_joint().with_parameters(TRUTH)
SENSORS = jid.Sensors(torque_noise=0.5, ripple=2.6, filter_order=1, filter_frequency=200.0)


@pytest.mark.parametrize("bristle", [None, jid.Bristle(stiffness=1e5)])
def test_the_same_torques_give_the_same_bits(bristle: jid.Bristle | None) -> None:
    motion = jid.Trajectory.thesis(math.radians(30.0), cycle=0.5, duration=0.5)
    law = jid.AdaptiveRobust(**jid.control_estimates(TRUE))
    step = 2.5e-4
    run = jid.simulate(
        TRUE, law, motion, integration_step=step, sensors=SENSORS, bristle=bristle, seed=5
    )
    assert run.sensor is not None
    assert run.torque is not None
    joint = stepped_joint(
        TRUE, period=1e-3, integration_step=step, sensors=SENSORS, bristle=bristle, seed=5
    )
    for k in range(len(run)):
        seen = joint.observe()
        assert joint.position == run.truth.signals["position"][k]
        assert joint.velocity == run.truth.signals["velocity"][k]
        assert seen.reading == run.sensor[k]
        joint.advance(run.torque[k], 1e-3)


def test_below_breakaway_it_stays_exactly_where_it_is() -> None:
    joint = stepped_joint(TRUE, position=0.2)
    weight = joint.link_torque
    for push in np.linspace(-44.0, 44.0, 89):
        joint.advance(weight + push, 0.01)
        assert (joint.position, joint.velocity) == (0.2, 0.0)
    joint.advance(weight + 46.0, 0.05)
    assert joint.position > 0.2


def test_a_torque_is_cut_at_the_joints_limit() -> None:
    one, other = stepped_joint(TRUE), stepped_joint(TRUE)
    one.advance(1e6, 0.1)
    assert TRUE.limits.torque is not None
    other.advance(TRUE.limits.torque, 0.1)
    assert one.position == other.position


def test_time_is_the_sum_of_the_steps() -> None:
    joint = stepped_joint(TRUE)
    for duration in (0.0, 1e-5, 3.3e-3, 1e-3):
        joint.advance(0.0, duration)
    assert joint.time == pytest.approx(4.31e-3, abs=1e-15)


@pytest.mark.parametrize(
    ("torque", "duration", "wording"),
    [
        (math.nan, 1e-3, "torque"),
        (math.inf, 1e-3, "torque"),
        (1.0, -1e-3, "duration"),
        (1.0, math.nan, "duration"),
    ],
)
def test_what_cannot_be_stepped_is_refused(torque: float, duration: float, wording: str) -> None:
    with pytest.raises(ValueError, match=wording):
        stepped_joint(TRUE).advance(torque, duration)


@pytest.mark.parametrize(
    ("change", "wording"),
    [
        ({"period": 0.0}, "period"),
        ({"integration_step": -1.0}, "step"),
        ({"position": math.nan}, "position"),
    ],
)
def test_a_joint_that_cannot_be_is_refused(change: dict[str, float], wording: str) -> None:
    with pytest.raises(ValueError, match=wording):
        stepped_joint(TRUE, **change)  # type: ignore[arg-type]
