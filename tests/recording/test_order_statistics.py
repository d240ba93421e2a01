"""Order statistics of our own are NumPy's."""

import numpy as np
import pytest

from jointid.recording.order_statistics import (
    distinct,
    median,
    quantile,
    quantile_of_sizes,
)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 7, 8, 100, 1001, 12_000])
def test_the_bits_are_those_of_numpy(count: int) -> None:
    draws = np.random.default_rng(count)
    for values in (
        draws.normal(size=count),
        np.round(draws.normal(size=count), 1),
        draws.integers(-3, 3, size=count),
        1e300 * draws.normal(size=(count, 2)),
    ):
        assert median(values) == np.median(values)
        for share in (0.0, 0.1, 0.25, 0.5, 0.9, 0.95, 0.975, 1.0, float(draws.uniform())):
            assert quantile(values, share) == np.quantile(values, share)
            before = np.array(values)
            assert quantile_of_sizes(values, share) == np.quantile(np.abs(values), share)
            np.testing.assert_array_equal(values, before)  # only a copy is put into order


def test_what_is_no_number_is_kept() -> None:
    assert median([3.0, 1.0, 2.0]) == 2.0
    assert median([np.inf, 1.0, np.inf]) == np.inf
    assert np.isnan(median([1.0, np.nan, 2.0]))
    assert np.isnan(median([]))
    assert np.isnan(quantile([1.0, np.nan, 2.0], 0.0))


@pytest.mark.parametrize("values", [[], [4], [2, 2, 2], [3, -1, 3, 0], [[5, 1], [1, 5]], (7, 1, 7)])
def test_whole_numbers_come_once(values: list[int]) -> None:
    found = distinct(values)
    assert found.dtype == np.int64
    assert found.tolist() == np.unique(values).tolist()
