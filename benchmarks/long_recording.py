"""Identify a recording of this many samples in a process of its own; print times and memory as JSON.

    python benchmarks/long_recording.py SAMPLES REPEATS

A process of its own, because the peak of memory is kept for a process's whole life.
"""

import json
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from peers.contest import problem_of
from recordings import WELL_EXCITED

import jointid as jid
from jointid import _core
from jointid.identification.search.domain import domain_for

Array = NDArray[np.float64]
NOISE = 1e-3  # of a signal's spread, new for every copy
CANDIDATES = 10_000
GENERATIONS = 100


def long_recording(samples: int) -> jid.Recording:
    """Repeat `well_excited`, in continuous time and position, each copy with its own noise."""
    rng = np.random.default_rng(samples)
    one = jid.load(WELL_EXCITED)
    assert one.velocity is not None
    assert one.torque is not None
    assert one.sensor is not None
    step = float(one.time[1] - one.time[0])
    travel = float(one.position[-1] - one.position[0] + step * one.velocity[-1])
    copies = np.arange(samples) // one.time.size

    def tiled(values: Array, noise: float) -> Array:
        result = np.resize(values, samples)
        if noise > 0.0:
            result += rng.normal(0.0, noise * float(np.std(values)), samples)
        return result

    position = tiled(one.position, 0.0)
    position += travel * copies
    return jid.Recording(
        time=step * np.arange(samples),
        position=position,
        velocity=tiled(one.velocity, 0.0),
        torque=tiled(one.torque, 0.0),
        sensor=tiled(one.sensor, NOISE),
    )


def status(field: str) -> int:
    """Return VmRSS or VmHWM [bytes]."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(field + ":"):
            return int(line.split()[1]) * 1024
    raise LookupError(field)


def forget_peak() -> None:
    """Reset the peak, because a child starts with its parent's."""
    Path("/proc/self/clear_refs").write_text("5")


def search_speed(recording: jid.Recording, joint: jid.Joint) -> dict[str, float]:
    """Return seconds per candidate of the compressed penalty, and per individual of the genetic search with breeding.

    One thread, the least of several. The recording's length must make no difference.
    """
    problem, direct = problem_of(recording, joint, None)
    domain = domain_for(direct, joint, None, problem.peak_speed)
    form = _core.CompressedPenalty(direct, domain.lower, domain.upper)
    assert form.exact, form.reason
    rng = np.random.default_rng(2)
    share = rng.random((domain.lower.size, CANDIDATES))
    candidates = np.asfortranarray(
        domain.lower[:, None] + share * (domain.upper - domain.lower)[:, None]
    )
    options = _core.GaOptions.thesis().replace(population=200, generations=GENERATIONS)

    def least(call: Callable[[], object], count: int) -> float:
        seconds = []
        for _ in range(15):
            began = time.perf_counter()
            call()
            seconds.append(time.perf_counter() - began)
        return min(seconds) / count

    return {
        "candidate": least(lambda: form.evaluate(candidates, threads=1), CANDIDATES),
        "individual": least(
            lambda: _core.minimise_genetic(
                form, domain.lower, domain.upper, options=options, threads=1
            ),
            200 * (GENERATIONS + 1),
        ),
    }


def main(samples: int, repeats: int) -> None:
    """Run and print."""
    joint = jid.thesis_joint()
    jid.identify(long_recording(6000), joint)  # lazy imports
    before = status("VmRSS")
    recording = long_recording(samples)
    kinematic = (recording.time, recording.position, recording.velocity)
    held = (*kinematic, recording.torque, recording.sensor)
    arrays = sum(signal.nbytes for signal in held if signal is not None)
    forget_peak()
    seconds, windows, peak = [], 0, 0
    for _ in range(repeats):
        began = time.perf_counter()
        estimate = jid.identify(recording, joint)
        seconds.append(time.perf_counter() - began)
        windows = len(estimate.windows.residual)
        if len(seconds) == 1:  # later calls reuse the allocator's memory
            # getrusage's peak equals this one where it can be reset, which clear_refs does.
            peak = min(status("VmHWM"), 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    measured = {
        "samples": samples,
        "seconds": float(np.median(seconds)),
        "windows": windows,
        "arrays": arrays,
        "memory": peak - before,
        **search_speed(recording, joint),
    }
    print(json.dumps(measured))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
