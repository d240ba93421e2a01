"""Edges of a session's limits that a rounding or one more cycle passes."""

from typing import Any

import pytest

from jointid.hardware.session.drive import DriveSample
from jointid.hardware.session.guard import Guard
from jointid.hardware.session.lateness import Lateness
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.stop import LimitError
from jointid.hardware.session.velocity_estimator import VelocityEstimator
from jointid.simulation.peaks import Peaks

PERIOD, COUNT = 2e-3, 1e-5


def guard(**limits: Any) -> Guard:
    return Guard(SessionLimits(torque=100.0, torque_rate=1e9, **limits), PERIOD, COUNT)


@pytest.mark.parametrize(("share", "cut"), [(0.876, False), (0.874, True)])
def test_a_command_that_lost_more_than_an_eighth_was_cut(share: float, cut: bool) -> None:
    watched = guard(saturated_samples=1)
    for _ in range(2):
        watched.accepted(50.0, share * 50.0)
    if not cut:
        watched.commanded(50.0, 0)
        return
    with pytest.raises(LimitError) as caught:
        watched.commanded(50.0, 0)
    assert caught.value.limit == "saturated_samples"


@pytest.mark.parametrize(("counts", "hangs"), [(19.9, False), (20.1, True)])
def test_twenty_counts_a_cycle_are_motion(counts: float, hangs: bool) -> None:
    watched = guard(repeated_positions=3)
    velocity = counts * COUNT / PERIOD
    sample = DriveSample(time=0.0, position=0.5)

    def stand() -> None:
        for _ in range(5):
            watched.measured(sample, velocity, None)

    if not hangs:
        stand()
        return
    with pytest.raises(LimitError) as caught:
        stand()
    assert caught.value.limit == "repeated_positions"


def test_a_torque_that_is_cut_at_the_limit_passes_it_by_rounding_only() -> None:
    limits = SessionLimits(torque=100.0)

    def passed(torque: float) -> str:
        return limits.passed_by(
            Peaks(position=(0.0, 1.0), velocity=1.0, acceleration=1.0, torque=torque)
        )

    assert passed(100.0 * (1.0 + 1e-10)) == ""
    assert "torque" in passed(100.0 * (1.0 + 1e-8))


def late(lateness: Lateness, pattern: str) -> None:
    for each in pattern:
        lateness.on_time() if each == "." else lateness.late("it was lost")


def test_late_cycles_are_forgotten_after_five_seconds() -> None:
    """Of the ten cycles of this span two may be late; the tenth cycle behind one forgets it."""
    limits = SessionLimits(late_samples=2, late_share=0.2)
    lateness = Lateness(limits, 0.5)
    with pytest.raises(LimitError) as caught:
        late(lateness, "x.x......x")  # nine cycles behind the first
    assert caught.value.limit == "late_share"
    lateness = Lateness(limits, 0.5)
    late(lateness, "x.x.......")
    late(lateness, "x")  # ten cycles behind the first


def test_the_longest_row_is_remembered() -> None:
    lateness = Lateness(SessionLimits(), PERIOD)
    late(lateness, "xxx.x")
    assert (lateness.most_in_row, lateness.in_row, lateness.lost) == (3, 1, 4)


def test_a_fast_joint_is_seen_over_one_cycle() -> None:
    velocity = VelocityEstimator(COUNT)
    seen = [velocity(k * PERIOD, k * k * 100.0 * COUNT) for k in range(6)]
    assert seen[5] == pytest.approx((25.0 - 16.0) * 100.0 * COUNT / PERIOD)
