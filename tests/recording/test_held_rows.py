"""Rows that a logger repeats because it is faster than the drive's bus."""

from pathlib import Path

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.recording.corrections import mended
from jointid.recording.held_rows import without_copies


def host_logged(well: jid.Recording, seed: int = 1) -> jid.Recording:
    """Logged every millisecond by a busy host from a bus that has a new sample every 1.3 ms."""
    rng = np.random.default_rng(seed)
    host = well.time + rng.uniform(0.0, 2e-4, len(well))
    bus = np.arange(0.0, float(well.time[-1]), 1.3e-3)
    taken = bus[np.clip(np.searchsorted(bus, host, side="right") - 1, 0, None)]
    assert well.torque is not None
    assert well.sensor is not None
    return jid.Recording(
        time=host,
        **{
            name: np.interp(taken, well.time, getattr(well, name))
            for name in ("position", "velocity", "torque", "sensor")
        },
    )


@pytest.fixture(scope="module")
def logged() -> jid.Recording:
    return host_logged(jid.load(WELL_EXCITED).crop(1.0))


def worst(estimate: jid.Estimate) -> float:
    truth = {"coulomb": 25.0, "viscous": 20.0, "sensor_gain": 2.4}
    return max(abs(estimate.parameters[name].value / true - 1.0) for name, true in truth.items())


def test_copies_are_left_out_and_the_samples_get_the_clock_of_the_bus(
    logged: jid.Recording,
) -> None:
    estimate = jid.identify(logged, jid.thesis_joint(), search="separable")
    codes = {each.code for each in estimate.findings}
    assert "held_rows" in codes
    assert not codes & {"repeated_samples", "time_jitter"}
    assert worst(estimate) < 0.005


def test_loading_without_copies_leaves_as_many(logged: jid.Recording, tmp_path: Path) -> None:
    logged.save(tmp_path / "logged.csv")
    dropped = jid.load(tmp_path / "logged.csv", drop_copies=True)
    assert len(dropped) == pytest.approx(
        len(mended(logged)[0]), rel=0.01
    )  # a standstill is thinned


def test_a_standstill_and_the_impulse_of_a_held_torque_stay() -> None:
    time = np.arange(100) * 1e-3
    position = np.concatenate([np.zeros(40), np.cumsum(np.linspace(1e-4, 0.02, 60))])
    for copied in (60, 70, 80):
        position[copied] = position[copied - 1]
    torque = np.random.default_rng(0).normal(0.0, 1.0, 100)
    made = without_copies(
        {"time": time, "position": position, "torque": torque, "torque_hold": "zoh"}
    )
    assert len(made["time"]) == 97
    whole = np.sum(torque[:-1] * np.diff(time))
    assert np.sum(made["torque"][:-1] * np.diff(made["time"])) == pytest.approx(whole)


def test_a_coarse_encoder_has_no_copies() -> None:
    time = np.arange(2000) * 1e-3
    with pytest.raises(jid.InputError, match="slow motion"):
        without_copies({"time": time, "position": np.round(np.sin(time), 3)})


def test_nothing_is_advised_that_would_harm() -> None:
    # Samples are lost, so that no even clock fits, and the stamps are all there is.
    well = jid.load(WELL_EXCITED)
    kept = np.random.default_rng(3).random(len(well)) > 0.1
    lossy = host_logged(
        jid.Recording(
            **{
                name: getattr(well, name)[kept]
                for name in ("time", "position", "velocity", "torque", "sensor")
            }
        )
    )
    gone = np.random.default_rng(4).random(len(lossy)) > 0.2
    logged = jid.Recording(
        **{
            name: getattr(lossy, name)[gone]
            for name in ("time", "position", "velocity", "torque", "sensor")
        }
    )
    findings = jid.identify(logged, jid.thesis_joint(), search="separable").findings
    for finding in findings:
        if finding.code in ("repeated_samples", "time_jitter"):
            assert all(action.kind == "record" for action in finding.advice)
            assert "evenly" not in finding.cause
