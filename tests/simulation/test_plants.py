"""The tests' simulator of mismatched joints against the core's, where both can say what happens."""

import math
from dataclasses import replace

import numpy as np
import pytest
from plants import Bench, Law, Log, Plant, simulate, sines, thesis

import jointid as jid

LAW = Law(inertia=2.5, stiffness=80.0, feedback=1.5, on_reference=1.0)
QUIET = Log(sensor_noise=0.0)
DURATION = 2.0
TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}
BRISTLE = {"stiffness": 1e5, "damping": 500.0}
ELASTIC = Plant(gear_stiffness=0.25 * (2.0 * math.pi * 40.0) ** 2, gear_damping=2.0)


@pytest.fixture(scope="module")
def runs() -> list[jid.Recording]:
    motion = thesis(np.radians([60.0]), cycle=3.0)
    plants = [
        Plant(),
        Plant(bristle_stiffness=BRISTLE["stiffness"], bristle_damping=BRISTLE["damping"]),
        ELASTIC,
        Plant(
            load_friction=0.1,
            harmonic_torque=0.5,
            bump=3.0,
            bump_time=1.0,
            coupling=1.0,
            pose_inertia=0.1,
        ),
    ]
    benches = [Bench(motion=motion, plant=plant, law=LAW, log=QUIET) for plant in plants]
    return simulate(Bench.stack(benches), duration=DURATION, finer=10)


def core(bristle: jid.Bristle | None) -> jid.Recording:
    plain = jid.thesis_joint()
    assert plain.link is not None
    link = replace(plain.link, angle=-math.pi / 2.0)
    law = jid.AdaptiveRobust(
        bandwidth=80.0, robust_term=False, inertia=2.5, coulomb=15.0, static=10.0,
        stribeck=150.0, viscous=10.0, sensor_gain=1.5, friction_velocity="reference",
    )  # fmt: skip
    return jid.simulate(
        plain.replace(link=link).with_parameters(TRUTH),
        law,
        jid.Trajectory.thesis(math.radians(60.0), cycle=3.0, duration=DURATION),
        integration_step=5e-5,
        bristle=bristle,
    )


@pytest.mark.parametrize("run", [0, 1])
def test_agrees_with_the_core(runs: list[jid.Recording], run: int) -> None:
    ours, theirs = runs[run], core(jid.Bristle(**BRISTLE) if run else None)
    count = min(len(ours), len(theirs))
    for signal, tolerance in (
        ("position", 1e-6),
        ("velocity", 1e-4),
        ("torque", 0.1),
        ("sensor", 0.1),
    ):
        mine, other = getattr(ours, signal)[:count], getattr(theirs, signal)[:count]
        assert np.abs(mine - other).max() < tolerance, signal
        assert np.sqrt(np.mean((mine - other) ** 2)) < 0.1 * tolerance, signal


def test_the_torque_balance_holds_with_all_mismatches(runs: list[jid.Recording]) -> None:
    run = runs[3]
    assert run.torque is not None
    assert run.sensor is not None
    plant = run.metadata["plant"]
    q, v, t = run.position, run.velocity, run.time
    link = plant["link_inertia"]
    sensed = 2.4 * run.sensor + 15.0
    slip = 25.0 + 0.1 * np.abs(sensed) + 20.0 * np.exp(-100.0 * v**2)
    modelled = slip * np.sign(v) + 20.0 * v + 0.5 * np.sin(3.0 * q) + sensed
    modelled += 3.0 * np.sin(math.pi * np.clip(t - 1.0, 0.0, 1.0)) + np.sin(5.3 * t + 0.7)
    # Integrals from a sample in motion to another; the link's part against its own equation.
    moving = (np.abs(v[:-1]) > 0.3) & (np.abs(v[1:]) > 0.3)
    step = np.diff(t)
    change = plant["inertia"] * np.diff(v)
    held = run.torque[:-1] * step
    balance = change + 0.5 * step * (modelled[:-1] + modelled[1:]) - held
    assert abs(balance[moving].sum()) < 2e-3 * np.abs(held[moving]).sum()
    weight = plant["gravity"] * np.sin(q)
    inertia = link + plant["pose_inertia"] * np.cos(2.0 * q)
    turning = weight - plant["pose_inertia"] * np.sin(2.0 * q) * v**2
    acceleration = np.gradient(v, t)
    error = (inertia * acceleration + turning - sensed)[moving.nonzero()[0]]
    assert np.sqrt(np.mean(error**2)) < 0.1


def test_an_elastic_gear_turns_the_link(runs: list[jid.Recording]) -> None:
    rigid, elastic = runs[0], runs[2]
    assert rigid.sensor is not None
    assert elastic.sensor is not None
    difference = 2.4 * (rigid.sensor - elastic.sensor)[500:]
    assert 0.01 < np.sqrt(np.mean(difference**2)) < 1.0


def test_delays_counts_and_stamps_are_as_told() -> None:
    motion = sines([[0.6, 0.3]], [[1.3, 2.9]])
    late = Log(sensor_noise=0.0, torque_delay=2e-3, sensor_delay=3e-3, velocity_delay=1e-3)
    coarse = Log(counts=5000.0, differenced=1.0, repeated=0.2, every=2)
    benches = [Bench(motion=motion, log=log) for log in (QUIET, late, coarse)]
    exact, shifted, rough = simulate(Bench.stack(benches), duration=2.0, finer=5)
    for signal, samples in (("torque", 2), ("sensor", 3), ("velocity", 1)):
        before, after = getattr(exact, signal), getattr(shifted, signal)
        np.testing.assert_array_equal(before[:-samples], after[samples:], err_msg=signal)
    counts = rough.position / (2.0 * math.pi / 5000.0)
    np.testing.assert_allclose(counts, np.rint(counts), atol=1e-6)
    assert rough.sample_period == pytest.approx(2e-3)
    assert rough.sensor is not None
    copies = np.mean(np.diff(rough.sensor) == 0.0)
    assert 0.15 < copies < 0.25
