"""An emulated bench for the tests of sessions: the thesis's joint, its drive and converter, a motion."""

import hashlib
import json
import math
from typing import Any

import can
import numpy as np
from closed_loop import TRUTH, thesis_joint

import jointid as jid
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_converter import EmulatedConverter
from jointid.hardware.elmo.emulated_drive import EmulatedElmo
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.session import Session, SessionOptions
from jointid.simulation.stepped import stepped_joint

JOINT = thesis_joint()
TRUE = JOINT.with_parameters(TRUTH)
PERIOD = 2e-3


def law() -> jid.AdaptiveRobust:
    """The adaptive robust controller, believing the truth."""
    return jid.AdaptiveRobust(**jid.control_estimates(TRUE)).replace(friction_velocity="reference")


def motion(duration: float = 1.0, *, amplitude: float = 20.0) -> jid.Trajectory:
    """A smooth swing [s], [°]."""
    return jid.Trajectory.thesis(math.radians(amplitude), cycle=duration, duration=duration)


def joint(period: float = PERIOD, seed: int = 0) -> Any:
    """To be moved by a drive."""
    return stepped_joint(TRUE, sensors=jid.Sensors(torque_noise=0.5), period=period, seed=seed)


def devices(period: float = PERIOD, seed: int = 0) -> tuple[EmulatedElmo, EmulatedConverter]:
    """A drive with its joint, and the converter."""
    drive = EmulatedElmo(joint(period, seed))
    return drive, EmulatedConverter(drive)


def limits(**changes: Any) -> SessionLimits:
    """The joint's own."""
    return SessionLimits.of(JOINT, **changes)


def session(bus: can.BusABC, duration: float = 1.0, period: float = PERIOD, **more: Any) -> Session:
    """A session on a bus."""
    within = more.pop("limits", limits())
    wired = more.pop("drive", None)
    follow = more.pop("law", law())
    timeout = more.pop("answer_timeout", None)
    options = SessionOptions(period=period, settle=0.05, answer_timeout=timeout)
    return Session(
        ElmoDrive(bus, JOINT, wired), follow, motion(duration), within, options=options, **more
    )


class EchoingBus(EmulatedBus):
    """Gives the host its own frames back, as udp_multicast does."""

    receive_own_messages = True

    def _to_devices(self, message: can.Message) -> None:
        super()._to_devices(message)
        self._to_host(message)


class FrameHash:
    """Of all frames on a bus, both ways, with the times of the host's clock."""

    def __init__(self) -> None:
        self._hash = hashlib.sha256()
        self.frames = 0

    def __call__(self, when: float, identifier: int, payload: bytes, sent: bool) -> None:
        self.frames += 1
        self._hash.update(f"{when!r} {identifier:03X} {payload.hex()} {sent}\n".encode())

    def digest(self) -> str:
        """In hexadecimal digits."""
        return self._hash.hexdigest()


class HashedBus(EmulatedBus):
    """An emulated bus that keeps a hash of its frames, as the wire brings them."""

    def __init__(self, *args: Any, **more: Any) -> None:
        self.hash = FrameHash()
        super().__init__(*args, **more)

    def _to_devices(self, message: can.Message) -> None:
        self.hash(self.now(), message.arbitration_id, bytes(message.data), True)
        super()._to_devices(message)

    def _to_host(self, message: can.Message) -> None:
        self.hash(self.now(), message.arbitration_id, bytes(message.data), False)
        super()._to_host(message)


def recording_hash(recording: jid.Recording) -> str:
    """Of all signals' bits and the metadata."""
    found = hashlib.sha256()
    for name in ("time", "position", "torque", "sensor", "reference", "current"):
        found.update(name.encode() + np.ascontiguousarray(getattr(recording, name)).tobytes())
    found.update(json.dumps(recording.metadata, sort_keys=True, default=dict).encode())
    return found.hexdigest()


def hashes_of_a_session(duration: float = 1.0, seed: int = 3) -> tuple[str, str, int]:
    """Of the frames and the recording of one session on the virtual clock, and how many frames."""
    bus = HashedBus(*devices(seed=seed))
    recording = session(bus, duration).run()
    bus.shutdown()
    assert recording is not None
    return bus.hash.digest(), recording_hash(recording), bus.hash.frames


if __name__ == "__main__":
    print(*hashes_of_a_session())  # noqa: T201
