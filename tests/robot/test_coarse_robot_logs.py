"""A robot's log of few samples a second: what a reversal blurs is left out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import small_arm

import jointid as jid

pytest.importorskip("pinocchio")


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("every", [40, 50])
def test_friction_of_a_coarse_log_is_right(tmp_path: Path, every: int, seed: int) -> None:
    path = small_arm.urdf(tmp_path)
    run = small_arm.recording(path, duration=40.0, seed=seed)
    coarse = jid.RobotRecording(
        time=run.time[::every],
        position=run.position[::every],
        torque=np.asarray(run.torque)[::every],
        names=run.names,
    )
    found = jid.identify(coarse, jid.Robot.from_urdf(path))
    joints = zip(found.joints.values(), small_arm.COULOMB, small_arm.VISCOUS, strict=True)
    for joint, coulomb, viscous in joints:
        assert joint.parameters["coulomb"].value == pytest.approx(coulomb, rel=0.02)
        assert joint.parameters["viscous"].value == pytest.approx(viscous, rel=0.02)
