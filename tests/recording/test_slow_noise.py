"""The noise of a position is sought where the joint is slow: at speed other errors are larger."""

import numpy as np
import pytest

from jointid import _core

TIME = np.arange(0.0, 8.0, 1e-3)


def test_what_is_rough_at_speed_is_no_noise_of_the_position() -> None:
    """Half of the time slow, with noise of 20 µrad; half of it ten times as fast, and ten times as rough."""
    rng = np.random.default_rng(2)
    fast = TIME >= 4.0
    velocity = np.where(fast, 2.0, 0.2)
    rough = np.where(fast, 2e-4, 2e-5)
    position = np.cumsum(velocity) * 1e-3 + rough * rng.normal(size=TIME.size)
    found = _core.position_noise(TIME, position, [], 1e-3)
    assert found.sigma == pytest.approx(2e-5, rel=0.15)
