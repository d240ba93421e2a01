"""Standard errors of small regressions whose right answer is a formula: freedom, segments, what nothing determines."""

import numpy as np
import pytest

from jointid.balance.covariance import Covariance, parameter_covariance
from jointid.balance.segments import Segments, even_segments

_ROWS = 48
_SIGNS = np.where(np.random.default_rng(3).random(_ROWS) < 0.5, -1.0, 1.0)


def columns(*kinds: int) -> np.ndarray:
    """Columns of 1 and -1 that are orthogonal: each changes its sign every so many rows."""
    return np.column_stack(
        [np.where(np.arange(_ROWS) // each % 2 == 0, 1.0, -1.0) for each in kinds]
    )


def white(jacobian: np.ndarray, residual: np.ndarray) -> Covariance:
    found = parameter_covariance(jacobian, residual, None)
    assert found.white
    return found


def test_what_was_fitted_takes_degrees_of_freedom() -> None:
    """With equal residuals and leverages the variance is that of a mean over the rows that are left."""
    jacobian = columns(24, 12, 6, 3)
    found = white(jacobian, _SIGNS)
    assert found.stderr == pytest.approx(np.full(4, 1.0 / np.sqrt(_ROWS - 4)))
    assert found.freedom == pytest.approx(np.full(4, _ROWS - 4.0))
    assert np.diag(found.information) == pytest.approx(np.full(4, _ROWS - 4.0))


def test_noise_that_grows_with_the_motion_counts() -> None:
    """White's variance: residuals are as large as the column."""
    size = np.where(np.arange(_ROWS) % 3 == 0, 3.0, 1.0)
    jacobian = size[:, None]
    found = white(jacobian, size * _SIGNS)
    power = float(np.sum(size**2))
    expected = np.sqrt(float(np.sum(size**4)) * _ROWS / (_ROWS - 1.0)) / power
    assert found.stderr[0] == pytest.approx(expected)


def test_noise_that_is_smallest_where_it_counts_is_not_believed() -> None:
    """Not less than the classical variance."""
    size = np.where(np.arange(_ROWS) % 3 == 0, 3.0, 1.0)
    residual = _SIGNS / size
    found = white(size[:, None], residual)
    classical = np.sqrt(np.sum(residual**2) / (_ROWS - 1.0) / np.sum(size**2))
    assert found.stderr[0] == pytest.approx(classical)


def test_as_many_rows_as_parameters_know_no_error() -> None:
    found = parameter_covariance(np.eye(3), np.array([0.1, -0.2, 0.1]), None)
    assert np.all(np.isinf(found.stderr))
    assert np.all(found.information == 0.0)


def test_units_far_apart_are_determined_and_twins_are_not() -> None:
    both = columns(24, 12)
    near = np.column_stack([both[:, 0], both[:, 0] + 1e-6 * both[:, 1]])
    assert np.all(np.isfinite(parameter_covariance(near, _SIGNS, None).stderr))
    near[:, 1] = both[:, 0] + 1e-12 * both[:, 1]
    assert np.all(np.isinf(parameter_covariance(near, _SIGNS, None).stderr))
    apart = both * np.array([1e-9, 1e9])
    scaled = parameter_covariance(apart, _SIGNS, None).stderr * np.array([1e-9, 1e9])
    assert scaled == pytest.approx(parameter_covariance(both, _SIGNS, None).stderr)


def test_a_direction_that_is_unknown_spares_the_others() -> None:
    three = columns(24, 12, 6)
    found = parameter_covariance(np.column_stack([three, three[:, 2]]), _SIGNS, None)
    assert np.isfinite(found.stderr).tolist() == [True, True, False, False]


def test_near_twins_go_together() -> None:
    both = columns(24, 12)
    near = np.column_stack([both[:, 0], both[:, 0] + 1e-3 * both[:, 1]])
    found = parameter_covariance(near, _SIGNS, None)
    assert found.correlation[0, 1] == pytest.approx(-1.0, abs=1e-6)
    assert found.condition == pytest.approx(2e3, rel=0.01)
    assert abs(found.weakest[0] + found.weakest[1]) < 1e-3
    assert found.weakest == pytest.approx(found.weakest[0] * np.array([1.0, -1.0]), abs=1e-3)


def stretch_of(
    jacobian: np.ndarray, residual: np.ndarray, segments: Segments
) -> tuple[np.ndarray, Covariance]:
    """How much larger variances are than the classical ones, and the covariance."""
    rows, count = jacobian.shape
    found = parameter_covariance(jacobian, residual, None, segments=segments)
    classical = (
        np.diag(np.linalg.inv(jacobian.T @ jacobian)) * (residual @ residual) / (rows - count)
    )
    return np.diag(found.matrix) / classical, found


def drifting(rows: int, length: int) -> np.ndarray:
    """Residuals that keep their sign over so many rows."""
    return np.repeat(np.random.default_rng(5).choice([-1.0, 1.0], rows // length), length)


def test_residuals_that_hang_together_have_the_freedom_of_their_segments() -> None:
    rows = 1600
    jacobian = np.ones((rows, 1))
    residual = drifting(rows, 100)
    ratio, found = stretch_of(jacobian, residual, even_segments(rows))
    assert not found.white
    # Sixteen segments, or fourteen whole ones and two halves, and one freedom is lost to the mean.
    assert 14.0 < found.freedom[0] < 15.0
    assert ratio[0] == pytest.approx(100.0, rel=0.4)


def test_a_parameter_of_few_segments_borrows_freedom() -> None:
    rows = 1600
    jacobian = np.zeros((rows, 2))
    jacobian[:, 0], jacobian[100:200, 1] = 1.0, 1.0
    cuts = Segments(length=np.nan, cuts=(np.arange(0, rows + 1, 100), np.arange(0, rows + 1, 100)))
    residual = drifting(rows, 100)
    jacobian[100:200, 0] = 0.0
    _, found = stretch_of(jacobian, residual, cuts)
    assert not found.white
    assert found.freedom[1] == pytest.approx(5.0)
    assert found.freedom[0] == pytest.approx(14.0, abs=0.2)


def test_two_segments_tell_nothing() -> None:
    rows = 200
    cuts = np.array([0, 100, 200])
    jacobian = np.ones((rows, 1))
    ratio, found = stretch_of(
        jacobian,
        drifting(rows, 20),
        Segments(length=np.nan, cuts=(cuts, cuts)),
    )
    assert found.white
    assert ratio[0] == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(
    ("residual", "is_white"),
    [
        (np.tile([1.0, -1.0], 800), False),  # neighbours take back what they add
        (drifting(1600, 2), False),  # each two are alike
        (np.random.default_rng(6).choice([-1.0, 1.0], 1600), True),
    ],
)
def test_neighbours_contradict_white_residuals(residual: np.ndarray, is_white: bool) -> None:
    jacobian = np.ones((1600, 1))
    _, found = stretch_of(jacobian, residual, even_segments(1600))
    assert found.white == is_white


def test_segments_contradict_white_residuals_that_neighbours_do_not() -> None:
    """A slow drift that is small beside the noise of each window."""
    rows = 16000
    residual = np.tile([1.0, 1.0, -1.0, -1.0], rows // 4) + 0.1 * drifting(rows, 1000)
    jacobian = np.ones((rows, 1))
    neighbours = float(residual[1:] @ residual[:-1]) / float(residual @ residual)
    assert neighbours * np.sqrt(rows) < 2.3
    _, found = stretch_of(jacobian, residual, even_segments(rows))
    assert not found.white
