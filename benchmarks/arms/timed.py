"""One measurement in a program of its own: `python timed.py RECORDING INERTIA REPEATS` prints times and peak memory."""

from __future__ import annotations

import json
import resource
import sys
import time
from pathlib import Path

import numpy as np

import jointid as jid

URDF = Path(__file__).resolve().parents[2] / "tests" / "simulated_arm" / "seven_joints.urdf"


def reference(recording: jid.RobotRecording) -> float:
    """Seconds of a plain Python loop: the four regressors that a sample's balance needs, by pinocchio."""
    import pinocchio

    model = pinocchio.buildModelFromUrdf(str(URDF))
    state, rest = model.createData(), np.zeros(model.nv)
    velocity = np.gradient(recording.position, recording.time, axis=0)
    began = time.perf_counter()
    total = np.zeros((model.nv, 10 * model.nv))
    for q, v in zip(recording.position, velocity, strict=True):
        gravity = pinocchio.computeJointTorqueRegressor(model, state, q, rest, rest).copy()
        total += pinocchio.computeJointTorqueRegressor(model, state, q, rest, v) - gravity
        total += pinocchio.computeJointTorqueRegressor(model, state, q, v, rest) - gravity
        ahead = q + 1e-4 * v
        total += pinocchio.computeJointTorqueRegressor(model, state, ahead, rest, v)
    return time.perf_counter() - began


def peak() -> float:
    """Largest memory of this program so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def main(path: str, inertia: str, repeats: int) -> None:
    """Measure and print as JSON."""
    recording = jid.load_robot(path)
    robot = jid.Robot.from_urdf(URDF)
    before = peak()
    seconds = []
    for _ in range(repeats):
        began = time.perf_counter()
        jid.identify_robot(recording, robot, inertia=inertia)
        seconds.append(time.perf_counter() - began)
    after = peak()
    loop = reference(recording.crop(0.0, 20.0))
    print(json.dumps({"seconds": seconds, "before": before, "peak": after, "reference": loop}))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]))
