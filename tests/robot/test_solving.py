"""Least squares above zero: what SciPy finds, without SciPy."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from jointid.robot.solving import bounded


@pytest.mark.parametrize("seed", range(40))
def test_the_values_are_those_of_scipy(seed: int) -> None:
    draws = np.random.default_rng(seed)
    count = int(draws.integers(1, 30))
    left = draws.normal(size=(3 * count, count)) @ np.diag(draws.uniform(0.5, 2.0, count))
    if count > 4:
        left[:, 1] += 30.0 * left[:, 3]  # nearly alike
    right = left @ draws.normal(size=count) + draws.normal(size=3 * count)
    least = np.where(draws.uniform(size=count) < 0.6, 0.0, -np.inf)
    values, at_bound = bounded(np.c_[left, right].T @ np.c_[left, right], least)
    expected = lsq_linear(left, right, bounds=(least, np.inf), method="bvls", tol=1e-14)
    np.testing.assert_allclose(values, expected.x, rtol=1e-9, atol=1e-9 * np.abs(values).max())
    np.testing.assert_array_equal(at_bound, expected.active_mask < 0)
    assert (values[at_bound] == 0.0).all()


def test_a_column_that_others_explain_gets_nothing() -> None:
    draws = np.random.default_rng(1)
    left = draws.normal(size=(30, 3))
    left = np.c_[left, left[:, 0] + left[:, 1], left[:, 2]]
    right = left[:, :3] @ [1.0, 2.0, -3.0]
    least = np.array([-np.inf, -np.inf, -np.inf, 0.0, 0.0])
    values, at_bound = bounded(np.c_[left, right].T @ np.c_[left, right], least)
    np.testing.assert_allclose(left @ values, right, atol=1e-6)
    assert np.abs(values).max() < 4.0
    assert values[least == 0.0].min() >= 0.0
    assert not at_bound[:3].any()
