"""A position that jumps makes every value doubtful; fast motion, copies and coarse steps are no jumps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from fake_evidence import evidence
from plain_joint import motion, recorded

import jointid as jid
from jointid.estimate.findings import Finding
from jointid.identification.warnings import registry
from jointid.identification.warnings.inspection import inspect


def jumps(run: jid.Recording) -> list[Finding]:
    check = registry.CHECKS[registry.FILES.index("spikes")]
    found = check.findings(evidence(recordings=(run,), inspections=(inspect(run),)))
    return [each for each in found if each.code == "jumps"]


def run_of(time: Any, position: Any, velocity: Any = None) -> jid.Recording:
    return jid.Recording(time=time, position=position, velocity=velocity, torque=np.sin(time))


@pytest.mark.parametrize("height", [0.3, -1.0, 2.5])
@pytest.mark.parametrize("velocity", [True, False])
def test_a_lost_index_blocks(height: float, velocity: bool) -> None:
    time, position, rate, _ = motion()
    moved = position + np.where(time > 5.0, height, 0.0)
    (found,) = jumps(run_of(time, moved, rate if velocity else None))
    assert found.severity == "blocking"
    assert found.evidence["height"].value == pytest.approx(height, abs=0.05)
    estimate = jid.identify(
        jid.Recording(time=time, position=moved, velocity=rate, torque=recorded().torque)
    )
    assert estimate.verdict.level == "not usable"
    assert estimate.findings[0].code == "jumps"


def test_lost_samples_with_even_stamps_are_a_jump() -> None:
    time, position, _, _ = motion(duration=16.0)
    fastest = int(np.argmax(np.abs(np.diff(position))))
    kept = np.r_[0 : fastest - 10, fastest + 10 : len(time)]
    assert jumps(run_of(time[: len(kept)], position[kept]))


def test_a_fast_move_that_the_velocity_shows_is_none() -> None:
    """One move in a single interval of a slow log that otherwise creeps."""
    time = np.arange(0.0, 60.0, 0.1)
    velocity = np.full(len(time), 0.01)
    velocity[300:302] = 5.0
    position = np.concatenate([[0.0], np.cumsum(0.05 * (velocity[1:] + velocity[:-1]))])
    moved = np.diff(position).max()
    assert moved > 30.0 * np.median(np.diff(position))
    assert not jumps(run_of(time, position, velocity))


@pytest.mark.parametrize("copies", [3, 20, 150])
def test_rows_that_repeat_are_none(copies: int) -> None:
    _, position, _, _ = motion(duration=60.0, period=0.05)
    held = np.repeat(position, copies)
    assert not jumps(run_of(np.arange(len(held)) * 0.05 / copies, held))


@pytest.mark.parametrize("steps", [200, 1000, 20_000])
def test_coarse_steps_are_none(steps: int) -> None:
    time, position, _, _ = motion()
    step = 2.0 * np.pi / steps
    assert not jumps(run_of(time, step * np.rint(position / step)))


@pytest.mark.parametrize("seed", range(4))
def test_clean_motion_of_any_rate_has_none(seed: int) -> None:
    for period in (0.001, 0.01, 0.05, 0.1):
        time, position, rate, _ = motion(20.0, period, seed=seed)
        assert not jumps(run_of(time, position))
        assert not jumps(run_of(time, position, rate))


def test_a_report_says_what_may_follow_from_a_blocking_finding() -> None:
    time, position, rate, _ = motion()
    moved = position + np.where(time > 5.0, 1.0, 0.0)
    run = jid.Recording(time=time, position=moved, velocity=rate, torque=recorded().torque)
    estimate = jid.identify(run, model="stribeck")
    lines = estimate.report().splitlines()
    first = next(number for number, line in enumerate(lines) if line.startswith("blocking"))
    others = sum(found.severity == "warning" for found in estimate.findings)
    assert others
    assert any(line.startswith(f"{others} more may follow from") for line in lines[first:])
    assert "may follow" not in jid.identify(recorded()).report()
