"""Logs of 10 to 50 Hz: between two samples at a reversal, the torque's jump is not seen."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import small_arm

import jointid as jid

pytest.importorskip("pinocchio")


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize(("rate", "error"), [(50, 0.01), (20, 0.02), (10, 0.05)])
def test_friction_is_right_at_low_rates(tmp_path: Path, rate: int, error: float, seed: int) -> None:
    path = small_arm.urdf(tmp_path)
    run = small_arm.recording(path, duration=24.0, seed=seed)
    fields = run.fields()
    for name in run.signals:
        fields[name] = fields[name][:: 1000 // rate]
    noise = np.random.default_rng(seed).normal(0.0, 1e-5, fields["position"].shape)
    fields["position"] = fields["position"] + noise
    found = jid.identify_robot(jid.RobotRecording(**fields), jid.Robot.from_urdf(path))
    for number, joint in enumerate(found.joints.values()):
        values = joint.parameters
        assert values["coulomb"].value == pytest.approx(small_arm.COULOMB[number], rel=error)
        assert values["viscous"].value == pytest.approx(small_arm.VISCOUS[number], rel=error)
