"""Time and memory of a call, each recording in a program of its own."""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from measured import Part

import jointid as jid
from arms.seven import Sensors, recorded, simulated

PART = Part(
    title="Robots: time and memory",
    asked="How much time and memory does a call need? Each recording is identified in a new process. The loop for "
    "comparison is written in Python. This loop calls four regressors of pinocchio for each sample of a recording of "
    "20 s.",
    header=(
        "recording",
        "`inertia`",
        "elapsed time [s]",
        "CPU time [s]",
        "CPU time / time of the loop",
        "memory of the signals",
        "peak memory",
    ),
)
_PERIOD = 10.0  # of the motion [s]


def tables(seed: int, repeats: int, hour: bool) -> Iterator[list[str]]:
    """Publish figures for 20 s, and for an hour of the same motion again and again."""
    ((_, ran),) = simulated([seed])
    short = recorded(ran, Sensors(), seed)
    cases = [("20 s", short, inertia, repeats) for inertia in ("urdf", "scaled", "free")]
    if hour:
        cases.append(("1 hour", lengthened(short, 360), "free", 1))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.npz"
        for name, recording, inertia, times in cases:
            recording.save(path)
            found = timed(path, inertia, times)
            seconds, loop = found["seconds"], found["reference"][0]
            busy = statistics.median(found["busy"])
            yield [
                name,
                inertia,
                f"{statistics.median(seconds):.2f}",
                f"{busy:.2f}",
                f"{busy / loop:.2f}",
                f"{found['arrays'][0]:.0f} MB",
                f"{found['peak'][0]:.0f} MB",
            ]


def timed(path: Path, inertia: str, repeats: int) -> dict[str, list[float]]:
    """Return the output of the other program; single numbers as lists of one."""
    command = [sys.executable, str(Path(__file__).with_name("timed.py")), str(path), inertia]
    done = subprocess.run([*command, str(repeats)], capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    return {name: value if isinstance(value, list) else [value] for name, value in found.items()}


def lengthened(recording: jid.RobotRecording, periods: int) -> jid.RobotRecording:
    """Repeat one period of the motion, without the velocities."""
    part = recording.crop(5.0, 5.0 + _PERIOD - 1e-4)
    assert part.torque is not None
    starts = np.repeat(np.arange(periods) * _PERIOD, part.samples)
    return jid.RobotRecording(
        time=np.tile(part.time, periods) + starts,
        position=np.tile(part.position, (periods, 1)),
        torque=np.tile(part.torque, (periods, 1)),
        names=part.names,
        torque_hold=part.torque_hold,
    )
