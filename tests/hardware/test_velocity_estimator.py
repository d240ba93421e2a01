"""The velocity on line: over at least so many counts, and never over longer than was said."""

import pytest

from jointid.hardware.session.velocity_estimator import VelocityEstimator

PERIOD = 1e-3


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_it_is_taken_over_the_counts_that_were_asked_for(sign: float) -> None:
    """A count a cycle, then none: five counts are five cycles."""
    velocity = VelocityEstimator(1.0, counts=5, longest=1.0)
    seen = [velocity(k * PERIOD, sign * min(k, 20)) for k in range(22)]
    assert seen[:2] == [0.0, pytest.approx(sign / PERIOD)]
    assert seen[20] == pytest.approx(sign / PERIOD)
    # One cycle without a count: over five counts that is six cycles.
    assert seen[21] == pytest.approx(sign * 5.0 / (6.0 * PERIOD))


def test_five_counts_are_enough_and_four_are_not() -> None:
    for counts, since in ((4.0, 0.0), (5.0, 1.0)):
        velocity = VelocityEstimator(1.0, counts=5, longest=1.0)
        velocity(0.0, 0.0)
        velocity(1.0 * PERIOD, 0.0)
        velocity(2.0 * PERIOD, counts)
        # With enough counts behind the second sample the first is forgotten.
        expected = counts / ((2.0 - since) * PERIOD)
        assert velocity(2.0 * PERIOD, counts) == pytest.approx(expected)


def test_a_slow_joint_is_seen_over_the_longest_time() -> None:
    velocity = VelocityEstimator(1.0, counts=5, longest=10.5 * PERIOD)
    seen = [velocity(k * PERIOD, 0.1 * k) for k in range(40)]
    assert seen[30] == pytest.approx(0.1 / PERIOD)
    velocity = VelocityEstimator(1.0, counts=5, longest=10.5 * PERIOD)
    for k in range(20):
        velocity(k * PERIOD, 0.0)
    # One count in the last eleven cycles, which are the first that are longer than the longest time.
    assert velocity(20 * PERIOD, 1.0) == pytest.approx(1.0 / (10.0 * PERIOD))


def test_two_samples_are_always_kept() -> None:
    velocity = VelocityEstimator(1.0, counts=1, longest=0.5 * PERIOD)
    for k in range(5):
        seen = velocity(k * PERIOD, 10.0 * k)
    assert seen == pytest.approx(10.0 / PERIOD)
