"""A self-test injects known truth into the recorded motion, and names what does not come back."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.identification.self_test.injection import Injection
from jointid.identification.self_test.signal_noise import SignalNoise

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "data"
TIME = np.arange(0.0, 12.0, 0.002)


def recording(
    *,
    size: float = 1.0,
    counts: int | None = None,
    noise: float = 0.2,
    sensor: bool = False,
    **kept: Any,
) -> jid.Recording:
    """A joint with Stribeck friction on a multisine; its link, about the horizontal, loads a sensor if there is one."""
    rng = np.random.default_rng(5)
    rate = 2.0 * np.pi * np.array([0.15, 0.35, 0.6])
    share = size * np.array([0.4, 0.2, 0.1])
    angle = np.outer(TIME, rate)
    position, velocity = np.sin(angle) @ share, np.cos(angle) @ (share * rate)
    acceleration = -np.sin(angle) @ (share * rate**2)
    torque = 1.5 * acceleration + 6.0 * velocity
    torque += (8.0 + 5.0 * np.exp(-60.0 * velocity**2)) * np.sign(velocity)
    signals: dict[str, Any] = {}
    if sensor:
        link = 0.3 * acceleration + 25.0 * np.cos(position + 1.0)
        torque += link
        signals["sensor"] = (link - 4.0) / 2.0 + rng.normal(0.0, noise, TIME.size)
    if counts is not None:
        step = 2.0 * np.pi / counts
        position = np.round(position / step) * step
    else:
        signals["velocity"] = velocity
    torque += rng.normal(0.0, noise, TIME.size)
    return jid.Recording(time=TIME, position=position, torque=torque, **signals, **kept)


@pytest.fixture(scope="module")
def home() -> jid.Estimate:
    return jid.identify(jid.load(EXAMPLES / "well_excited.csv.gz"), jid.thesis_joint())


def test_what_a_good_log_determines_comes_back(home: jid.Estimate) -> None:
    test = home.selftest()
    assert test.passed
    assert set(test.parameters) == set(home.free)
    assert max(abs(row.error / row.truth) for row in test.rows) < 0.02
    first = {row.parameter: row.truth for row in test.rows if row.trial == 0}
    assert first == {name: home.parameters[name].value for name in home.free}
    drawn = [row for row in test.rows if row.trial > 0]
    assert all(row.truth != first[row.parameter] for row in drawn)
    for row in drawn:
        interval = home.parameters[row.parameter].interval
        assert interval is not None
        assert interval[0] <= row.truth <= interval[1]


@pytest.mark.parametrize(
    ("log", "lost"),
    [
        ({"sensor": True, "size": 0.12}, {"static"}),
        ({"counts": 1000}, {"static"}),
    ],
)
def test_what_a_log_does_not_determine_is_named(log: dict[str, Any], lost: set[str]) -> None:
    name = "stribeck:gravity=none"
    assert (
        jid.identify(recording(sensor="sensor" in log), model=jid.Model.parse(name))
        .selftest()
        .passed
    )
    test = jid.identify(
        recording(**log), model=jid.Model.parse(name), search="separable"
    ).selftest()
    assert lost <= set(test.lost)
    assert not test.passed
    assert all(name in test.verdict for name in lost)


def test_the_same_bits_for_a_seed_and_any_number_of_threads(home: jid.Estimate) -> None:
    loaded = recording()
    tests = [
        jid.identify(loaded, search=jid.Search("separable", threads=threads)).selftest(seed=seed)
        for threads, seed in ((1, 3), (2, 3), (1, 4))
    ]
    assert tests[0].rows == tests[1].rows
    assert tests[0].rows != tests[2].rows


@pytest.mark.parametrize("hold", ["zoh", "linear"])
@pytest.mark.parametrize(
    "model", ["stribeck:gravity=free", "stribeck:asymmetric", "coulomb_viscous:harmonics=2,3"]
)
def test_the_injected_torque_is_that_of_the_model(model: str, hold: str) -> None:
    """Without noise the injected truth is a minimum without any misfit, whatever the truth is."""
    estimate = jid.identify(
        recording(torque_hold=hold), model=jid.Model.parse(model), search="separable"
    )
    source: Any = estimate.follow_up
    theta = np.array([estimate.parameters[name].value for name in source.domain.names])
    quiet = replace(
        estimate.windows,
        measured=np.zeros(len(estimate.windows.start)),
        fitted=np.zeros(len(estimate.windows.start)),
    )
    injection = Injection(
        source.problem, source.windows, source.domain.names, theta, quiet, np.random.default_rng(0)
    )
    truth = 1.1 * theta
    made = replace(source.problem, recordings=injection.recordings(truth, np.random.default_rng(1)))
    table = made.table(made.penalty(source.windows), truth)
    missed = float(np.sqrt(np.mean(table.residual**2) / np.mean(table.measured**2)))
    # Between linear samples a reversal's step of friction is a ramp, in a recording too.
    assert missed < (1e-5 if hold == "zoh" else 5e-3)


def test_several_recordings_with_their_own_offsets() -> None:
    halves = recording().split(2)
    estimate = jid.identify(
        halves,
        model=jid.Model.parse("stribeck:gravity=none:per_recording=torque_offset"),
        search="separable",
    )
    test = estimate.selftest(trials=2)
    assert {"torque_offset[0]", "torque_offset[1]"} <= set(test.parameters)
    assert "coulomb" not in test.lost


def test_noise_and_quantum_of_a_signal() -> None:
    rng = np.random.default_rng(0)
    smooth = np.sin(3.0 * TIME)
    assert SignalNoise.of(smooth).white < 1e-6
    noisy = smooth + rng.normal(0.0, 0.01, TIME.size)
    noise = SignalNoise.of(noisy)
    assert noise.quantum == 0.0
    assert noise.white == pytest.approx(0.01, rel=0.1)
    left = noise.removed(noisy) - smooth
    assert np.std(left) < 0.5 * 0.01
    coarse = np.round(smooth / 0.003) * 0.003
    assert SignalNoise.of(coarse).quantum == pytest.approx(0.003, rel=1e-6)
    again = SignalNoise.of(coarse).added(smooth, rng)
    assert np.std(again - smooth) == pytest.approx(0.003 / np.sqrt(12.0), rel=0.1)


def test_the_result_as_text_page_and_json(home: jid.Estimate) -> None:
    test = home.selftest(trials=1, seed=2)
    assert "trial 1: the estimate itself" in test.report()
    assert test.verdict in test.report()
    assert test._repr_html_().count("<tr ") == 1 + len(test.rows)
    document = json.loads(test.to_json())
    assert document["passed"] is True
    assert document["rows"][0]["parameter"] == test.rows[0].parameter


def test_it_needs_the_recordings(home: jid.Estimate) -> None:
    with pytest.raises(jid.InputError, match="read from a file"):
        jid.Estimate.from_json(home.to_json()).selftest()
    for wrong in ({"trials": 0}, {"trials": 1.5}, {"seed": -1}):
        with pytest.raises(jid.InputError):
            home.selftest(**wrong)
