"""One measurement in a program of its own: `python timed.py RECORDING INERTIA REPEATS` prints times and peak memory."""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import numpy as np

import jointid as jid
from jointid.robot.links.inertia_modes import Inertia

URDF = Path(__file__).resolve().parents[2] / "tests" / "simulated_arm" / "seven_joints.urdf"


def reference(recording: jid.RobotRecording) -> float:
    """Return processor seconds of a plain Python loop: the four regressors of a sample's balance, by pinocchio."""
    import pinocchio

    model = pinocchio.buildModelFromUrdf(str(URDF))
    state, rest = model.createData(), np.zeros(model.nv)
    velocity = np.gradient(recording.position, recording.time, axis=0)
    began = time.process_time()
    total = np.zeros((model.nv, 10 * model.nv))
    for q, v in zip(recording.position, velocity, strict=True):
        gravity = pinocchio.computeJointTorqueRegressor(model, state, q, rest, rest).copy()
        total += pinocchio.computeJointTorqueRegressor(model, state, q, rest, v) - gravity
        total += pinocchio.computeJointTorqueRegressor(model, state, q, v, rest) - gravity
        ahead = q + 1e-4 * v
        total += pinocchio.computeJointTorqueRegressor(model, state, ahead, rest, v)
    return time.process_time() - began


def memory(field: str) -> float:
    """Return VmRSS or VmHWM [MB], because the peak of getrusage starts at the parent's."""
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith(f"{field}:"):
            return int(line.split()[1]) / 1024.0
    raise OSError(f"/proc/self/status has no {field}")


def recorded_bytes(recording: jid.RobotRecording) -> int:
    """Return the size of the signals in bytes."""
    every = [getattr(recording, name) for name in recording.signals]
    return sum(each.nbytes for each in every)


def main(path: str, inertia: Inertia, repeats: int) -> None:
    """Measure and print as JSON."""
    recording = jid.load_robot(path)
    robot = jid.Robot.from_urdf(URDF)
    before, arrays = memory("VmRSS"), recorded_bytes(recording) / 2.0**20
    seconds, busy = [], []
    for _ in range(repeats):
        began, begun = time.perf_counter(), time.process_time()
        jid.identify_robot(recording, robot, inertia=inertia)
        seconds.append(time.perf_counter() - began)
        busy.append(time.process_time() - begun)
    after = memory("VmHWM")
    loop = reference(recording.crop(0.0, 20.0))
    found = {"before": before, "arrays": arrays, "peak": after, "reference": loop}
    print(json.dumps({"seconds": seconds, "busy": busy, **found}))


if __name__ == "__main__":
    main(sys.argv[1], "free" if sys.argv[2] == "free" else "urdf", int(sys.argv[3]))
