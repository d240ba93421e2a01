"""Standard errors: right for white residuals, wide enough for drifting ones, infinite where nothing is known."""

from pathlib import Path

import numpy as np
import pytest

import jointid as jid
from jointid.balance.covariance import parameter_covariance
from jointid.balance.segments import Segments, even_segments
from jointid.cli.demonstration import data_folder
from jointid.estimate.student import quantile
from jointid.identification.prepared import prepare

ROWS = 400


def _design(rng: np.random.Generator) -> np.ndarray:
    time = np.linspace(0.0, 1.0, ROWS)
    return np.column_stack([np.ones(ROWS), np.sin(7.0 * time), rng.normal(size=ROWS)])


def _noise(rng: np.random.Generator, memory: float) -> np.ndarray:
    white = rng.normal(size=ROWS)
    noise = np.empty(ROWS)
    level = white[0] / np.sqrt(1.0 - memory**2)
    for k in range(ROWS):
        level = memory * level + white[k] if k else level
        noise[k] = level
    return noise


@pytest.mark.parametrize(("memory", "low"), [(0.0, 0.92), (0.5, 0.91), (0.8, 0.88), (0.9, 0.85)])
def test_intervals_cover(memory: float, low: float) -> None:
    rng = np.random.default_rng(5)
    truth = np.array([1.0, -2.0, 0.5])
    factor = quantile(0.975, ROWS - 3)
    inside = np.zeros(3)
    trials = 300
    for _ in range(trials):
        design = _design(rng)
        measured = design @ truth + _noise(rng, memory)
        found, *_ = np.linalg.lstsq(design, measured, rcond=None)
        spread = parameter_covariance(design, measured - design @ found, None)
        inside += np.abs(found - truth) < factor * spread.stderr
    assert np.all(inside / trials >= low)
    assert np.all(inside / trials <= 0.995)


def test_classical_errors_would_flatter_where_ours_do_not() -> None:
    rng = np.random.default_rng(6)
    design = _design(rng)
    residual = _noise(rng, 0.8)
    residual -= design @ np.linalg.lstsq(design, residual, rcond=None)[0]
    variance = residual @ residual / (ROWS - 3)
    classical = np.sqrt(np.diag(np.linalg.inv(design.T @ design)) * variance)
    ours = parameter_covariance(design, residual, None).stderr
    assert ours[0] > 2.2 * classical[0]
    assert np.all(ours >= classical * (1 - 1e-9))


@pytest.mark.parametrize("kind", ["white", "slow motion", "drifting"])
def test_few_segments_still_cover(kind: str) -> None:
    """Eight segments of 25 windows: the quantile has their degrees of freedom, not those of 200 windows."""
    rng = np.random.default_rng(9)
    rows, trials = 200, 400
    cuts = np.arange(0, rows + 1, 25)
    segments = Segments(length=1.0, cuts=(cuts, cuts))
    speed = np.sin(np.linspace(0.0, 8.0 * np.pi, rows))
    design = np.column_stack([np.sign(speed), speed, np.ones(rows), np.gradient(speed)])
    solve = np.linalg.pinv(design)
    inside, widths = np.zeros(4), np.zeros(4)
    for _ in range(trials):
        noise = rng.normal(size=rows)
        if kind == "slow motion":
            noise *= np.where(np.abs(speed) < 0.3, 4.0, 1.0)
        elif kind == "drifting":
            noise = 0.3 * noise + np.repeat(rng.normal(size=8), 25)
        error = solve @ noise
        spread = parameter_covariance(design, noise - design @ error, None, segments=segments)
        half = np.array([quantile(0.975, f) for f in spread.freedom]) * spread.stderr
        inside += np.abs(error) < half
        widths += spread.freedom
    assert np.all(inside / trials >= 0.92)
    assert np.all(inside / trials <= 0.99)
    assert np.all((widths / trials < 20.0) == (kind == "drifting"))


