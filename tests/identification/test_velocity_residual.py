"""A coarse position measured once more: what its steps do to values, errors and causes."""

from __future__ import annotations

import numpy as np
import pytest
from plants import Bench, Law, Log, Plant, simulate, thesis

import jointid as jid
from jointid.balance.covariance import parameter_covariance
from jointid.balance.segments import even_segments
from jointid.estimate.causes import Cause
from jointid.identification.inference.velocity_noise import measured_again
from jointid.identification.inference.velocity_residual import beyond_velocity_noise
from jointid.identification.prepared import Prepared, prepare

_COUNTS = 202e3


@pytest.fixture(scope="module")
def coarse() -> tuple[jid.Recording, jid.Recording]:
    """Joints with a coarse encoder and no recorded velocity: sound, and with presliding."""
    benches = [
        Bench(
            motion=thesis(np.radians([60.0])),
            law=Law(inertia=2.5, stiffness=60.0, on_reference=1.0, coulomb=20.0, feedback=1.5),
            plant=Plant(**changes),
            log=Log(counts=_COUNTS, velocity=0.0),
        )
        for changes in ({}, {"bristle_stiffness": 2e4, "bristle_damping": 200.0})
    ]
    sound, bristles = simulate(Bench.stack(benches), duration=9.0, seed=5, finer=3)
    return sound, bristles


def _prepared(recording: jid.Recording) -> tuple[Prepared, jid.Estimate]:
    joint = jid.Joint(inertia=2.5, sensor=True, model=jid.Model("stribeck"), torque_hold="zoh")
    estimate = jid.identify(recording, joint, search="separable")
    return prepare((recording,), joint), estimate


def test_a_joint_at_rest_is_measured_at_rest_again() -> None:
    time = np.arange(4000) * 1e-3
    step = 2.0 * np.pi / _COUNTS
    swing = 0.5 * (1.0 - np.cos(2.0 * np.pi * np.clip(time - 2.0, 0.0, None)))
    run = jid.Recording(time=time, position=np.round(swing / step) * step, torque=swing)
    assert run.derived.refined
    again = [measured_again(run, draw, 0).velocity for draw in range(4)]
    for velocity in again:
        # White noise as large as a step would move it.
        assert np.abs(velocity[100:1800]).max() < 1e-9
        assert (
            0.0 < np.abs(velocity - run.velocity)[2100:].max() < 0.05 * np.abs(run.velocity).max()
        )
    assert not np.array_equal(again[0], again[1])


def test_opposed_neighbours_do_not_widen_the_errors() -> None:
    rng = np.random.default_rng(1)
    rows = 2000
    edge = rng.normal(size=rows + 1)
    residual = np.diff(edge)  # what one window has, the next one lacks
    jacobian = np.column_stack([np.ones(rows), np.sin(np.arange(rows) / 200.0)])
    square = np.linalg.inv(jacobian.T @ jacobian)
    found = parameter_covariance(jacobian, residual, None, segments=even_segments(rows))
    assert not found.white
    classical = np.sqrt(np.diag(square) * (residual @ residual) / (rows - 2))
    assert (found.stderr / classical).max() < 0.6


def test_what_the_noise_imitates_is_not_named(coarse: tuple[jid.Recording, jid.Recording]) -> None:
    prepared, estimate = _prepared(coarse[0])
    names = prepared.domain.names
    best = np.array([estimate.parameters[name].value for name in names])
    free = [names.index(name) for name in estimate.free]
    scale = 4.0 * float(prepared.penalty.window_duration)
    tried = [Cause(name=name, share=0.2, scale=scale) for name in ("presliding", "gravity")]
    left = beyond_velocity_noise(prepared.problem, prepared.penalty, best, free, tried)
    assert [each.name for each in left] == ["gravity"]


def test_what_is_more_than_the_noise_is_named(coarse: tuple[jid.Recording, jid.Recording]) -> None:
    slow = {"slow_motion", "smooth_friction", "presliding", "stribeck_exponent"}
    sound, bristles = (
        {found.code for found in _prepared(run)[1].warnings} & slow for run in coarse
    )
    assert not sound
    assert bristles
