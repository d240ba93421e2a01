"""Delays between signals, and motion that is too slow to be believed."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from example_recordings import WELL_EXCITED
from simulated_joint import TRUTH, simulate

import jointid as jid
from jointid import _core
from jointid.recording.shifting import shifted


def late(run: jid.Recording, signal: str, delay: float) -> jid.Recording:
    """The recording with a signal that is late by a part of a sample or more."""
    fields = {name: getattr(run, name) for name in run.signals}
    fields[signal] = np.interp(run.time - delay, run.time, fields[signal])
    return jid.Recording(**fields, torque_hold=run.torque_hold)


def identified(run: jid.Recording, **options: object) -> jid.Estimate:
    found: jid.Estimate = jid.identify(  # type: ignore[call-overload]
        run, jid.thesis_joint(), search="separable", **options
    )
    return found


@pytest.fixture(scope="module")
def run() -> jid.Recording:
    return simulate(1, duration=9.0, seed=5)[0]


@pytest.mark.parametrize(("signal", "delay"), [("torque", 0.0013), ("velocity", 0.0021)])
def test_a_late_signal_is_named_and_shifted_back(
    run: jid.Recording, signal: str, delay: float
) -> None:
    estimate = identified(late(run, signal, delay))
    found = estimate.delays[signal]
    assert found.certain
    assert found.applied == found.value == pytest.approx(delay, abs=2e-4)
    assert {name for name, each in estimate.delays.items() if each.applied} == {signal}
    for name, value in TRUTH.items():
        assert estimate.parameters[name].value == pytest.approx(value, rel=0.015), name
    assert "delay_removed" in {each.code for each in estimate.findings}
    assert "(removed)" in estimate.report(verbose=True)


def test_a_reading_late_before_the_controller_is_named() -> None:
    # Noise in the torque tells only what happens behind the point where the controller reads.
    run = jid.load(WELL_EXCITED)
    assert run.sensor is not None
    weight = np.hanning(13) / np.hanning(13).sum()
    smooth = np.convolve(run.sensor, weight, mode="same")
    lag = np.interp(run.time - 0.002, run.time, smooth) - smooth
    found = identified(run.with_signals(sensor=run.sensor + lag)).delays["sensor"]
    assert found.certain
    assert found.value == pytest.approx(0.002, abs=2.0 * found.stderr)


@pytest.mark.parametrize("early", [0.0007, 0.0025])
def test_an_early_torque_may_be_a_gear_that_gives_way(run: jid.Recording, early: float) -> None:
    estimate = identified(late(run, "torque", -early))
    assert estimate.delays["torque"].value == pytest.approx(-early, abs=3e-4)
    (said,) = (f for f in estimate.findings if f.title.startswith(("torque leads", "torque led")))
    assert "gear is elastic" in said.details or "the gear is elastic" in said.details


@pytest.mark.parametrize("model", [each.name for each in _core.models()])
@pytest.mark.parametrize("signal", ["torque", "sensor", "velocity"])
@pytest.mark.parametrize("more", ["", ":asymmetric"], ids=["", "asymmetric"])
def test_every_model_says_what_a_delay_costs(
    run: jid.Recording, model: str, signal: str, more: str
) -> None:
    short = late(run.crop(0.0, 6.0), signal, 0.003)
    estimate = identified(short, model=model + more, min_speed=0)
    parts = estimate.parameters["viscous" + ("_positive" if more else "")].systematic
    found = estimate.delays[signal]
    assert found.value == pytest.approx(0.003, abs=5e-4)
    # Of the torque only beside a friction that fits.
    fits = model not in ("coulomb_viscous", "smooth_coulomb_viscous")
    assert found.certain == (signal != "torque" or fits)
    assert parts.get("lag", 0.0) > 0.0 or not found.certain


def test_a_good_recording_is_not_shifted(run: jid.Recording) -> None:
    estimate = identified(run)
    assert set(estimate.delays) == {"torque", "sensor", "velocity"}
    assert not any(each.certain or each.applied for each in estimate.delays.values())
    assert estimate.settings["shift"] == {}
    assert estimate.settings["min_speed"] == 0.0


def test_a_shift_that_is_given_is_the_only_one(run: jid.Recording) -> None:
    slow = late(run, "torque", 0.002)
    left = identified(slow, shift={})
    assert left.settings["shift"] == {}
    (found,) = (each for each in left.findings if each.code == "signal_lag")
    (action,) = found.advice
    obeyed = identified(slow, **action.arguments)
    assert obeyed.settings["shift"]["torque"] == pytest.approx(0.002, abs=2e-4)
    assert "signal_lag" not in {each.code for each in obeyed.findings}
    predicted = obeyed.predict(slow)
    assert predicted.relative == pytest.approx(obeyed.residuals.relative, rel=1e-6)


def test_a_shift_that_is_wrong_is_told_with_what_it_leaves(run: jid.Recording) -> None:
    estimate = identified(run, shift={"torque": 0.003})
    found = estimate.delays["torque"]
    assert found.left == pytest.approx(-0.003, abs=1e-4)
    stated = f"+3.00 ms was removed as stated, {1e3 * found.left:.2f} ms remains"
    assert stated in estimate.report(verbose=True)
    gain = estimate.parameters["sensor_gain"]
    assert abs(gain.value - TRUTH["sensor_gain"]) < 2.0 * gain.systematic["lag"]
    (finding,) = (each for each in estimate.findings if each.code == "signal_lag")
    assert finding.evidence["lag"].value == found.left
    assert finding.title.startswith("torque leads the position by")
    assert "after a shift of 3 ms" in finding.title
    assert finding.advice[0].arguments["shift"] == {}
    assert [each.kind for each in finding.advice] == ["call", "inspect"]  # no option says that
    # Nothing else in the report says another thing of the torque.
    assert "delay" not in {each.code for each in estimate.findings}
    for cause in estimate.causes().found:
        assert cause.name != "delay" or cause.numbers["delay"].value == found.left


def test_a_torque_that_comes_before_its_motion_is_told_and_left(run: jid.Recording) -> None:
    estimate = identified(late(run, "torque", -0.002))
    assert estimate.delays["torque"].certain
    assert estimate.settings["shift"] == {}
    (finding,) = (each for each in estimate.findings if each.code == "signal_lag")
    assert "the position is late" in finding.cause
    assert {action.kind for action in finding.advice} == {"inspect"}


@pytest.mark.parametrize(
    ("shift", "reason"),
    [
        ({"position": 0.001}, "torque, sensor, velocity"),
        ({"torque": "soon"}, "in seconds"),
        ({"torque": 2.0}, "at most 1 s"),
        (0.001, "a mapping"),
        ({"current": 0.001}, "torque, sensor, velocity"),
    ],
)
def test_shifts_that_cannot_be(run: jid.Recording, shift: object, reason: str) -> None:
    with pytest.raises(jid.InputError, match=reason):
        identified(run, shift=shift)


@pytest.mark.parametrize("speed", [-0.1, "slow", float("nan"), True])
def test_speeds_that_cannot_be(run: jid.Recording, speed: object) -> None:
    with pytest.raises(jid.InputError, match="a speed of 0 or more"):
        identified(run, min_speed=speed)


@pytest.mark.parametrize("share", [0.9999, 50.0])
def test_a_speed_that_leaves_no_motion_is_named(run: jid.Recording, share: float) -> None:
    speed = share * float(np.abs(run.velocity).max())
    with pytest.raises(jid.InputError, match="too little motion above this speed") as error:
        identified(run, min_speed=speed)
    assert error.value.argument == "min_speed"
    assert error.value.value == speed


def test_a_held_signal_is_shifted_by_the_mean_of_its_intervals(run: jid.Recording) -> None:
    assert run.torque is not None
    back = shifted(run, {"torque": 0.0005})
    assert back.torque is not None
    assert len(back) == len(run) - 1
    assert np.allclose(back.torque, 0.5 * (run.torque[1:] + run.torque[:-1]))


def test_a_derived_velocity_has_no_delay_of_its_own(run: jid.Recording) -> None:
    derived = jid.Recording(time=run.time, position=run.position, torque=run.torque)
    assert "velocity" not in jid.identify(derived, search="separable").delays
    with pytest.raises(jid.InputError, match="derived from the position"):
        jid.identify(derived, shift={"velocity": 0.001})


def test_slow_motion_is_left_out_on_request(run: jid.Recording) -> None:
    estimate = identified(run, min_speed=0.2)
    assert estimate.settings["min_speed"] == 0.2
    assert estimate.residuals.left_out > identified(run).residuals.left_out + 0.02


def test_creep_that_contradicts_is_left_out(shared_data: Path) -> None:
    """KR300, joint 3: authors' nominal values 2024 N·m·s/rad and 294 N·m."""
    path = shared_data / "kr300" / "kr300_A.csv.gz"
    columns = {
        "position": "motor_encoder_pos_3_linkside_rad",
        "velocity": "motor_encoder_vel_3_linkside_rad_s",
        "motor_torque": "motor_torque_3_Nm",
    }
    joint = jid.Joint(gear_ratio=252.33, model=jid.Model("coulomb_viscous", gravity="free"))
    estimate = jid.identify(jid.load(path, columns=columns), joint, search="separable")
    assert estimate.parameters["viscous"].value == pytest.approx(2024.0, rel=0.1)
    assert estimate.parameters["coulomb"].value == pytest.approx(294.0, rel=0.1)
    slow = estimate.slow_motion
    assert slow is not None
    assert slow.applied
    assert slow.speed == estimate.settings["min_speed"] > 0.0
    again = jid.Estimate.from_json(estimate.to_json())
    assert again.slow_motion == slow
    assert again.delays == estimate.delays
    everything = jid.identify(
        jid.load(path, columns=columns), joint, search="separable", min_speed=0
    )
    assert everything.parameters["viscous"].value < 0.9 * 2024.0


def test_bits_do_not_depend_on_the_threads_of_blas() -> None:
    """A library that runs products of tall arrays on its own threads changes their last bits."""
    text = (
        "import json, sys, jointid as jid\n"
        "found = json.loads(jid.identify(jid.load(sys.argv[1])).to_json())\n"
        "found.pop('seconds')\n"
        "print(json.dumps(found))\n"
    )
    seen = {
        subprocess.run(
            [sys.executable, "-c", text, str(WELL_EXCITED)],
            env=os.environ | {"OPENBLAS_NUM_THREADS": count, "OMP_NUM_THREADS": count},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for count in ("1", "2")
    }
    assert len(seen) == 1