def test_errors_are_those_of_resampled_motion() -> None:
    """On a real log: against a block bootstrap that shares nothing with ours but the Jacobian."""
    run = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    prepared = prepare((run,), joint)
    estimate = jid.identify(run, joint, search="separable")
    best = np.array([p.value for p in estimate.parameters.values()])
    _, residual, jacobian = prepared.penalty.linearised(best)
    rng = np.random.default_rng(0)
    for length in (8, 16, 24):  # windows of 64 ms: half a second to one and a half
        moved = []
        for _ in range(400):
            first = rng.integers(0, len(residual) - length + 1, -(-len(residual) // length))
            index = (first[:, None] + np.arange(length)).ravel()
            moved.append(np.linalg.lstsq(jacobian[index], -residual[index], rcond=None)[0])
        # Draws that hold one direction of motion only scatter without limit: the middle 68 %.
        low, high = np.quantile(moved, (0.1587, 0.8413), axis=0)
        for p, scatter in zip(estimate.parameters.values(), 0.5 * (high - low), strict=True):
            assert 0.6 < (p.stderr or 0.0) / scatter < 1.6, (p.name, length)


def test_what_nothing_determines_has_an_infinite_error() -> None:
    rng = np.random.default_rng(7)
    design = _design(rng)
    design = np.column_stack([design, design[:, 1] * 3.0, np.zeros(ROWS)])
    stderr = parameter_covariance(design, rng.normal(size=ROWS), None).stderr
    assert np.isfinite(stderr[[0, 2]]).all()
    assert np.isinf(stderr[[1, 3, 4]]).all()


def test_centring_takes_the_sensors_zero_out_of_the_correlation() -> None:
    rng = np.random.default_rng(8)
    signal = rng.normal(size=ROWS) + 40.0
    design = np.column_stack([signal, np.ones(ROWS)])
    residual = rng.normal(size=ROWS)
    raw = parameter_covariance(design, residual, None)
    centred = parameter_covariance(design, residual, (0, 1, float(signal.mean())))
    assert abs(raw.correlation[0, 1]) > 0.99
    assert abs(centred.correlation[0, 1]) < 1e-6
    np.testing.assert_allclose(raw.stderr, centred.stderr)


def test_parameters_go_together_as_segments_say() -> None:
    """Residuals that drift slowly leave Coulomb and viscous friction less alike than independent ones."""
    rng = np.random.default_rng(4)
    count, memory = 1200, 0.9
    turns = 2.0 * np.pi * np.arange(count) / count
    velocity = np.sin(9.0 * turns) + 0.3 * np.sin(4.0 * turns + 1.0)
    jacobian = np.column_stack([np.sign(velocity), velocity, np.cos(2.3 * turns)])
    lags = np.abs(np.subtract.outer(np.arange(count), np.arange(count)))
    taken = np.linalg.pinv(jacobian)
    true = taken @ (memory**lags) @ taken.T
    wanted = true[0, 1] / np.sqrt(true[0, 0] * true[1, 1])
    found, classical = [], []
    for _ in range(40):
        noise = np.zeros(count)
        steps = rng.normal(size=count)
        for place in range(1, count):
            noise[place] = memory * noise[place - 1] + steps[place]
        spread = parameter_covariance(
            jacobian, noise - jacobian @ (taken @ noise), None, segments=even_segments(count)
        )
        found.append(spread.matrix[0, 1] / (spread.stderr[0] * spread.stderr[1]))
        classical.append(spread.correlation[0, 1])
        assert np.linalg.eigvalsh(spread.matrix).min() > 0.0
    assert np.mean(found) == pytest.approx(wanted, abs=0.05)
    assert abs(np.mean(classical) - wanted) > 0.08


@pytest.mark.parametrize("memory", [0.0, 0.9])
def test_information_is_the_inverse_of_the_covariance(memory: float) -> None:
    rng = np.random.default_rng(8)
    design = _design(rng) * [1e-3, 1.0, 1e4]
    residual = _noise(rng, memory)
    residual -= design @ np.linalg.lstsq(design, residual, rcond=None)[0]
    spread = parameter_covariance(design, residual, None)
    np.testing.assert_allclose(spread.information @ spread.matrix, np.eye(3), atol=1e-6)


def test_information_knows_the_sum_of_what_nothing_divides() -> None:
    """Two equal columns: their errors are infinite, and that of their sum is the column's own."""
    rng = np.random.default_rng(9)
    one, other = rng.normal(size=(2, ROWS))
    residual = rng.normal(size=ROWS)
    both = parameter_covariance(np.column_stack([one, one, other]), residual, None)
    alone = parameter_covariance(np.column_stack([one, other]), residual, None)
    assert np.isinf(np.diag(both.matrix)[:2]).all()
    np.testing.assert_allclose(both.information @ [1.0, -1.0, 0.0], 0.0, atol=1e-9 * ROWS)
    np.testing.assert_allclose(both.information[1:, 1:], alone.information, rtol=0.02)


def test_without_a_degree_of_freedom_there_is_no_information() -> None:
    spread = parameter_covariance(np.eye(3), np.zeros(3), None)
    assert not spread.information.any()


def test_no_information_along_what_no_motion_divides(shared_data: Path) -> None:
    """An offset and the difference of the two directions' Coulomb frictions."""
    run = jid.load(shared_data / "simulated" / "poorly_excited.csv.gz")
    estimate = jid.identify(run, model=jid.Model.parse("stribeck:asymmetric"))
    change = {"sensor_offset": -1.0, "coulomb_positive": 1.0, "coulomb_negative": -1.0}
    along = np.array([change.get(name, 0.0) for name in estimate.free])
    assert estimate.information is not None
    size = np.sqrt(np.diag(estimate.information))
    assert (np.abs(estimate.information @ along) < 1e-9 * size * size.max()).all()
    given = [place for place, name in enumerate(estimate.free) if name != "sensor_offset"]
    block = np.ix_(given, given)
    product = estimate.information[block] @ estimate.covariance[block]
    np.testing.assert_allclose(product, np.eye(len(given)), atol=1e-6)


def test_what_is_not_finite_is_no_error_of_zero() -> None:
    design = _design(np.random.default_rng(2))
    for value in (np.nan, np.inf, 1e160):
        with pytest.raises(ValueError, match="finite"):
            parameter_covariance(
                np.where(np.eye(*design.shape), value, design), np.ones(ROWS), None
            )


def test_fewer_rows_than_parameters_correlate_by_what_they_have() -> None:
    """The directions that no row has say nothing of the others."""
    design = np.array([[1.0, 1.0, 1.0], [1.0, 2.0, 4.0]])
    scaled = design / np.linalg.norm(design, axis=0)
    inverse = np.linalg.pinv(scaled.T @ scaled)
    own = np.sqrt(np.diag(inverse))
    found = parameter_covariance(design, np.ones(2), None)
    np.testing.assert_allclose(found.correlation, inverse / np.outer(own, own), atol=1e-9)
    assert np.isinf(found.stderr).all()


@pytest.mark.parametrize("drifting", [False, True])
def test_columns_of_unlike_size_have_the_covariance_of_their_textbook(drifting: bool) -> None:
    """Against NumPy's decompositions: of white residuals, and by what ratio those of segments are wider."""
    rng = np.random.default_rng(8)
    for count in (1, 3, 7):
        design = rng.normal(size=(ROWS, count)) * 10.0 ** rng.uniform(-6.0, 6.0, count)
        residual = _noise(rng, 0.9 if drifting else 0.0)
        found = parameter_covariance(design, residual, None)
        assert found.white != drifting
        sizes = np.linalg.norm(design, axis=0)
        inverse = np.linalg.inv((design / sizes).T @ (design / sizes))
        classical = inverse * (residual @ residual) / (ROWS - count)
        scaled = found.matrix * np.outer(sizes, sizes)
        if not drifting:
            rows = (design / sizes) @ inverse
            white = np.square(rows * residual[:, None]).sum(axis=0) * ROWS / (ROWS - count)
            stretch = np.sqrt(np.maximum(white / np.diag(classical), 1.0))
            np.testing.assert_allclose(scaled, classical * np.outer(stretch, stretch), rtol=1e-10)
        own = np.sqrt(np.diag(inverse))
        np.testing.assert_allclose(found.correlation, inverse / np.outer(own, own), atol=1e-12)
        assert found.condition == pytest.approx(np.linalg.cond(design / sizes), rel=1e-10)
        _, _, directions = np.linalg.svd(design / sizes)
        np.testing.assert_allclose(np.abs(found.weakest), np.abs(directions[-1]), atol=1e-12)
        product = found.information * np.outer(1.0 / sizes, 1.0 / sizes) @ scaled
        np.testing.assert_allclose(product, np.eye(count), atol=1e-9)
