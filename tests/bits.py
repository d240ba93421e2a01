"""Digests of estimates, simulations and sessions: same inputs, same bits, whatever is rearranged.

Run as a program it prints the table that `tests/bits.json` holds. Values are hexadecimal floats, arrays the
first half of the SHA-256 of their bytes.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from closed_loop import TRUTH, thesis_joint
from session_bench import HashedBus, devices, session

import jointid as jid

EXAMPLES = Path(__file__).resolve().parent.parent / "examples" / "data"


def _digest(*arrays: Any) -> str:
    found = hashlib.sha256()
    for array in arrays:
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()[:32]


def _of_estimate(estimate: jid.Estimate) -> dict[str, str]:
    table = {name: p.value.hex() for name, p in estimate.parameters.items()}
    table["penalty"] = estimate.penalty.hex()
    table["windows"] = _digest(estimate.windows.measured, estimate.windows.fitted)
    table["status"] = estimate.status
    if estimate.convergence is not None:
        c = estimate.convergence
        table["search"] = _digest(c.best, c.mean, c.diversity, c.evaluations)
    return table


def _of_recording(recording: jid.Recording) -> dict[str, str]:
    return {name: _digest(getattr(recording, name)) for name in recording.signals}


def _kuka() -> tuple[jid.Recording, jid.Joint]:
    return (
        jid.load(EXAMPLES / "kr300_joint1.csv.gz"),
        jid.Joint.load(EXAMPLES / "kr300_joint1.toml"),
    )


def _kuka_at_the_motor() -> jid.Recording:
    log = _kuka()[0]
    return jid.Recording(time=log.time, position=log.position, torque=log.motor_torque)


def _thesis() -> jid.Recording:
    return jid.load(EXAMPLES / "well_excited.csv.gz")


def _identify(recordings: Any, joint: jid.Joint | None = None, **options: Any) -> dict[str, str]:
    return _of_estimate(jid.identify(recordings, joint, **options))


def _simulated(**options: Any) -> jid.SimulatedRecording:
    joint = thesis_joint().with_parameters(TRUTH)
    law = jid.AdaptiveRobust(**jid.control_estimates(joint))
    motion = jid.Trajectory.thesis(1.0, cycle=3.0, duration=3.0)
    sensors = jid.Sensors(torque_noise=0.5, encoder_counts=8000)
    return jid.simulate(joint, law, motion, sensors=sensors, seed=7, **options)


def _sweep() -> dict[str, str]:
    small = jid.GaOptions(population=10, generations=5)
    grid = {"windows": [100, 200]}
    study = jid.sweep(
        _thesis(), jid.thesis_joint(), grid=grid, trials=2, search=jid.Search(ga=small)
    )
    return {
        f"{row.cell} {row.trial} {name}": value.hex()
        for row in study.rows
        for name, value in row.values.items()
    }


def _comparison() -> dict[str, str]:
    found = jid.compare_models(*_kuka(), models=("coulomb_viscous", "stribeck:asymmetric"))
    return {row.model: row.score.hex() for row in found.rows} | {"winner": found.winner}


def _session() -> dict[str, str]:
    bus = HashedBus(*devices(seed=3))
    recording = session(bus, 1.0).run()
    bus.shutdown()
    assert recording is not None
    return _of_recording(recording) | {"frames": bus.hash.digest(), "count": str(bus.hash.frames)}


def _online() -> dict[str, str]:
    recording = _thesis()
    signals = ("time", "position", "velocity", "torque", "sensor")
    with jid.OnlineIdentifier(jid.thesis_joint(), window=6.0) as identifier:
        identifier.feed(**{name: getattr(recording, name)[:6000] for name in signals})
        found = identifier.wait(60.0)
    assert found is not None
    return {name: p.value.hex() for name, p in found.parameters.items()}


def _halves(recording: jid.Recording) -> list[jid.Recording]:
    middle = float(recording.time[len(recording) // 2])
    return [recording.crop(stop=middle), recording.crop(start=middle)]


CASES: dict[str, Callable[[], dict[str, str]]] = {
    "thesis joint": lambda: _identify(_thesis(), jid.thesis_joint()),
    "thesis joint, genetic": lambda: _identify(
        _thesis(), jid.thesis_joint(), search=jid.Search("ga", seed=1)
    ),
    "thesis joint, torque": lambda: _identify(_thesis(), jid.thesis_joint(), residual="torque"),
    "thesis joint, two shapes": lambda: _identify(
        _thesis(), jid.thesis_joint(), model="stribeck_general"
    ),
    "thesis joint, random": lambda: _identify(
        _thesis(),
        jid.thesis_joint(),
        search=jid.Search("random", ga=jid.GaOptions(population=20, generations=10), seed=3),
    ),
    "thesis joint, thesis preset": lambda: _identify(
        _thesis(),
        jid.thesis_joint(),
        search=jid.Search(ga=jid.GaOptions.thesis().replace(population=20, generations=30)),
    ),
    "thesis joint, ripple": lambda: _identify(
        _thesis(), jid.thesis_joint(), model=jid.Model(ripple=(2, 4))
    ),
    "thesis joint, cumulative": lambda: _identify(
        _thesis(), jid.thesis_joint(), windows="cumulative"
    ),
    "thesis joint, two recordings": lambda: _identify(
        _halves(_thesis()),
        jid.thesis_joint(),
        model=jid.Model(per_recording=("sensor_offset",)),
        search=jid.Search(threads=2),
    ),
    "kuka": lambda: _identify(*_kuka()),
    "kuka, asymmetric": lambda: _identify(
        _kuka()[0], _kuka()[1].replace(torque_offset=False), model=jid.Model(asymmetric=True)
    ),
    "kuka, stribeck": lambda: _identify(*_kuka(), model="stribeck"),
    "kuka, load friction and harmonics": lambda: _identify(
        *_kuka(), model=jid.Model(harmonics=(2, 3), load_friction=True)
    ),
    "kuka, no joint": lambda: _identify(_kuka_at_the_motor()),
    "comparison": _comparison,
    "sweep": _sweep,
    "online": _online,
    "simulation": lambda: _of_recording(_simulated()),
    "simulation, bristles": lambda: _of_recording(
        _simulated(bristle=jid.Bristle(stiffness=1e5, damping=300.0))
    ),
    "session": _session,
}


def table() -> Iterator[tuple[str, dict[str, str]]]:
    """Every case and its digests."""
    for name, case in CASES.items():
        yield name, case()


if __name__ == "__main__":
    print(json.dumps(dict(table()), indent=1))  # noqa: T201
