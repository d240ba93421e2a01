"""Intervals of what is systematic: known limits, opposite draws, chance that looks systematic."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from plants import Bench, Law, Log, simulate, thesis

import jointid as jid
from jointid.estimate.student import limited_half_width
from jointid.identification.inference.added_noise import NoiseEffect
from jointid.identification.inference.inference import _half_width
from jointid.identification.inference.motion import Motion, motion_segments
from jointid.identification.inference.random_shift import variance_over_segments
from jointid.identification.inference.systematic import admissible_shifts
from jointid.identification.inference.velocity_noise import measured_again
from jointid.identification.prepared import prepare
from jointid.recording.extra_noise import noise_unit


def _covered(half: float, stderr: float, limit: float) -> float:
    """Share of normal errors about `limit` that half an interval holds."""

    def below(x: float) -> float:
        return 0.5 * math.erfc(-x / math.sqrt(2.0))

    return below((half - limit) / stderr) - below((-half - limit) / stderr)


@pytest.mark.parametrize("limit", [1e-3, 0.3, 1.0, 2.5, 7.9, 8.1, 30.0])
def test_an_error_at_its_limit_is_covered_in_95_percent(limit: float) -> None:
    half = limited_half_width(2.0, 2.0 * limit)
    assert _covered(half, 2.0, 2.0 * limit) == pytest.approx(0.95, abs=1e-6)
    assert _covered(half, 2.0, 1.0 * limit) >= 0.95 - 1e-9
    assert _covered(half, 2.0, 0.0) >= 0.95 - 1e-9


def test_only_the_unknown_instant_is_a_limit() -> None:
    assert _half_width(0.0, {"sampling": 3.0}) == 3.0
    assert _half_width(1.959964, {"windows": 1.0}) == pytest.approx(1.959964 * math.sqrt(2.0))
    both = _half_width(1.959964, {"windows": 1.0, "sampling": 3.0, "given": 9.0})
    assert both == pytest.approx(limited_half_width(math.sqrt(2.0), 3.0))
    assert _half_width(1.959964, {"windows": 1.0, "residual_side": 9.0}) == pytest.approx(
        2.7718, rel=1e-4
    )


def _effect(shifts: list[list[float]], chance: float = 0.0) -> NoiseEffect:
    return NoiseEffect(
        shifts=np.array(shifts), spread=np.zeros(1), of_windows=np.zeros(1), chance=chance
    )


def test_what_two_pairs_of_draws_do_not_share_is_chance() -> None:
    assert _effect([[2.0], [2.0]]).systematic == pytest.approx([2.0])
    assert _effect([[2.0], [-2.0]]).systematic == pytest.approx([0.0])
    assert _effect([[2.0], [2.0]], chance=3.0).systematic == pytest.approx([1.0])
    assert _effect([[2.0], [2.0]], chance=5.0).systematic == pytest.approx([0.0])


@pytest.fixture(scope="module")
def runs() -> list[jid.Recording]:
    """A joint with an exact velocity, and with counts of an encoder alone."""
    bench = Bench(
        motion=thesis(np.radians([60.0, 60.0])),
        law=Law(inertia=2.8, stiffness=40.0, coulomb=20.0, gravity=7.0),
        log=Log(
            counts=np.array([0.0, 202e3]),
            velocity=np.array([1.0, 0.0]),
            sensor=0.0,
            torque_noise=0.2,
        ),
    )
    return simulate(bench, duration=6.0, seed=3, finer=3)


def test_draws_come_in_opposite_pairs(runs: list[jid.Recording]) -> None:
    first, second = (noise_unit(np.random.default_rng(1), 50, draw) for draw in (2, 3))
    np.testing.assert_array_equal(first, -second)
    exact, coarse = runs
    rng = np.random.default_rng(0)
    noisy = exact.with_velocity(exact.velocity + 0.01 * rng.standard_normal(len(exact)))
    pair = [measured_again(noisy, draw, 0).velocity for draw in range(4)]
    np.testing.assert_allclose(pair[0] + pair[1], 2.0 * noisy.velocity, atol=1e-12)
    assert np.std(pair[0] - pair[2]) > 0.005
    draws = np.array([measured_again(coarse, draw, 0).velocity for draw in range(8)])
    apart = draws - draws.mean(axis=0)
    opposite = [np.corrcoef(apart[i], apart[i + 1])[0, 1] for i in (0, 2, 4, 6)]
    assert max(opposite) < -0.2


def test_a_shift_of_one_sign_is_no_chance_and_one_of_many_is(runs: list[jid.Recording]) -> None:
    run = runs[0]
    joint = jid.Joint(sensor=False, model=jid.Model.parse("coulomb_viscous:gravity=free"))
    prepared = prepare((run,), joint)
    problem, penalty = prepared.problem, prepared.penalty
    best = np.array([jid.identify(run, joint).parameters[name].value for name in penalty.names])
    segments = motion_segments(Motion.of(problem, penalty))
    free = list(range(len(best)))

    def moved(velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        other = replace(problem, recordings=(problem.recordings[0].with_velocity(velocity),))
        chance = variance_over_segments(problem, other, penalty, best, free, segments)
        lower, upper = prepared.domain.lower, prepared.domain.upper
        there = other.parts(penalty.window_duration)
        return chance, there.refit(lower, upper, best) - best

    inertia = list(penalty.names).index("inertia")
    velocity = problem.recordings[0].velocity
    chance, shift = moved(1.05 * velocity)
    assert shift[inertia] ** 2 > 10.0 * chance[inertia]
    ratios = []
    for seed in range(8):
        slow = np.repeat(np.random.default_rng(seed).standard_normal(len(velocity) // 250 + 1), 250)
        chance, shift = moved(velocity + 0.004 * slow[: len(velocity)])
        ratios.append(shift[inertia] ** 2 / chance[inertia])
    assert 0.2 < float(np.mean(ratios)) < 4.0


def test_windows_too_short_for_the_noise_do_not_count() -> None:
    class Share:
        def __init__(self, share: float) -> None:
            self.noise_share = share

    halved, doubled = np.ones(2), 2.0 * np.ones(2)
    assert admissible_shifts(Share(1e-5), (halved, doubled)) == (halved, doubled)  # type: ignore[arg-type]
    assert admissible_shifts(Share(5e-4), (halved, doubled))[0] is None  # type: ignore[arg-type]
    assert admissible_shifts(Share(5e-4), (halved, None)) == (halved, None)  # type: ignore[arg-type]
