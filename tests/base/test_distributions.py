"""The core's quantiles against SciPy, over wide ranges."""

import math

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy import special

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
