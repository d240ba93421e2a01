"""An Elmo SimplIQ drive over CAN: brought up, driven by current, shut down."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from typing import Any

import can

from jointid.errors import InputError
from jointid.hardware import canopen_frames as canopen
from jointid.hardware.clock import Clock, MonotonicClock
from jointid.hardware.drive import DriveFaultError, DriveSample
from jointid.hardware.elmo_codec import Command, DriveError, Reply
from jointid.hardware.elmo_decoder import ElmoDecoder
from jointid.hardware.elmo_errors import DriveStatus, Emergency, failure_meaning
from jointid.hardware.elmo_options import ElmoOptions
from jointid.hardware.torque_source import AnalogInput, SyncedConverter
from jointid.joint.joint import Joint

_BOOT, _ANSWER, _ENABLE = 2.0, 0.2, 3.0  # [s] to wait for each
Tap = Callable[[float, int, bytes, bool], None]  # time, identifier, payload, whether sent
_MOST_WAITING = 10_000  # frames; a bus that brings more at once is not read to its end
_MASTERS = (1, 2)  # our node, whose heartbeat the drive watches: the first that is not the drive's


class ElmoDrive:
    """A `Drive` on a CAN bus.

    Parameters
    ----------
    bus : can.BusABC
        Left open by `close`.
    joint : Joint
        With gear ratio and torque constant.
    options : ElmoOptions
    clock : Clock, optional
        Default: the bus's own if it has one, else a `MonotonicClock`.

    Raises
    ------
    InputError
        The joint has no torque constant.
    """

    def __init__(
        self,
        bus: can.BusABC,
        joint: Joint,
        options: ElmoOptions | None = None,
        *,
        clock: Clock | None = None,
    ) -> None:
        if joint.torque_constant is None:
            raise InputError(
                "ElmoDrive: the joint has no torque_constant, so no torque can be commanded; give it in "
                "the joint file under [drive]"
            )
        self.options = options if options is not None else ElmoOptions()
        node = self.options.node
        self._bus = bus
        self.tap: Tap | None = None
        own: Any = bus if hasattr(bus, "sleep_until") else MonotonicClock()
        self._clock: Clock = own if clock is None else clock
        self._per_ampere = joint.torque_constant * joint.gear_ratio
        self._command_id = self.options.command_id
        self._master = next(each for each in _MASTERS if each != node)
        # Some interfaces, e.g. udp_multicast, give us our own frames back.
        self._ours = {
            *(canopen.NMT, canopen.SYNC, self._command_id, 0x600 + node),
            canopen.heartbeat_id(self._master),
        }
        self._asked = 0.0
        self._seen = ElmoDecoder(joint, self.options)
        self._replies: dict[tuple[str, int], Reply | DriveError] = {}
        self._answers: list[bytes] = []
        self._booted = self._up = False
        self._fault: DriveFaultError | None = None
        self._cycle = 0
        self._identity: dict[str, Any] = {"drive": "Elmo SimplIQ", "node": node}
        self._peak = math.inf

    @property
    def clock(self) -> Clock:
        """What the samples are stamped by."""
        return self._clock

    def identity(self) -> dict[str, Any]:
        """What the drive said of itself."""
        return dict(self._identity)

    def connect(self, period: float) -> None:
        """Reset the drive's communication, map its PDOs, arm its watchdog; motor off, torque mode."""
        node = self.options.node
        self._up = False
        self._drain(0.01)
        self._seen.forget()
        self._booted, self._fault = False, None
        self._send(canopen.NMT, canopen.network(canopen.RESET_COMMUNICATION, node))
        self._wait(
            lambda: self._booted, _BOOT, "no boot-up message: is the drive on, is its node right?"
        )
        self._identify()
        self._map_position()
        self._arm_watchdog()
        self._send(canopen.NMT, canopen.network(canopen.START, node))
        self._ask(Command(letters="MO", value=0))
        self._ask(Command(letters="RM", value=0))
        self._ask(Command(letters="UM", value=1))
        self._peak = float(self._ask(Command(letters="PL", index=1)).value)
        rated = float(self._ask(Command(letters="CL", index=1)).value)
        self._seen.rated_current = rated
        self._identity |= {"peak_current": self._peak, "continuous_current": rated}
        self._up = True
        del period

    def problems(self, torque_limit: float) -> list[str]:
        """What speaks against enabling the motor."""
        told = []
        allowed = torque_limit / abs(self._per_ampere)
        if self._peak > allowed * (1.0 + 1e-6):
            told.append(
                f"the drive's peak current PL[1] is {self._peak:g} A, the session allows {allowed:.4g} A; "
                "set PL[1] down or the session's torque limit up"
            )
        status = DriveStatus.of(int(self._ask(Command(letters="SR")).value))
        if status.problem:
            told.append(f"the drive reports {status.problem}")
        if status.unit_mode != 1:
            told.append(f"the drive is in unit mode {status.unit_mode}, not in torque mode (UM=1)")
        if status.motor_on:
            told.append("the motor is on already; something else commands the drive")
        return told

    def enable(self) -> None:
        """Motor on, at zero torque."""
        self._ask(Command(letters="MO", value=1))
        end = self._clock.now() + _ENABLE
        while not DriveStatus.of(int(self._ask(Command(letters="SR")).value)).motor_on:
            if self._clock.now() > end:
                raise DriveFaultError("refused", "the motor does not come on (MO=1, SR bit 4)")
            self._clock.sleep_until(self._clock.now() + 0.02)
        self._ask(Command(letters="TC", value=0.0))

    def read(self, timeout: float) -> DriveSample:
        """Position, current and sensor at a SYNC."""
        end = self._clock.now() + timeout
        self._read_waiting()
        self._settle(timeout)
        taken = self._asked = self._clock.now()
        self._seen.begin()
        self._send(canopen.SYNC, b"")
        source = self.options.torque
        if isinstance(source, AnalogInput) and self._cycle % source.every == 0:
            self._send(self._command_id, Command(letters="AN", index=source.number).payload())
        self._cycle += 1
        self._answered(end - taken)
        return DriveSample(
            time=taken,
            position=self._seen.position,
            reading=self._seen.reading,
            fresh=self._seen.fresh or source is None,
            clipped=self._seen.clipped,
            current=self._seen.current,
        )

    def command(self, torque: float) -> float:
        """Send a torque, and the heartbeat that tells the drive that we are there."""
        current = max(-self._peak, min(self._peak, torque / self._per_ampere))
        told = struct.unpack("<f", struct.pack("<f", current))[0]
        self._send(self._command_id, Command(letters="TC", value=told).payload())
        self._send(canopen.heartbeat_id(self._master), b"\x05")
        return float(told) * self._per_ampere

    def disable(self) -> None:
        """TC = 0, then MO = 0, both sent whatever the bus says; the last is asked for an answer."""
        for command in (Command(letters="TC", value=0.0), Command(letters="MO", value=0)):
            try:
                payload = command.payload()
                self._bus.send(self._message(self._command_id, payload), timeout=0.05)
                self._tapped(self._command_id, payload, sent=True)
            except can.CanError:
                continue  # the drive's own watchdog remains

    def close(self) -> None:
        """Leave the drive pre-operational."""
        node = self.options.node
        try:
            self._drain(0.01)
            self._bus.send(
                self._message(canopen.NMT, canopen.network(canopen.PRE_OPERATIONAL, node))
            )
            self._drain(0.01)
        except (can.CanError, DriveFaultError):
            return

    @property
    def command_latency(self) -> float:
        """From sending a command until the drive acts on it [s], reckoned."""
        return canopen.bits_on_wire(8) / self.options.bitrate + self.options.execution_delay

    def bus_load(self, period: float) -> float:
        """Share of the bus: SYNC, position, command with echo, heartbeat, sensor."""
        bits = canopen.bits_on_wire
        total = bits(0) + 3 * bits(8) + bits(1)
        if isinstance(self.options.torque, SyncedConverter):
            total += bits(4)
        elif isinstance(self.options.torque, AnalogInput):
            total += (bits(4) + bits(8)) / self.options.torque.every
        return total / (self.options.bitrate * period)

    # Bringing up.

    def _identify(self) -> None:
        for name, subindex in (("vendor", 1), ("product", 2), ("revision", 3)):
            try:
                value = self._object(canopen.SdoRequest(index=0x1018, subindex=subindex))
            except canopen.SdoAbortError:
                continue
            self._identity[name] = f"0x{value:X}"

    def _map_position(self) -> None:
        """Position and torque in the fourth PDO, at each SYNC: off, mapped, on."""
        cob = self.options.position_id
        for index, subindex, value, size in (
            (0x1803, 1, 0xC0000000 | cob, 4),
            (0x1A03, 0, 0, 1),
            (0x1803, 2, 1, 1),
            (0x1A03, 1, 0x60640020, 4),
            (0x1A03, 2, 0x60770010, 4),
            (0x1A03, 0, 2, 1),
            (0x1803, 1, cob, 4),
        ):
            self._object(canopen.SdoRequest(index=index, subindex=subindex, value=value, size=size))

    def _arm_watchdog(self) -> None:
        """The drive stops by itself when our heartbeat stays away."""
        allowed = round(1e3 * self.options.heartbeat)
        for index, subindex, value, size in (
            (0x1016, 1, self._master << 16 | allowed, 4),
            (0x6007, 0, 2, 2),
            (0x1029, 1, 1, 1),
            (0x2F21, 0, 0x188, 4),
        ):
            self._object(canopen.SdoRequest(index=index, subindex=subindex, value=value, size=size))

    def _object(self, request: canopen.SdoRequest) -> int:
        self._answers.clear()
        self._send(0x600 + self.options.node, request.payload())
        found: list[int] = []

        def answered() -> bool:
            for payload in self._answers:
                result = canopen.sdo_result(payload, request)
                if result is not None:
                    found.append(result)
            return bool(found)

        self._wait(answered, _ANSWER, f"no answer to object {request.index:04X}h")
        return found[0]

    def _ask(self, command: Command) -> Reply:
        """Send a command and wait for its reply; one of a kind at a time."""
        self._replies.pop(command.key, None)
        self._send(self._command_id, command.payload())
        self._wait(lambda: command.key in self._replies, _ANSWER, f"no reply to {command.letters}")
        reply = self._replies.pop(command.key)
        if isinstance(reply, DriveError):
            raise DriveFaultError("refused", str(reply))
        return reply

    # Frames.

    def _message(self, identifier: int, payload: bytes) -> can.Message:
        return can.Message(arbitration_id=identifier, data=payload, is_extended_id=False)

    def _send(self, identifier: int, payload: bytes) -> None:
        try:
            self._bus.send(self._message(identifier, payload), timeout=0.01)
            self._tapped(identifier, payload, sent=True)
        except can.CanError as error:
            raise DriveFaultError("bus", f"a frame could not be sent: {error}") from error

    def _wait(self, done: Any, timeout: float, told: str, kind: str = "refused") -> None:
        end = self._clock.now() + timeout
        while not done():
            left = end - self._clock.now()
            if left <= 0.0:
                raise DriveFaultError(kind, f"{told} within {1e3 * timeout:g} ms")
            self._receive(left)
            self._raise_fault()

    def _drain(self, timeout: float) -> None:
        end = self._clock.now() + timeout
        while self._receive(max(0.0, end - self._clock.now())):
            pass

    def _answered(self, timeout: float) -> None:
        told = "no answer to the SYNC"
        self._wait(lambda: self._seen.complete, timeout, told, kind="stale_position")

    def _settle(self, timeout: float) -> None:
        """Let the last SYNC be answered before the next goes out: an answer does not say whose it is."""
        if self._seen.complete:
            return
        if self._clock.now() - self._asked > self.options.heartbeat:
            self._seen.forget()  # so late nothing comes any more, and the drive has stopped by itself
        else:
            self._answered(timeout)

    def _read_waiting(self) -> None:
        """What has come since the last cycle, e.g. while the host stood still, is not this one's answer."""
        for _ in range(_MOST_WAITING):
            if not self._receive(0.0):
                break
        self._raise_fault()

    def _receive(self, timeout: float) -> bool:
        try:
            message = self._bus.recv(timeout)
        except can.CanError as error:
            raise DriveFaultError("bus", f"nothing can be received: {error}") from error
        if message is None:
            return False
        if message.is_error_frame:
            self._fault = DriveFaultError(
                "bus", f"an error frame (class 0x{message.arbitration_id:X}): bus-off or bad wiring"
            )
            return True
        if message.arbitration_id in self._ours:
            return True
        payload = bytes(message.data)
        self._tapped(message.arbitration_id, payload, sent=False)
        self._sort(message.arbitration_id, payload)
        return True

    def _tapped(self, identifier: int, payload: bytes, *, sent: bool) -> None:
        if self.tap is not None:
            self.tap(self._clock.now(), identifier, payload, sent)

    def _sort(self, identifier: int, payload: bytes) -> None:
        node = self.options.node
        if self._seen.take(identifier, payload):
            return
        if identifier == self.options.reply_id:
            self._take_reply(payload)
        elif identifier == 0x580 + node:
            self._answers.append(payload)
        elif identifier == canopen.emergency_id(node):
            self._take_emergency(payload)
        elif identifier == canopen.heartbeat_id(node) and payload == b"\x00":
            if self._up:
                self._fault = DriveFaultError("drive_fault", "the drive has started anew")
            self._booted = True

    def _take_reply(self, payload: bytes) -> None:
        try:
            reply = Reply.of(payload)
        except DriveError as error:
            self._replies[error.letters, error.index] = error
            if error.letters == "TC":
                self._fault = DriveFaultError("drive_fault", str(error))
            return
        except InputError as error:
            self._fault = DriveFaultError("drive_fault", f"an unreadable reply: {error}")
            return
        if reply.letters == "AN":
            self._seen.take_voltage(float(reply.value))
        self._replies[reply.key] = reply

    def _take_emergency(self, payload: bytes) -> None:
        emergency = Emergency.of(payload)
        if emergency is not None and emergency.code:
            self._fault = DriveFaultError(
                "emergency", f"the drive reports {emergency.meaning} (0x{emergency.code:04X})"
            )

    def _raise_fault(self) -> None:
        if self._fault is not None:
            fault, self._fault = self._fault, None
            raise fault


def failure_of(drive: ElmoDrive) -> str:
    """What MF says, in words: why the motor was shut down."""
    return failure_meaning(int(drive._ask(Command(letters="MF")).value))
