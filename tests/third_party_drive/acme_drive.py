"""A drive of a maker unknown to jointid: request and reply on a line, positions in counts, measured velocity."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Protocol

from jointid import InputError, Joint
from jointid.hardware import (
    Bench,
    BusOptions,
    Clock,
    DriveEnd,
    DriveFaultError,
    DriveSample,
    DriveType,
    LoggedCycle,
    LoggedFrame,
    Table,
    Watchdog,
    emulated_joint,
)

STATE, TORQUE, POWER = 0x10, 0x20, 0x30  # requests; the identifier of a reply is one higher
_STATE_REPLY = struct.Struct("<if?")  # counts, velocity [rad/s], whether the motor is on
_WATCHDOG = 0.05  # [s] without a torque, after which the drive stops by itself


@dataclass(frozen=True, kw_only=True)
class AcmeOptions:
    """The keys of `[session.drive]`; `largest_torque` at the output [N·m], `counts` of an output turn."""

    port: str = "/dev/ttyACM0"
    counts: int = 500_000
    largest_torque: float = 150.0

    def __post_init__(self) -> None:
        if self.counts < 1:
            raise InputError("at least 1 is expected", argument="counts", value=self.counts)


class Line(Protocol):
    """Carries a request to the drive and returns its reply; None: no reply."""

    clock: Clock

    def request(self, identifier: int, payload: bytes) -> bytes | None: ...


class AcmeDrive:
    """A drive at the end of a line."""

    command_latency = 0.0
    watchdog = Watchdog(time=_WATCHDOG, fed_by="command", then="off", read_back=False)

    def __init__(self, line: Line, joint: Joint, options: AcmeOptions) -> None:
        self.joint, self.options, self._line = joint, options, line
        self.clock = line.clock
        self.resolution = 2.0 * math.pi / options.counts
        self.tap: Callable[[float, int, bytes, bool], object] | None = None

    def connect(self, period: float) -> None:
        del period  # it is watched from the first torque on
        self._ask(POWER, b"\x00")

    def problems(self, torque_limit: float) -> list[str]:
        if self.options.largest_torque > torque_limit:
            return [f"the drive gives {self.options.largest_torque:g} N·m, more than allowed"]
        return []

    def enable(self) -> None:
        self._ask(POWER, b"\x01")
        self.command(0.0)  # whatever was commanded before

    def read(self, timeout: float) -> DriveSample:
        del timeout  # this line replies at once or never
        counts, speed, _ = _STATE_REPLY.unpack(self._ask(STATE, b""))
        time, position = self.clock.now(), counts * self.resolution
        return DriveSample(time=time, position=position, velocity=speed)

    def command(self, torque: float) -> float:
        largest = self.options.largest_torque
        reply = self._ask(TORQUE, struct.pack("<f", max(-largest, min(largest, torque))))
        accepted: float = struct.unpack("<f", reply)[0]
        return accepted

    def disable(self) -> DriveEnd:
        self._ask(POWER, b"\x00")
        return DriveEnd(state="on" if _STATE_REPLY.unpack(self._ask(STATE, b""))[2] else "off")

    def close(self) -> None:
        self._ask(POWER, b"\x00")

    def bus_load(self, period: float) -> float:
        return 4e-5 / period

    def identity(self) -> dict[str, Any]:
        return {"drive": "Acme 200", "port": self.options.port}

    def metadata(self) -> dict[str, Any]:
        return {"drive_type": "acme", "drive_options": dict(AcmeType().metadata(self.options))}

    def _ask(self, identifier: int, payload: bytes) -> bytes:
        reply = self._line.request(identifier, payload)
        if reply is None:
            raise DriveFaultError("bus", f"no reply to request 0x{identifier:02X}")
        if self.tap is not None:
            self.tap(self.clock.now(), identifier, payload, True)
            self.tap(self.clock.now(), identifier + 1, reply, False)
        return reply


class EmulatedLine:
    """A line and a drive on virtual time; the drive moves a simulated joint."""

    def __init__(self, bench: Bench, seed: int) -> None:
        self.clock: Clock = self
        self._joint, self._counts = emulated_joint(bench, seed), bench.drive.counts
        self._time = self._moved = self._heard = self._torque = 0.0
        self._on = False

    def now(self) -> float:
        return self._time

    def sleep_until(self, deadline: float) -> None:
        self._time = max(self._time, deadline)

    def request(self, identifier: int, payload: bytes) -> bytes | None:
        self._move()
        if identifier == STATE:
            turns = self._joint.position / (2.0 * math.pi)
            counts = math.floor(turns * self._counts)
            return _STATE_REPLY.pack(counts, self._joint.velocity, self._on)
        if identifier == POWER:
            self._on, self._torque = bool(payload[0]), 0.0
        elif identifier == TORQUE:
            self._torque = struct.unpack("<f", payload)[0] if self._on else 0.0
            payload = struct.pack("<f", self._torque)
        self._heard = self._time
        return payload

    def _move(self) -> None:
        if self._time - self._heard > _WATCHDOG:
            self._on, self._torque = False, 0.0
        if self._time > self._moved:
            self._joint.advance(self._torque, self._time - self._moved)
            self._moved = self._time


class AcmeType(DriveType):
    """What `jointid.drives` names."""

    def options(self, session: Table, bus: BusOptions) -> AcmeOptions:
        del bus  # an Acme drive is on no CAN bus
        return session.table("drive").without("type").make(AcmeOptions)

    @contextmanager
    def open(self, bench: Bench) -> Iterator[AcmeDrive]:
        raise InputError("there is no drive", argument="port", value=bench.drive.port)
        yield

    @contextmanager
    def emulate(self, bench: Bench, seed: int) -> Iterator[AcmeDrive]:
        yield AcmeDrive(EmulatedLine(bench, seed), bench.joint, bench.drive)

    def recorded_options(self, metadata: Mapping[str, Any]) -> AcmeOptions:
        return AcmeOptions(**metadata.get("drive_options", {}))

    def decode(
        self, frames: Iterable[LoggedFrame], joint: Joint, options: Any, identity: Mapping[str, Any]
    ) -> Sequence[LoggedCycle]:
        del joint, identity  # positions and torques are at the output, and nothing else is needed
        cycles, taken, counts = list[LoggedCycle](), math.nan, 0
        for frame in frames:
            when, identifier, payload = frame.time, frame.identifier, frame.payload
            if identifier == STATE + 1:
                taken, counts = when, _STATE_REPLY.unpack(payload)[0]
            elif identifier == TORQUE + 1:
                position = counts * 2.0 * math.pi / options.counts
                (torque,) = struct.unpack("<f", payload)
                cycles.append(
                    LoggedCycle(taken=taken, acted=when, position=position, torque=torque)
                )
        return cycles
