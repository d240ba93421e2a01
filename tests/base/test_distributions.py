"""The core's quantiles and non-negative least squares against SciPy, over wide ranges."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy import optimize, special

from jointid import _core

freedoms = st.floats(-0.5, 8.0).map(lambda exponent: 10.0**exponent)
probabilities = st.one_of(
    st.floats(1e-12, 1.0 - 1e-12),
    st.floats(-300.0, -0.5).map(lambda exponent: 10.0**exponent),
    st.floats(-15.0, -0.5).map(lambda exponent: 1.0 - 10.0**exponent),
)


# SciPy's own quantiles have been exact since some version only: one is known, of another the probability.
_half_width = math.sqrt(special.chndtrix(0.95, 1.0, 4.0))
_covered = special.ndtr(_half_width - 2.0) - special.ndtr(-_half_width - 2.0)
of_student = pytest.mark.skipif(
    not math.isclose(special.stdtrit(1.0, 0.9), math.tan(0.4 * math.pi), rel_tol=1e-14),
    reason="this SciPy's quantile of Student's t is off by 1e-11",
)
of_covering = pytest.mark.skipif(
    not math.isclose(_covered, 0.95, rel_tol=1e-14),
    reason="this SciPy's noncentral quantile is off by 1e-11",
)


@of_student
@settings(max_examples=500, deadline=None, derandomize=True)
@given(probabilities, freedoms)
def test_student_is_scipy_s(probability: float, freedom: float) -> None:
    found = _core.student_quantile(probability, freedom)
    there = float(special.stdtrit(freedom, probability))
    if not math.isfinite(there) or abs(found) > 1e150 or abs(probability - 0.5) < 1e-2:
        return  # where SciPy overflows, or loses digits: held by the next test
    if min(probability, 1.0 - probability) < 1e-100:
        return  # of 2 to 6 degrees of freedom SciPy 1.17 is off by a factor: held by the next test
    assert found == pytest.approx(there, rel=1e-11)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(probabilities, st.floats(-0.5, 3.0).map(lambda exponent: 10.0**exponent))
def test_the_probability_of_a_quantile_comes_back(probability: float, freedom: float) -> None:
    t = abs(_core.student_quantile(probability, freedom))
    if t > 1e100:
        return
    half = freedom / 2.0
    if abs(probability - 0.5) < 0.25:
        centre = 0.5 * special.betainc(0.5, half, t * t / (freedom + t * t))
        assert centre == pytest.approx(abs(probability - 0.5), rel=1e-12, abs=1e-300)
    else:
        tail = 0.5 * special.betainc(half, 0.5, 1.0 / (1.0 + t * t / freedom))
        # An ulp of the quantile is many of the tail.
        assert tail == pytest.approx(min(probability, 1.0 - probability), rel=1e-10)


@of_student
@pytest.mark.parametrize("freedom", [1.0, 1.5, 5.0, 37.3, 400.0, 1e6])
def test_student_at_its_usual_place(freedom: float) -> None:
    for probability in (0.5, 0.9, 0.95, 0.975, 0.995):
        found = _core.student_quantile(probability, freedom)
        assert found == pytest.approx(float(special.stdtrit(freedom, probability)), rel=1e-13)


def test_student_without_end_is_normal() -> None:
    for probability in (1e-300, 1e-9, 0.3, 0.6, 0.975):
        found = _core.student_quantile(probability, math.inf)
        assert found == pytest.approx(float(special.ndtri(probability)), rel=1e-12)
    assert _core.student_quantile(0.975, 1e25) == _core.student_quantile(0.975, math.inf)


@settings(max_examples=500, deadline=None, derandomize=True)
@given(probabilities, st.floats(-1.0, 5.0).map(lambda exponent: 10.0**exponent))
@example(0.1875, 0.1)
def test_chi_square_is_scipy_s(tail: float, freedom: float) -> None:
    found = _core.chi_square_quantile(tail, freedom)
    if tail <= 0.5:
        there = 2.0 * float(special.gammainccinv(freedom / 2.0, tail))
    else:
        there = 2.0 * float(special.gammaincinv(freedom / 2.0, 1.0 - tail))
    if there > 1e-290:
        assert found == pytest.approx(there, rel=2e-12)


@of_covering
@settings(max_examples=300, deadline=None, derandomize=True)
@given(
    st.floats(0.01, 0.999),
    st.one_of(
        st.just(0.0),
        st.floats(1e-8, 10.0),
        st.floats(-8.0, 2.0).map(lambda exponent: 10.0**exponent),
    ),
)
def test_the_covering_interval_is_scipy_s(probability: float, offset: float) -> None:
    found = _core.covering_half_width(probability, offset)
    there = math.sqrt(float(special.chndtrix(probability, 1.0, offset * offset)))
    assert found == pytest.approx(there, rel=1e-11)


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


def test_non_negative_least_squares_is_scipy_s() -> None:
    rng = np.random.default_rng(3)
    for _ in range(600):
        matrix, target = problem(rng)
        found, misfit = _core.non_negative_least_squares(matrix, target)
        there, least = optimize.nnls(matrix, target)
        assert np.all(found >= 0.0)
        rounding = 1e-12 * float(np.linalg.norm(target))
        assert misfit <= least * (1.0 + 1e-9) + rounding
        again = float(np.linalg.norm(matrix @ found - target))
        assert misfit == pytest.approx(again, rel=1e-9, abs=rounding)
        size = np.linalg.norm(matrix, axis=0)
        if np.linalg.matrix_rank(matrix / np.where(size > 0.0, size, 1.0)) == len(found):
            scale = 1e-7 * np.linalg.norm(target) / size
            assert np.all(np.abs(found - there) <= scale)


def test_non_negative_least_squares_of_nothing() -> None:
    found, misfit = _core.non_negative_least_squares(np.zeros((3, 2)), np.array([3.0, 0.0, 4.0]))
    assert found.tolist() == [0.0, 0.0]
    assert misfit == 5.0
    found, misfit = _core.non_negative_least_squares(np.zeros((3, 0)), np.array([3.0, 0.0, 4.0]))
    assert (found.size, misfit) == (0, 5.0)
    with pytest.raises(ValueError, match="a value for each row"):
        _core.non_negative_least_squares(np.zeros((3, 2)), np.zeros(4))
