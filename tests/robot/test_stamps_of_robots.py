"""A host's stamps are late by chance: the samples were even, and the positions say so."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_arm import URDF, Sensors, random_arm, random_motion, recorded, run

import jointid as jid
from jointid.robot.motion.stamps import on_even_clock

pytest.importorskip("pinocchio")


@pytest.mark.parametrize("lateness", [1e-4, pytest.param(3e-4, marks=pytest.mark.slow)])
def test_stamps_of_a_busy_host(lateness: float) -> None:
    ran = run(random_arm(2, stribeck=False), random_motion(2, duration=5.0))
    recording = recorded(ran, Sensors(stamp_lateness=lateness), 2)
    clock = on_even_clock(recording).time
    assert np.ptp(np.diff(clock)) < 1e-9
    assert np.all(clock <= recording.time + 1e-9)
    found = jid.identify_robot(recording, jid.Robot.from_urdf(URDF), model="coulomb_viscous")
    for joint, source in zip(found.joints.values(), ran.arm.sources, strict=True):
        assert joint.parameters["coulomb"].value == pytest.approx(source.coulomb, rel=0.03)
        assert joint.parameters["viscous"].value == pytest.approx(source.viscous, rel=0.03)


def test_samples_that_were_uneven_keep_their_stamps() -> None:
    time = np.arange(4000) * 1e-3 + np.random.default_rng(0).uniform(-3e-4, 3e-4, 4000)
    position = np.column_stack([np.sin(2.0 * time), np.cos(3.0 * time)])
    recording = jid.RobotRecording(time=time, position=position, torque=position)
    assert on_even_clock(recording) is recording


def test_lost_samples_leave_jumps_of_whole_periods() -> None:
    number = np.delete(np.arange(4000), np.s_[1500:1800])
    late = number * 1e-3 + np.random.default_rng(0).exponential(1e-4, number.size)
    position = np.column_stack([np.sin(2e-3 * number), np.cos(3e-3 * number)])
    recording = jid.RobotRecording(time=np.maximum.accumulate(late), position=position)
    clock = on_even_clock(recording).time
    period = np.diff(clock).min()
    assert period == pytest.approx(1e-3, rel=1e-4)
    np.testing.assert_array_equal(np.rint(np.diff(clock) / period), np.diff(number))


def test_a_clock_that_wanders_keeps_its_stamps() -> None:
    rng = np.random.default_rng(0)
    kept = rng.uniform(size=4000) > 0.05
    time = np.cumsum(rng.uniform(0.5e-3, 1.5e-3, 4000))
    position = np.column_stack([np.sin(2.0 * time), np.cos(3.0 * time)])
    recording = jid.RobotRecording(time=time[kept], position=position[kept])
    assert on_even_clock(recording) is recording
