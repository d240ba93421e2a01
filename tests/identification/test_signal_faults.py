"""Faults of signals that are named for what they are: coarse velocity, no motion, wrong stamps, one wild sample."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from example_recordings import WELL_EXCITED
from hypothesis import given
from hypothesis import strategies as st
from simulated_joint import INERTIA, LINK_INERTIA, TRUTH, simulate

import jointid as jid
from jointid.recording import motion
from jointid.recording.motion import small_motion


@pytest.fixture(scope="module")
def well() -> jid.Recording:
    return jid.load(WELL_EXCITED)


def seen(run: jid.Recording, counts: int) -> jid.Recording:
    """The same run with a coarse encoder, and no velocity."""
    step = 2.0 * np.pi / counts
    return jid.Recording(
        time=run.time,
        position=np.floor(run.position / step) * step,
        torque=run.torque,
        sensor=run.sensor,
        torque_hold=run.torque_hold,
    )


def codes(estimate: jid.Estimate) -> set[str]:
    return {finding.code for finding in estimate.warnings}


def test_a_coarse_encoder_costs_little_and_what_it_costs_is_named() -> None:
    runs = simulate(2, duration=12.0, seed=5)
    for run in runs:
        estimate = jid.identify(seen(run, 100_000), jid.thesis_joint(), search="separable")
        assert estimate.parameters["static"].value == pytest.approx(TRUTH["static"], rel=0.05)
        coarse = jid.identify(seen(run, 20_000), jid.thesis_joint(), search="separable")
        named = {name for finding in coarse.warnings for name in finding.parameters}
        (finding,) = [each for each in coarse.findings if each.code == "noisy_velocity"]
        assert "static.moved" in finding.evidence
        for name, true in TRUTH.items():
            value = coarse.parameters[name].value
            assert name in named or value == pytest.approx(true, rel=0.05), name


def test_a_fine_encoder_has_no_such_finding(well: jid.Recording) -> None:
    assert "noisy_velocity" not in codes(jid.identify(well, jid.thesis_joint(), search="separable"))


def test_leaving_a_noisy_velocity_out_helps(shared_data: Path) -> None:
    # A pendulum of 0.676 kg at 0.45 m: 2.98 N·m, 0.137 kg·m².
    path = shared_data / "ak80" / "ak80_swing_up.csv"
    before = jid.identify(
        jid.load(path), model=jid.Model.parse("coulomb_viscous:gravity=free"), search="separable"
    )
    finding = next(each for each in before.findings if each.code == "noisy_velocity")
    (call,) = [action for action in finding.advice if action.kind == "call"]
    after = jid.identify(
        jid.load(path, **dict(call.arguments)),
        model=jid.Model.parse("coulomb_viscous:gravity=free"),
        search="separable",
    )
    assert before.parameters["gravity_sin"].value < 2.0
    assert after.parameters["gravity_sin"].value == pytest.approx(2.98, rel=0.05)
    assert after.parameters["inertia"].value == pytest.approx(0.137, rel=0.2)


def hardly_moving(rate: float, step: float) -> jid.Recording:
    time = np.arange(0.0, 6.0, 1e-3)
    position = np.round(1e-3 * np.sin(rate * time) / step) * step
    noise = np.random.default_rng(1).normal(0.0, 0.5, time.size)
    torque = 25.0 * np.sign(np.cos(rate * time)) + noise
    return jid.Recording(time=time, position=position, torque=torque)


def test_a_joint_that_hardly_moves_is_named_and_nothing_else() -> None:
    estimate = jid.identify(hardly_moving(20.0, 1e-4))
    assert codes(estimate) == {"hardly_moves"}
    (finding,) = estimate.warnings
    assert finding.severity == "blocking"
    assert finding.evidence["steps"].value == pytest.approx(20.0)
    assert "0.0001 rad" in finding.cause


def test_a_joint_that_hardly_moves_and_shows_nothing_is_refused_for_that() -> None:
    with pytest.raises(
        jid.InputError, match=r"hardly moves: only by 0\.0018 rad, 6 encoder counts"
    ):
        jid.identify(hardly_moving(2.0, 3e-4))


def standing(noise: float) -> jid.Recording:
    generator = np.random.default_rng(1)
    time = np.arange(0.0, 6.0, 1e-3)
    position = 0.5 + noise * generator.normal(size=time.size)
    return jid.Recording(time=time, position=position, torque=generator.normal(size=time.size))


def test_a_joint_that_moves_by_its_noise_alone_stands_still() -> None:
    estimate = jid.identify(standing(1e-5))
    assert codes(estimate) == {"hardly_moves"}
    (finding,) = estimate.warnings
    assert finding.severity == "blocking"
    assert "the joint stands still" in finding.cause
    assert finding.evidence["noise"].value == pytest.approx(1e-5, rel=0.05)


@pytest.mark.parametrize("samples", [2.0, 3.0, 4.0, 5.0, 7.3, 40.0])
def test_a_motion_of_few_samples_a_period_is_no_noise(samples: float) -> None:
    time = np.arange(0.0, 6.0, 1e-3)
    position = np.sin(2.0 * np.pi * time / (samples * 1e-3) + 0.3)
    recording = jid.Recording(time=time, position=position, torque=position)
    found = small_motion(recording)
    assert found is None or not found.noise


@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from(["alternating", "noise", "bursts", "steps"]),
    st.floats(1e-6, 1.0),
)
def test_a_motion_far_beyond_what_neighbours_differ_by_is_no_noise(
    seed: int, kind: str, drift: float
) -> None:
    # The short cut of small_motion: with it the noise is not looked at.
    generator = np.random.default_rng(seed)
    count = int(generator.integers(300, 4000))
    changes = {
        "alternating": np.where(np.arange(count) % 2, 1.0, -1.0),
        "noise": generator.uniform(-1.0, 1.0, count),
        "bursts": generator.choice([-1.0, 0.0, 1.0], count, p=[0.1, 0.8, 0.1]),
        "steps": generator.choice([-1.0, 1.0], count),
    }[kind] + drift
    position = np.cumsum(changes)
    travel, largest = float(np.ptp(position)), float(np.abs(changes[1:]).max())
    recording = jid.Recording(time=np.arange(count) * 1e-3, position=position, torque=position)
    if travel >= 2.0 * motion._WIDEST * largest:
        assert motion._noise_alone(recording, travel) == 0.0


@pytest.mark.parametrize(("factor", "unit"), [(1e9, "nanoseconds"), (1e6, "microseconds")])
def test_stamps_in_another_unit_are_told(well: jid.Recording, factor: float, unit: str) -> None:
    wrong = jid.Recording(time=well.time * factor, position=well.position, torque=well.torque)
    with pytest.raises(jid.InputError, match=unit):
        jid.identify(wrong)


def test_stamps_in_milliseconds_are_told(well: jid.Recording) -> None:
    wrong = jid.Recording(time=well.time * 1e3, position=well.position, torque=well.torque)
    estimate = jid.identify(wrong, search="separable")
    finding = next(each for each in estimate.findings if each.code == "implausible_units")
    assert "milliseconds" in finding.cause
    assert dict(finding.advice[0].arguments) == {"units": {"time": "ms"}}


@pytest.mark.parametrize("recorded", [False, True])
def test_counts_of_an_encoder_are_told(well: jid.Recording, recorded: bool) -> None:
    turn = 4096 / (2.0 * np.pi)
    counts = np.rint(well.position * turn)
    velocity = well.velocity * turn if recorded else None
    wrong = jid.Recording(time=well.time, position=counts, velocity=velocity, torque=well.torque)
    estimate = jid.identify(wrong, model="coulomb_viscous", search="separable")
    finding = next(each for each in estimate.findings if each.code == "implausible_units")
    assert "may also be encoder counts" in finding.cause
    scaled = ("position", "velocity") if recorded else ("position",)
    advised = [dict(each.arguments) for each in finding.advice]
    assert {"scale": dict.fromkeys(scaled, ...)} in advised


def test_one_wild_sample_is_told_as_one(well: jid.Recording) -> None:
    assert well.torque is not None
    torque = well.torque.copy()
    torque[777] = 1e300
    wrong = jid.Recording(time=well.time, position=well.position, torque=torque)
    with pytest.raises(
        jid.InputError, match=r"1 sample\(s\) have this size, the first at 0\.777 s"
    ):
        jid.identify(wrong)


@cache
def compensated(seed: int) -> jid.Recording:
    """A clean sensorless run whose controller compensates friction by the sign of the velocity: it chatters."""
    rng = np.random.default_rng(seed)
    (run,) = simulate(1, duration=6.0, seed=seed)
    assert run.torque is not None
    torque = run.torque + 40.0 * (rng.random(len(run)) < 0.3) * np.sign(run.velocity) * (
        np.abs(run.velocity) < 0.02
    )
    return jid.Recording(time=run.time, position=run.position, velocity=run.velocity, torque=torque)


JOINT = jid.Joint(
    inertia=INERTIA + LINK_INERTIA, sensor=False, model=jid.Model("stribeck", gravity="free")
)


@pytest.mark.parametrize("seed", range(3))
def test_steps_of_the_torque_at_reversals_are_no_spikes(seed: int) -> None:
    assert "spikes" not in codes(jid.identify(compensated(seed), JOINT, search="separable"))


@pytest.mark.parametrize("height", [150.0, 300.0, 1000.0])
@pytest.mark.parametrize("seed", range(2))
def test_real_spikes_are_found(height: float, seed: int) -> None:
    run = compensated(seed)
    assert run.torque is not None
    fast = np.flatnonzero(np.abs(run.velocity) > 0.3)
    torque = run.torque.copy()
    torque[fast[len(fast) // 2]] += height
    hit = jid.Recording(time=run.time, position=run.position, velocity=run.velocity, torque=torque)
    finding = next(
        each
        for each in jid.identify(hit, JOINT, search="separable").findings
        if each.code == "spikes"
    )
    assert finding.evidence["height"].value == pytest.approx(height, rel=0.2)


def test_a_spike_beyond_the_range_is_found_at_a_reversal_too() -> None:
    run = compensated(0)
    assert run.torque is not None
    turn = int(np.flatnonzero(np.diff(np.sign(run.velocity)))[5])
    torque = run.torque.copy()
    torque[turn] += 1000.0
    hit = jid.Recording(time=run.time, position=run.position, velocity=run.velocity, torque=torque)
    assert "spikes" in codes(jid.identify(hit, JOINT, search="separable"))


def test_a_value_on_its_bound_is_not_said_to_be_moved_by_noise() -> None:
    rng = np.random.default_rng(3)
    time = np.arange(8000) * 1e-3
    position = 0.8 * np.sin(2.0 * time) + 0.3 * np.sin(5.3 * time)
    velocity = 1.6 * np.cos(2.0 * time) + 1.59 * np.cos(5.3 * time)
    acceleration = -3.2 * np.sin(2.0 * time) - 8.427 * np.sin(5.3 * time)
    # A balance that wants a negative inertia.
    torque = 3.0 * np.sign(velocity) + 2.0 * velocity - 0.1 * acceleration
    noisy = velocity + rng.normal(0.0, 0.4, time.size)
    recording = jid.Recording(time=time, position=position, velocity=noisy, torque=torque)
    estimate = jid.identify(recording, jid.Joint(model=jid.Model.parse("coulomb_viscous")))
    assert estimate.parameters["inertia"].at_bound == "min"
    (finding,) = [each for each in estimate.findings if each.code == "noisy_velocity"]
    assert "inertia by" not in finding.message
    assert "inertia.moved" not in finding.evidence
