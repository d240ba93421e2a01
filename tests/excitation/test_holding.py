"""A motion is made smaller until the limits hold, also where only a part of the torque scales with it."""

from __future__ import annotations

import pytest

from jointid.excitation.holding import _AIM, _LEAST, _STEPS, _next_size


@pytest.mark.parametrize("constant", [0.0, 0.5, 0.8])
@pytest.mark.parametrize("first", [1.005, 1.1, 1.4])
def test_steps_suffice_where_friction_takes_a_part_of_the_limit(
    constant: float, first: float
) -> None:
    tried: list[tuple[float, float]] = []
    size = 1.0
    for _ in range(_STEPS):
        share = constant + (first - constant) * size
        if share <= 1.0:
            break
        tried.append((size, share))
        smaller = _next_size(tried)
        assert _LEAST**2 * size <= smaller < size
        size = smaller
    assert share <= 1.0
    # No smaller than it has to be: proportional steps and extrapolation aim at the same share.
    assert size >= _LEAST * (_AIM - constant) / (first - constant)


def test_a_share_that_noise_keeps_up_does_not_stop_the_steps() -> None:
    assert _next_size([(1.0, 1.02), (0.97, 1.03)]) < 0.97 * _LEAST
