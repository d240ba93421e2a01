"""Recordings fed to an on-line identifier block by block."""

from collections.abc import Iterator

import numpy as np

import jointid as jid

SIGNALS = ("time", "position", "velocity", "torque", "sensor", "motor_torque")


def blocks(recording: jid.Recording, size: int) -> Iterator[dict[str, np.ndarray]]:
    signals = {
        name: getattr(recording, name)
        for name in SIGNALS
        if getattr(recording, name) is not None
        and not (name == "velocity" and recording.velocity_derived)
    }
    for begin in range(0, len(recording), size):
        yield {name: values[begin : begin + size] for name, values in signals.items()}


def fed(
    identifier: jid.OnlineIdentifier, recording: jid.Recording, size: int = 250
) -> jid.OnlineEstimate:
    for block in blocks(recording, size):
        identifier.feed(**block)
        identifier.wait(30.0)
    found = identifier.estimate
    assert found is not None
    return found


def shifted(recording: jid.Recording, by: float, torque: np.ndarray | None = None) -> jid.Recording:
    return jid.Recording(
        time=recording.time + by,
        position=recording.position,
        velocity=recording.velocity,
        torque=recording.torque if torque is None else torque,
        sensor=recording.sensor,
    )
