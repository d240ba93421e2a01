"""Least squares inside bounds: what SciPy finds, without SciPy."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear, nnls

from jointid.balance.least_squares import bounded_minima


def solved(left: np.ndarray, right: np.ndarray, least: np.ndarray | float) -> np.ndarray:
    """Of one problem, by its normal equations."""
    found = bounded_minima((left.T @ left)[None], -(left.T @ right)[None], least, np.inf)
    return np.asarray(found[0])


def test_minima_inside_a_box_meet_their_conditions() -> None:
    rng = np.random.default_rng(1)
    rows = rng.normal(size=(400, 9, 6))
    square, gradient = np.einsum("nij,nik->njk", rows, rows), 8.0 * rng.normal(size=(400, 6))
    lower, upper = np.full(6, -0.3), np.array([0.3, 0.0, 0.2, np.inf, 0.5, 1.0])
    found = bounded_minima(square, gradient, lower, upper)
    slope = np.einsum("nij,nj->ni", square, found) + gradient
    below, above = found <= lower, found >= upper
    assert below.any()
    assert above.any()
    assert np.all(slope[below] >= -1e-6)
    assert np.all(slope[above] <= 1e-6)
    np.testing.assert_allclose(slope[~below & ~above], 0.0, atol=1e-6)


@pytest.mark.parametrize("seed", range(40))
def test_the_values_are_those_of_scipy(seed: int) -> None:
    draws = np.random.default_rng(seed)
    count = int(draws.integers(1, 30))
    left = draws.normal(size=(3 * count, count)) @ np.diag(draws.uniform(0.5, 2.0, count))
    if count > 4:
        left[:, 1] += 30.0 * left[:, 3]  # nearly alike
    right = left @ draws.normal(size=count) + draws.normal(size=3 * count)
    least = np.where(draws.uniform(size=count) < 0.6, 0.0, -np.inf)
    values = solved(left, right, least)
    expected = lsq_linear(left, right, bounds=(least, np.inf), method="bvls", tol=1e-14)
    np.testing.assert_allclose(values, expected.x, rtol=1e-9, atol=1e-9 * np.abs(values).max())
    np.testing.assert_array_equal(values == least, expected.active_mask < 0)


def test_a_column_that_others_explain_gets_nothing() -> None:
    draws = np.random.default_rng(1)
    left = draws.normal(size=(30, 3))
    left = np.c_[left, left[:, 0] + left[:, 1], left[:, 2]]
    right = left[:, :3] @ [1.0, 2.0, -3.0]
    least = np.array([-np.inf, -np.inf, -np.inf, 0.0, 0.0])
    values = solved(left, right, least)
    np.testing.assert_allclose(left @ values, right, atol=1e-6)
    assert np.abs(values).max() < 4.0
    assert values[least == 0.0].min() >= 0.0


def problem(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """A least-squares problem: ordinary, with more columns than rows, collinear, with zeros, badly scaled."""
    rows, columns = int(rng.integers(1, 40)), int(rng.integers(1, 8))
    matrix = rng.normal(size=(rows, columns))
    match rng.integers(6):
        case 1:
            matrix = np.abs(matrix)
        case 2:
            matrix[:, -1] = matrix[:, 0]
        case 3:
            matrix[:, rng.integers(columns)] = 0.0
        case 4:
            matrix *= 10.0 ** rng.uniform(-6, 6, columns)
        case 5:
            matrix = np.outer(matrix[:, 0], rng.normal(size=columns))
    target = matrix @ np.maximum(rng.normal(size=columns), 0.0)
    return matrix, target + 10.0 ** rng.uniform(-9, 1) * rng.normal(size=rows)


def test_values_without_negative_ones_are_scipy_s() -> None:
    rng = np.random.default_rng(3)
    for _ in range(600):
        matrix, target = problem(rng)
        found = solved(matrix, target, 0.0)
        there, least = nnls(matrix, target)
        assert np.all(found >= 0.0)
        rounding = 1e-9 * float(np.linalg.norm(target))  # of normal equations
        assert float(np.linalg.norm(matrix @ found - target)) <= least * (1.0 + 1e-9) + rounding
        size = np.linalg.norm(matrix, axis=0)
        if np.linalg.matrix_rank(matrix / np.where(size > 0.0, size, 1.0)) == len(found):
            scale = 1e-7 * np.linalg.norm(target) / size
            assert np.all(np.abs(found - there) <= scale)


def test_many_problems_are_solved_as_one_by_one() -> None:
    generator = np.random.default_rng(3)
    tables = generator.normal(size=(200, 9, 6)) * 10.0 ** generator.uniform(-3, 3, (200, 1, 6))
    right = generator.normal(size=(200, 9))
    turned = tables.transpose(0, 2, 1)
    found = bounded_minima(turned @ tables, -(turned @ right[:, :, None])[:, :, 0], 0.0, np.inf)
    wanted = np.array([nnls(a, b)[0] for a, b in zip(tables, right, strict=True)])
    scale = np.linalg.norm(tables, axis=1)
    assert (wanted == 0.0).any(axis=0).all()
    assert np.abs((found - wanted) * scale).max() < 1e-9
    assert (found >= 0.0).all()


def test_nothing_is_solved_as_nothing() -> None:
    assert solved(np.zeros((3, 2)), np.array([3.0, 0.0, 4.0]), 0.0).tolist() == [0.0, 0.0]
    assert solved(np.zeros((3, 0)), np.array([3.0, 0.0, 4.0]), 0.0).size == 0
    with pytest.raises(ValueError, match="must fit together"):
        bounded_minima(np.zeros((1, 3, 3)), np.zeros((1, 2)), 0.0, np.inf)
