"""A limit is reached again and again at the same value: neither by one sample nor by a step that was commanded."""

from __future__ import annotations

import numpy as np
import pytest
from defects import changed
from fake_evidence import evidence
from numpy.typing import NDArray
from plain_joint import recorded

import jointid as jid
from jointid.identification.warnings import registry
from jointid.identification.warnings.inspection import inspect

Array = NDArray[np.float64]
RUNS = [recorded(name=f"run_{seed}", seed=seed) for seed in range(3)]
SHORT = [recorded(name=f"short_{seed}", seed=seed, duration=6.0, period=0.06) for seed in range(3)]


def saturated(runs: list[jid.Recording]) -> list[str]:
    """The recordings whose torque is said to rest on a limit."""
    given = evidence(recordings=tuple(runs), inspections=tuple(inspect(run) for run in runs))
    check = registry.CHECKS[registry.FILES.index("clipped")]
    return [
        name
        for found in check.findings(given)
        for name in (found.recordings or [run.name for run in runs])
    ]


def cut(run: jid.Recording, limit: float) -> jid.Recording:
    return changed(run, torque=np.clip(np.array(run.torque), -limit, limit))


def with_torque(run: jid.Recording, torque: Array) -> jid.Recording:
    return changed(run, torque=torque)


def with_one_kick(run: jid.Recording) -> jid.Recording:
    torque = np.array(run.torque)
    torque[10] = 1.3 * np.abs(torque).max()
    return with_torque(run, torque)


@pytest.mark.parametrize("run", SHORT, ids=lambda run: run.name)
def test_one_sample_of_a_short_log_is_no_limit(run: jid.Recording) -> None:
    assert saturated([with_one_kick(run)]) == []


def test_single_samples_of_several_runs_are_no_limits() -> None:
    assert saturated([with_one_kick(run) for run in SHORT]) == []


def test_a_commanded_step_is_no_limit() -> None:
    steps = []
    for run, volts in zip(RUNS, (7.0, -7.0, 7.0), strict=True):
        torque = np.full(len(run), volts)
        torque[:40] = np.linspace(0.0, volts, 40)
        steps.append(with_torque(run, torque))
    assert saturated(steps) == []
    assert saturated(steps[:1]) == []


def test_a_ramp_that_is_held_once_is_no_limit() -> None:
    torque = np.minimum(np.linspace(0.0, 12.0, len(RUNS[0])), 9.0)
    assert saturated([with_torque(RUNS[0], torque)]) == []


def test_smooth_peaks_of_equal_height_are_no_limit() -> None:
    time = np.arange(0.0, 12.0, 0.05)
    torque = 5.0 * np.cos(2.0 * np.pi * time) + 3.0
    run = jid.Recording(time=time, position=np.sin(2.0 * np.pi * time), torque=torque)
    assert saturated([run]) == []


def test_a_torque_that_is_cut_off_again_and_again_rests_on_its_limit() -> None:
    assert saturated([cut(RUNS[0], 5.0)]) == ["run_0"]


def test_several_runs_rest_on_one_limit_and_one_that_goes_beyond_shows_that_it_is_none() -> None:
    assert saturated([cut(run, 5.0) for run in RUNS]) == ["run_0", "run_1", "run_2"]
    gentler = recorded(name="gentle", amplitude=0.2)
    assert saturated([cut(RUNS[0], 5.0), gentler]) == ["run_0"]
    assert saturated([cut(RUNS[0], 5.0), RUNS[1]]) == []


@pytest.mark.parametrize(("low", "high"), [(-2.0, np.inf), (-np.inf, 3.0)])
def test_the_limit_is_the_one_that_is_rested_on(low: float, high: float) -> None:
    run = with_torque(RUNS[0], np.clip(np.array(RUNS[0].torque), low, high))
    check = registry.CHECKS[registry.FILES.index("clipped")]
    (found,) = check.findings(evidence(recordings=(run,), inspections=(inspect(run),)))
    assert found.evidence["limit"].value == pytest.approx(low if np.isfinite(low) else high)


def test_a_magnitude_does_not_rest_on_zero() -> None:
    less = np.maximum(np.abs(np.array(RUNS[0].torque)) - 2.0, 0.0)
    assert saturated([with_torque(RUNS[0], less)]) == []
