"""The second look agrees on clean logs, contradicts values that our own handling spoilt, and says when it is none."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from analytic_motion import TRUE, two_sines

import jointid as jid
from jointid.identification import prepared
from jointid.recording.recording import Recording


def unmended(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if nothing were put right: the second look has to see it."""
    monkeypatch.setattr(prepared, "mended", lambda run: (run, ()))


def test_it_agrees_on_a_clean_log_with_the_right_values() -> None:
    estimate = jid.identify(two_sines())
    check = estimate.cross_check
    assert check is not None
    assert check.disagrees is False
    for name, true in TRUE.items():
        assert check.values[name].value == pytest.approx(true, rel=0.02)
        assert check.values[name].stderr < 0.02 * true
    assert "plain least squares agrees" in estimate.report(verbose=True)


def in_a_turn(run: Recording) -> Recording:
    return run.with_signals(position=run.position % (2 * math.pi))


@pytest.mark.parametrize("spoil", [in_a_turn, lambda run: in_a_turn(run).with_velocity()])
def test_it_contradicts_a_wrapped_angle_that_nobody_unwraps(
    spoil: Callable[[Recording], Recording], monkeypatch: pytest.MonkeyPatch
) -> None:
    unmended(monkeypatch)
    estimate = jid.identify(spoil(two_sines(wide=4.0)))
    assert estimate.cross_check is not None
    assert {"coulomb", "viscous"} <= set(estimate.cross_check.contradicted)
    assert estimate.verdict.level == "not usable"
    finding = next(each for each in estimate.findings if each.code == "cross_check")
    assert "coulomb" in finding.message


def test_it_knows_a_fixed_value_and_a_sensor() -> None:
    run = two_sines()
    assert run.torque is not None
    load = 2.0 * np.sin(run.position)
    noise = 0.02 * np.random.default_rng(1).standard_normal(len(run))
    sensed = run.with_signals(torque=run.torque + load, sensor=(load - 0.7 + noise) / 2.5)
    joint = jid.Joint(inertia=0.5, sensor=True, model=jid.Model("coulomb_viscous"))
    check = jid.identify(sensed, joint).cross_check
    assert check is not None
    assert check.disagrees is False
    assert "inertia" not in check.values
    assert check.values["sensor_gain"].value == pytest.approx(2.5, rel=0.02)
    assert check.values["sensor_offset"].value == pytest.approx(0.7, abs=0.05)
    assert check.values["viscous"].value == pytest.approx(1.2, rel=0.03)


def test_what_it_cannot_check_it_says() -> None:
    run = two_sines()
    short = jid.identify(run[0.0:0.4]).cross_check
    assert short is not None
    assert short.disagrees is None
    assert "too little steady motion" in short.reason
    loaded = jid.identify(
        run, model=jid.Model("coulomb_viscous", load_friction="drive")
    ).cross_check
    assert loaded is not None
    assert "load_friction" in loaded.reason


def test_it_survives_json() -> None:
    estimate = jid.identify(two_sines())
    assert jid.Estimate.from_json(estimate.to_json()).cross_check == estimate.cross_check
