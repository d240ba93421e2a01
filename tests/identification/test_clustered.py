"""Variances by segments: what they borrow where segments are few, and when residuals count as white."""

import numpy as np

from jointid.balance.covariance import Covariance, parameter_covariance
from jointid.balance.segments import Segments

ROWS = 200


def spread_of(design: np.ndarray, noise: np.ndarray, segments: int) -> Covariance:
    cuts = np.linspace(0, ROWS, segments + 1).astype(int)
    residual = noise - design @ np.linalg.lstsq(design, noise, rcond=None)[0]
    chosen = Segments(length=1.0, cuts=(cuts, cuts))
    return parameter_covariance(design, residual, None, segments=chosen)


def test_fewer_segments_than_parameters_tell_them_apart_still() -> None:
    """Alone they would give a matrix of their own rank; what independent windows say makes it whole."""
    rng = np.random.default_rng(3)
    design = rng.normal(size=(ROWS, 5))
    drift = np.repeat(rng.normal(size=(3, 5)), (67, 67, 66), axis=0)
    spread = spread_of(design, 0.1 * rng.normal(size=ROWS) + (design * drift).sum(axis=1), 3)
    assert spread.freedom.max() < 10.0  # not white
    correlation = spread.matrix / np.outer(spread.stderr, spread.stderr)
    assert np.linalg.eigvalsh(correlation).min() > 0.1


def test_a_share_that_changes_from_segment_to_segment_is_found() -> None:
    """All parameters together tell it: 32 sums, of twice the variance of white ones, where one has eight."""
    rng = np.random.default_rng(4)
    refused = {0.0: 0, 0.2: 0}
    trials = 200
    for size in refused:
        for _ in range(trials):
            design = rng.normal(size=(ROWS, 4))
            share = np.repeat(size * rng.normal(size=(8, 4)), ROWS // 8, axis=0)
            spread = spread_of(design, rng.normal(size=ROWS) + (design * share).sum(axis=1), 8)
            refused[size] += bool(spread.freedom[0] < 0.5 * ROWS)
    assert refused[0.0] <= 0.05 * trials
    assert refused[0.2] >= 0.5 * trials


def test_columns_of_zeros_determine_no_direction() -> None:
    """Friction of a direction in which the joint never moves: no error, and nothing to take apart."""
    noise = np.random.default_rng(5).normal(size=ROWS)
    spread = spread_of(np.zeros((ROWS, 2)), noise, 8)
    assert np.isinf(spread.stderr).all()
