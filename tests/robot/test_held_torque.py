"""A torque command that holds until the next sample is no signal that is straight between samples."""

from pathlib import Path

import numpy as np
import pytest
from small_arm import VISCOUS, recording, urdf

import jointid as jid

pytest.importorskip("pinocchio")


def test_a_held_torque_is_integrated_as_held(tmp_path: Path) -> None:
    """Of a slow controller: each command is what the arm needs in the middle of its time."""
    path = urdf(tmp_path)
    fine = recording(path)
    assert fine.torque is not None
    fields = {
        **fine.fields(),
        "time": fine.time[:-10:20],
        "position": fine.position[:-10:20],
        "torque": fine.torque[10::20],
    }

    def error(hold: str) -> float:
        told = jid.RobotRecording(**{**fields, "torque_hold": hold})
        found = jid.identify_robot(told, jid.Robot.from_urdf(path), model="coulomb_viscous")
        viscous = [joint.parameters["viscous"].value for joint in found.joints.values()]
        return float(np.abs(np.array(viscous) / VISCOUS - 1.0).max())

    right = error("zoh")
    assert right < 0.01
    assert error("linear") > 2.0 * right
