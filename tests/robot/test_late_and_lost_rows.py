"""Rows that a busy host stamps late, rounds and loses: the even clock of the samples is found again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_arm
from shared_cases import case

import jointid as jid
from jointid.robot.motion.numbering import row_numbers
from jointid.robot.motion.stamps import on_even_clock

pytest.importorskip("pinocchio")

Array = np.ndarray[Any, np.dtype[np.float64]]
Numbers = np.ndarray[Any, np.dtype[np.intp]]
Flags = np.ndarray[Any, np.dtype[np.bool_]]
Damage = Callable[[np.random.Generator, int], tuple[Array, Flags]]

PERIOD = 1e-3  # [s]


def late_and_lost(rng: np.random.Generator, count: int) -> tuple[Array, Flags]:
    """Lateness of each stamp, and which rows are there."""
    return rng.exponential(0.2 * PERIOD, count), rng.uniform(size=count) > 0.06


def bursts_and_jitter(rng: np.random.Generator, count: int) -> tuple[Array, Flags]:
    """Up to 100 rows are lost at once; stamps are late or early."""
    kept = np.ones(count, dtype=bool)
    for start in rng.integers(0, count, 30):
        kept[start : start + rng.integers(1, 100)] = False
    return rng.normal(0.0, 0.15 * PERIOD, count), kept


def rounded_and_lost(rng: np.random.Generator, count: int) -> tuple[Array, Flags]:
    """Stamps are cut to tenths of a millisecond of a clock that runs faster by 30 ppm."""
    time = PERIOD * np.arange(count)
    seen = (1.0 + 3e-5) * time + rng.uniform(0.0, 0.5 * PERIOD, count)
    return np.floor(1e4 * seen) / 1e4 - time, rng.uniform(size=count) > 0.2


def stalled(rng: np.random.Generator, count: int) -> tuple[Array, Flags]:
    """The host sleeps for some periods and then stamps all rows that wait."""
    late = rng.exponential(0.1 * PERIOD, count)
    for start in rng.integers(0, count - 10, count // 200):
        length = int(rng.integers(2, 8))
        late[start : start + length] += PERIOD * np.arange(length, 0, -1)
    return late, rng.uniform(size=count) > 0.03


KINDS = [late_and_lost, bursts_and_jitter, rounded_and_lost, stalled]


def damaged(
    run: jid.RobotRecording, damage: Damage, seed: int, noise: float = 1e-6
) -> tuple[jid.RobotRecording, Numbers]:
    """A recording with wrong stamps and without some rows, and the numbers of those that are left."""
    rng = np.random.default_rng(seed)
    late, kept = damage(rng, run.samples)
    number = np.flatnonzero(kept)
    stamps = np.maximum.accumulate((run.time + late)[kept]) + 1e-9 * np.arange(number.size)
    fields = run.fields() | {"time": stamps}
    for name in set(run.signals) - {"time"}:
        fields[name] = fields[name][kept]
    fields["position"] = fields["position"] + rng.normal(0.0, noise, fields["position"].shape)
    return jid.RobotRecording(**fields), number


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return small_arm.urdf(tmp_path_factory.mktemp("arm"))


@pytest.fixture(name="run", scope="module")
def _run(path: Path) -> jid.RobotRecording:
    return small_arm.recording(path, duration=8.0)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("damage", KINDS)
def test_every_row_has_its_number(run: jid.RobotRecording, damage: Damage, seed: int) -> None:
    recording, number = damaged(run, damage, seed)
    found = row_numbers(recording.time, recording.position)
    assert found is not None
    apart = found - number
    assert np.mean(apart != np.median(apart)) < 1e-3
    assert np.ptp(apart) <= 2


def test_the_positions_say_where_a_row_was_lost(run: jid.RobotRecording) -> None:
    """A stamp that is late by a period, right before a lost row, looks like the lost row's."""
    recording, number = damaged(run, late_and_lost, 0)
    standing = row_numbers(recording.time, np.zeros_like(recording.position))
    found = row_numbers(recording.time, recording.position)
    assert standing is not None
    assert found is not None
    assert np.count_nonzero(np.diff(standing) != np.diff(number)) > 0
    np.testing.assert_array_equal(np.diff(found), np.diff(number))


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.slow)])
@pytest.mark.parametrize("inertia", ["urdf", "scaled", "free"])
@pytest.mark.parametrize("damage", KINDS)
def test_friction_is_right_in_each_mode(
    run: jid.RobotRecording, path: Path, damage: Damage, inertia: Any, seed: int
) -> None:
    recording, _ = damaged(run, damage, seed)
    found = jid.identify_robot(recording, jid.Robot.from_urdf(path), inertia=inertia)
    assert found.relative_residual < 0.02
    for number, joint in enumerate(found.joints.values()):
        values = joint.parameters
        assert values["coulomb"].value == pytest.approx(small_arm.COULOMB[number], rel=0.02)
        assert values["viscous"].value == pytest.approx(small_arm.VISCOUS[number], rel=0.02)


def test_an_even_recording_is_not_changed(run: jid.RobotRecording) -> None:
    assert on_even_clock(run) is run


@pytest.mark.parametrize("inertia", ["urdf", "scaled", "free"])
def test_the_case_is_right(inertia: Any) -> None:
    folder = case("robot-01-late-stamps-lost-samples")
    robot = jid.Robot.from_urdf(folder / "arm.urdf")
    found = jid.identify_robot(jid.load_robot(folder / "log.csv"), robot, inertia=inertia)
    assert found.relative_residual < 0.04
    truth = {"coulomb": (4.0, 5.0, 3.0, 1.2), "viscous": (6.0, 7.0, 3.5, 1.5)}
    for name, values in truth.items():
        for joint, value in zip(found.joints.values(), values, strict=True):
            assert joint.parameters[name].value == pytest.approx(value, rel=0.05)
