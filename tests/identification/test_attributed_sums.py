"""The sums that attribution lives on, against the same by NumPy: folds of least squares, integrals over windows."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid import _core
from jointid.identification.causes.fitted import Fitted
from jointid.identification.causes.folds import Folds
from jointid.identification.causes.samples import WaySinceReversal, all_samples
from jointid.identification.prepared import prepare
from jointid.identification.search.domain import domain_for

_RIDGE = 1e-9


def _left(columns: np.ndarray, residual: np.ndarray, blocks: int) -> np.ndarray:
    """Sum of squares in each block, by a fit to the rows of all others; all of unit size."""
    size = np.sqrt((columns**2).sum(axis=0))
    columns, residual = columns / size, residual / np.sqrt((residual**2).sum())
    edges = np.linspace(0, len(residual), blocks + 1).astype(int)
    left = []
    for low, high in itertools.pairwise(edges):
        train = np.r_[0:low, high : len(residual)]
        square = columns[train].T @ columns[train] + _RIDGE * np.eye(columns.shape[1])
        found = np.linalg.solve(square, columns[train].T @ residual[train])
        left.append(np.sum((residual[low:high] - columns[low:high] @ found) ** 2))
    return np.array(left)


@pytest.mark.parametrize(("rows", "blocks"), [(403, 20), (50, 12), (27, 6)])
@pytest.mark.parametrize("asked", [[0], [3, 1], [0, 2, 4, 1, 3]])
def test_folds_are_least_squares_on_the_other_blocks(
    rows: int, blocks: int, asked: list[int]
) -> None:
    rng = np.random.default_rng(rows)
    columns = rng.normal(size=(rows, 5)) * [1.0, 1e-3, 1e4, 1.0, 5.0]
    columns[:, 4] += 5.0 * columns[:, 3]  # nearly alike
    residual = columns @ [0.5, 200.0, 1e-4, 1.0, 0.0] + rng.normal(size=rows)
    folds = Folds.of(columns, residual)
    assert folds is not None
    expected = _left(columns[:, asked], residual, blocks)
    np.testing.assert_allclose(folds.misfit(asked), expected, rtol=1e-9)


def test_columns_that_are_alike_or_nothing_are_no_harm() -> None:
    rng = np.random.default_rng(1)
    one = rng.normal(size=200)
    columns = np.column_stack([one, one, np.zeros(200)])
    folds = Folds.of(columns, one + rng.normal(size=200))
    assert folds is not None
    np.testing.assert_allclose(folds.misfit([0, 1, 2]), folds.misfit([0]), rtol=1e-6)
    with pytest.raises(ValueError, match="column"):
        folds.misfit([3])


@pytest.mark.parametrize("edges", [[0], [5, 0], [-1, 5], [0, 11]])
def test_edges_beyond_the_rows_are_refused(edges: list[int]) -> None:
    with pytest.raises(ValueError, match="edges"):
        _core.Folds(np.ones((10, 2)), edges)


@pytest.mark.parametrize("width", [None, 3])
def test_integrals_are_the_trapezoid_rule_over_what_counts(width: int | None) -> None:
    rng = np.random.default_rng(2)
    values = rng.normal(size=100 if width is None else (100, width))
    weights = np.where(rng.random(99) < 0.2, 0.0, rng.uniform(0.5, 1.5, 99))
    windows = np.array([[0, 10], [10, 11], [40, 40], [50, 99]])
    across = (slice(None),) + (None,) * (values.ndim - 1)
    area = 0.5 * (values[1:] + values[:-1]) * weights[across]
    rise = np.diff(values, axis=0) * (weights > 0.0)[across]
    for steps, rises in ((area, False), (rise, True)):
        expected = np.array([steps[low:high].sum(axis=0) for low, high in windows])
        found = _core.window_integrals(values, weights, windows, rise=rises)
        np.testing.assert_allclose(np.squeeze(found), expected, atol=1e-13)


@pytest.mark.parametrize("window", [[-1, 5], [0, 100]])
def test_windows_beyond_the_samples_are_refused(window: list[int]) -> None:
    with pytest.raises(ValueError, match="windows"):
        _core.window_integrals(np.ones(100), np.ones(99), np.array([window]))


@pytest.mark.parametrize("many", [1, 700, 1 << 20])
def test_sums_of_some_samples_at_a_time_are_those_of_all(
    monkeypatch: pytest.MonkeyPatch, many: int
) -> None:
    joint = jid.thesis_joint()
    whole = jid.load(WELL_EXCITED)
    problem = prepare((whole.crop(0.0, 3.0), whole.crop(4.0, 9.0)), joint).problem
    penalty = problem.penalty(None)
    domain = domain_for(penalty, joint, None, problem.peak_speed)
    best = 0.5 * (domain.lower + domain.upper)
    fit = Fitted.of(problem, penalty, best, (0,))
    monkeypatch.setattr("jointid.identification.causes.samples.AT_A_TIME", many)
    for of_each, of_all in (
        (fit.integral_of_each, fit.integral),
        (fit.rise_of_each, fit.rise),
    ):
        for columns in (1, 2):
            signals = [run.position[:, None] ** range(1, columns + 1) for run in problem.recordings]
            signals = [each[:, 0] if columns == 1 else each for each in signals]
            np.testing.assert_array_equal(
                of_each(lambda number, run, of=signals: of[number][run.cut]),  # type: ignore[misc]
                of_all(lambda number, _, of=signals: of[number]),  # type: ignore[misc]
            )
    covered = np.concatenate([part.position for part in all_samples(whole)])
    np.testing.assert_array_equal(covered, whole.position)


@pytest.mark.parametrize("many", [1, 7, 1 << 20])
def test_the_way_since_a_reversal_is_counted_across_parts(
    monkeypatch: pytest.MonkeyPatch, many: int
) -> None:
    monkeypatch.setattr("jointid.identification.causes.samples.AT_A_TIME", many)
    velocity = np.array([0.0, 1.0, 2.0, 1.0, -1.0, -2.0, 0.0, 0.0, -1.0, -1.0, 1.0, 1.0, 1.0])
    run = jid.Recording(
        time=0.1 * np.arange(13.0),
        position=np.array([0.0, 1.0, 3.0, 5.0, 5.0, 3.0, 2.0, 2.0, 1.0, 0.0, 0.0, 1.0, 3.0]),
        velocity=velocity,
        torque=velocity,
    )
    expected = [0.0, 1.0, 3.0, 5.0, 0.0, 2.0, 0.0, 0.0, 1.0, 2.0, 0.0, 1.0, 3.0]
    np.testing.assert_array_equal(WaySinceReversal(run).of(slice(0, 13)), expected)
    asked = WaySinceReversal(run)
    for begin, end in ((5, 9), (0, 3), (2, 13), (12, 13), (6, 7)):  # in any order
        np.testing.assert_array_equal(asked.of(slice(begin, end)), expected[begin:end])
