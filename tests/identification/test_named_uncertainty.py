"""What a misfit makes uncertain is named, and noise is no misfit."""

from __future__ import annotations

import numpy as np
import pytest
from plants import Bench, Law, Log, Plant, simulate, thesis

import jointid as jid
from jointid.estimate.delays import Delay
from jointid.identification.causes.causes import _prompt
from jointid.identification.causes.families import BY_NAME
from jointid.identification.causes.residual_test import correlated, suspicious
from jointid.identification.warnings.inspection import inspect
from jointid.identification.warnings.spikes import _without_kicks

_LAW = Law(inertia=2.5, stiffness=40.0, feedback=1.5, on_reference=1.0)
_CASES = {
    "noise": (Plant(), Log(sensor_noise=4.0)),
    "silence": (Plant(), Log(sensor_noise=0.0)),
    "ripple": (Plant(), Log(ripple=2.6)),
    "bristles": (Plant(bristle_stiffness=1e5, bristle_damping=300.0), Log()),
}


@pytest.fixture(scope="module")
def estimates() -> dict[str, jid.Estimate]:
    """One joint, and what goes wrong."""
    motion = thesis(np.radians([60.0]))
    benches = [Bench(motion=motion, law=_LAW, plant=p, log=log) for p, log in _CASES.values()]
    runs = simulate(Bench.stack(benches), duration=9.0, seed=3, finer=3)
    joint = jid.thesis_joint()
    return {
        name: jid.identify(run, joint, search="separable")
        for name, run in zip(_CASES, runs, strict=True)
    }


def _wide(estimate: jid.Estimate) -> set[str]:
    return {
        name
        for name, p in estimate.parameters.items()
        if p.interval is not None and p.interval[1] - p.interval[0] > 0.09 * abs(p.value)
    }


def test_noise_alone_is_no_misfit(estimates: dict[str, jid.Estimate]) -> None:
    noisy = estimates["noise"]
    assert 0.05 < noisy.residuals.r_squared < 0.95
    assert not {"poor_fit", "structured_residual"} & {found.code for found in noisy.findings}


def test_structure_that_moves_nothing_is_worth_knowing_only(
    estimates: dict[str, jid.Estimate],
) -> None:
    silent = estimates["silence"]
    assert _wide(silent) - {"sensor_offset"} == set()
    assert silent.residuals.autocorrelation > 0.2
    assert [found.code for found in silent.findings if found.severity != "info"] == []


@pytest.mark.parametrize("name", ["ripple", "bristles"])
def test_a_misfit_names_all_friction_at_low_speed(
    estimates: dict[str, jid.Estimate], name: str
) -> None:
    first = next(found for found in estimates[name].findings if found.code in BY_NAME)
    assert {"static", "stribeck"} <= set(first.parameters)
    assert _wide(estimates[name]) - {"sensor_offset"} <= set(first.parameters)


def test_noise_that_is_louder_at_low_speed_is_not_correlated() -> None:
    rng = np.random.default_rng(2)
    speed = np.abs(np.sin(np.linspace(0.0, 40.0, 1200)))
    residual = rng.normal(size=1200) * np.where(speed < 0.15, 10.0, 1.0)
    run, duration = np.zeros(1200, dtype=np.int64), np.ones(1200)
    assert suspicious(residual, run, duration, speed)
    assert not correlated(residual, run)
    assert correlated(residual + 3.0 * np.sin(np.linspace(0.0, 60.0, 1200)), run)


def test_a_delay_within_its_error_is_none() -> None:
    def delay(value: float, applied: float = 0.0) -> Delay:
        return Delay(
            signal="sensor", value=value, stderr=1e-4, certain=False, fits=False, applied=applied
        )

    assert _prompt({"sensor": delay(1e-4)}) == {"sensor"}
    assert _prompt({"sensor": delay(1e-3, applied=1e-3)}) == {"sensor"}
    assert not _prompt({"sensor": delay(3e-4)})
    assert not _prompt({})


@pytest.mark.parametrize(("place", "count"), [(2000, 0), (1000, 1)])
def test_a_kick_with_a_jump_of_the_velocity_is_no_spike(place: int, count: int) -> None:
    time = np.arange(5000) * 1e-3
    velocity = 0.8 * np.cos(2.0 * time)
    velocity[2000:] -= 0.2
    position = np.concatenate([[0.0], np.cumsum(velocity[1:] + velocity[:-1])]) * 0.5e-3
    sensor = np.sin(2.0 * time) + np.random.default_rng(0).normal(0.0, 0.01, 5000)
    sensor[place] += 8.0
    recording = jid.Recording(
        time=time,
        position=position,
        velocity=velocity,
        torque=20.0 * np.sign(velocity),
        sensor=sensor,
    )
    assert inspect(recording).spike("sensor").count == 1
    assert _without_kicks(inspect(recording)).count == count
