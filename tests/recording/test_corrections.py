"""Wrapped angles are unwrapped and held rows left out, by default; other jumps and slow motion stay as they are."""

import math

import numpy as np
import pytest
from analytic_motion import two_sines, worst
from closed_loop import TRUTH, thesis_joint

import jointid as jid
from jointid.recording.corrections import mended


def wrapped(run: jid.Recording, low: float, size: float) -> jid.Recording:
    return run.with_signals(position=low + (run.position - low) % size)


def codes(estimate: jid.Estimate) -> set[str]:
    return {each.code for each in estimate.findings}


@pytest.mark.parametrize(
    ("low", "size", "period"),
    [(0.0, 2 * math.pi, 0.005), (-math.pi, 2 * math.pi, 0.001), (-0.3, math.pi / 4, 0.005)],
    ids=["a turn", "half a turn to both sides", "a motor's turn"],
)
@pytest.mark.parametrize("recorded", [True, False], ids=["velocity", "no velocity"])
def test_a_wrapped_angle_is_unwrapped(
    low: float, size: float, period: float, recorded: bool
) -> None:
    run = two_sines(period, wide=4.0)
    if not recorded:
        run = run.with_velocity()
    made, (mend,) = mended(wrapped(run, low, size))
    assert mend.code == "unwrapped"
    assert mend.size == pytest.approx(size, rel=0.02)
    assert np.ptp(made.position - run.position) < 0.02 * size * mend.count
    estimate = jid.identify(wrapped(run, low, size))
    assert "unwrapped" in codes(estimate)
    assert worst(estimate) < 0.02


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("recorded", [True, False], ids=["velocity", "no velocity"])
def test_a_wrap_that_was_interpolated_is_unwrapped(share: float, recorded: bool) -> None:
    run = two_sines(wide=4.0)
    angle = wrapped(run, 0.0, 2 * math.pi).position.copy()
    places = np.flatnonzero(np.abs(np.diff(angle)) > math.pi) + 1
    angle[places] = (1.0 - share) * angle[places - 1] + share * angle[places + 1]
    made = run.with_signals(position=angle)
    made = made if recorded else made.with_velocity()
    assert np.ptp(mended(made)[0].position - run.position) < 0.05
    assert worst(jid.identify(made)) < 0.02


def test_one_of_several_runs_is_wrapped() -> None:
    runs = [two_sines(wide=4.0), two_sines(wide=3.0, seed=1)]
    runs[1] = wrapped(runs[1], 0.0, 2 * math.pi)
    assert worst(jid.identify(runs)) < 0.02


def test_a_lost_index_is_no_wrap() -> None:
    run = two_sines(wide=4.0)
    lost = run.position + np.where(run.time > 9.0, 1.7, 0.0)
    assert mended(run.with_signals(position=lost))[1] == ()
    assert mended(run)[1] == ()


def held(run: jid.Recording, rows: int, *, velocity: str) -> jid.Recording:
    """A bus that has a new sample every so many rows."""
    first = np.arange(len(run)) // rows * rows
    signals: dict[str, object] = {"position": run.position[first]}
    if velocity == "held":
        signals["velocity"] = run.velocity[first]
    made = run.with_signals(**signals)  # type: ignore[arg-type]
    return made.with_velocity() if velocity == "none" else made


@pytest.mark.parametrize("velocity", ["held", "fresh", "none"])
@pytest.mark.parametrize(("period", "rows"), [(0.001, 4), (0.002, 5), (0.005, 3)])
def test_held_rows_are_left_out(period: float, rows: int, velocity: str) -> None:
    run = held(two_sines(period), rows, velocity=velocity)
    made, (mend,) = mended(run)
    assert mend.size == pytest.approx(rows, rel=0.05)
    assert made.sample_period == pytest.approx(rows * period)
    estimate = jid.identify(run)
    assert "held_rows" in codes(estimate)
    assert "not" not in estimate.verdict.level
    assert worst(estimate) < 0.02


def test_a_standstill_is_kept_on_the_clock_of_the_samples() -> None:
    run = two_sines()
    still = np.clip(run.time - 5.0, 0.0, None) * (run.time > 5.0)
    position, velocity = np.interp(still, run.time, run.position), run.velocity * (run.time > 5.0)
    rested = held(run.with_signals(position=position, velocity=velocity), 4, velocity="held")
    made, _ = mended(rested)
    assert made.duration == pytest.approx(rested.duration, abs=0.05)
    assert made.gaps == ()


@pytest.mark.parametrize("recorded", [True, False])
def test_slow_motion_of_a_coarse_encoder_is_not_held(recorded: bool) -> None:
    run = two_sines(0.001)
    coarse = run.with_signals(position=np.round(run.position / 0.01) * 0.01)
    assert mended(coarse if recorded else coarse.with_velocity())[1] == ()


def test_a_joint_that_sticks_is_not_held() -> None:
    joint = thesis_joint().with_parameters(TRUTH)
    law = jid.Pd(stiffness=3000.0, damping=200.0)
    run = jid.simulate(
        joint, law, jid.Trajectory.thesis(math.radians(5.0), cycle=3.0, duration=6.0)
    )
    assert np.count_nonzero(np.diff(run.position) == 0.0) > 0.05 * len(run)
    assert mended(run)[1] == ()


def test_a_prediction_takes_the_same_recordings() -> None:
    estimate = jid.identify(two_sines(wide=4.0))
    run = two_sines(wide=3.5, seed=2)
    plain = estimate.predict(run)
    assert estimate.predict(wrapped(run, 0.0, 2 * math.pi)).r_squared == pytest.approx(
        plain.r_squared, abs=1e-4
    )
