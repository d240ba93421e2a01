"""Exchange frames with one Elmo drive: sort its answers, keep the first fault."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import can

from jointid.base.errors import InputError
from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.can import sdo_upload
from jointid.hardware.can.bus_errors import error_frame_meaning
from jointid.hardware.elmo.codec import Command, DriveError, Reply
from jointid.hardware.elmo.decoder import ElmoDecoder
from jointid.hardware.elmo.echoes import CommandEchoes
from jointid.hardware.elmo.errors import Emergency
from jointid.hardware.elmo.foreign import ForeignWatch, gives_back
from jointid.hardware.elmo.lone_node import LoneNode
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.timing import SyncWatch
from jointid.hardware.session.clock import Clock, MonotonicClock
from jointid.hardware.session.drive import DriveFaultError

_ANSWER = 0.2  # [s] to wait for an answer
HOST_HEARTBEAT = 0x8130
"""Code of the emergency for a missing host heartbeat."""
_MOST_WAITING = 10_000  # frames; a bus that brings more at once is not read to its end
Tap = Callable[[float, int, bytes, bool], None]  # time, identifier, payload, whether sent
Meanwhile = Callable[[], float]  # something to do while waiting; returns when to call it next [s]


class ElmoLink:
    """Exchange frames with one drive.

    Parameters
    ----------
    bus : can.BusABC
    options : ElmoOptions
    seen : ElmoDecoder
        Decodes the cyclic frames.
    clock : Clock, optional
        Default: the bus's own if it has one, else a `MonotonicClock`.
    """

    def __init__(
        self,
        bus: can.BusABC,
        options: ElmoOptions,
        seen: ElmoDecoder,
        clock: Clock | None = None,
    ) -> None:
        self._bus, self._options, self._seen = bus, options, seen
        own: Any = bus if hasattr(bus, "sleep_until") else MonotonicClock()
        self.clock: Clock = own if clock is None else clock
        self.tap: Tap | None = None
        self.alone = LoneNode(options.node)
        self.up = False  # when True, a boot-up message or another state is a fault
        self.heard = 0.0  # [s], time of the drive's last heartbeat
        # SocketCAN stamps a frame when the kernel receives it.
        self._virtual = clock is None and own is bus
        self.stamped = self._virtual or "socketcan" in type(bus).__module__.split(".")
        self.watch = SyncWatch(options.bitrate, stamped=self.stamped)
        self._command_id, self._reply_id = options.command_id, options.reply_id
        self.foreign = ForeignWatch(options, gives_back(bus))
        self.echoes = CommandEchoes()
        self._replies: dict[tuple[str, int], Reply | DriveError] = {}
        self._answers: list[bytes] = []
        self._fault: DriveFaultError | None = None

    # Towards the drive.

    def send(self, identifier: int, payload: bytes) -> float:
        """Send a frame. Return the send time [s].

        Raises
        ------
        DriveFaultError
            The bus does not accept it.
        """
        message = can.Message(arbitration_id=identifier, data=payload, is_extended_id=False)
        begun = self.clock.now()
        self.foreign.sent(begun, identifier, payload)
        if identifier == 0x600 + self._options.node:
            self.alone.asked()
        try:
            self._bus.send(message, timeout=0.01)
        except (can.CanError, OSError) as error:  # OSError from some interfaces
            raise DriveFaultError("bus", f"a frame could not be sent: {error}") from error
        when = self.clock.now()  # after the sending, which may have waited for the processor
        if not self.stamped:  # without stamps the answer does not show how long we waited
            when = 0.5 * (begun + when)
        if identifier != canopen.SYNC:
            self.watch.own(when, len(payload))
        if self.tap is not None:
            self.tap(when, identifier, payload, True)
        return when

    def command(self, command: Command) -> None:
        """Send a command without waiting for its reply."""
        self._replies.pop(command.key, None)
        self.send(self._command_id, command.payload())

    def ask(
        self, command: Command, timeout: float = _ANSWER, *, meanwhile: Meanwhile | None = None
    ) -> Reply:
        """Send a command and wait for its reply. Only one command of a kind at a time."""
        self.command(command)
        self.wait(
            lambda: command.key in self._replies,
            timeout,
            f"no reply to {command.letters}",
            meanwhile=meanwhile,
        )
        reply = self._replies.pop(command.key)
        if isinstance(reply, DriveError):
            raise DriveFaultError("drive_fault", str(reply))
        return reply

    def number(self, letters: str, timeout: float = _ANSWER, index: int = 0) -> int | float | None:
        """Return the value of a register, even when the drive reports a fault; None without an answer."""
        command = Command(letters=letters, index=index)
        self._replies.pop(command.key, None)
        sent = (self._command_id, command.payload())
        if not self._tried(*sent, lambda: command.key in self._replies, timeout):
            return None
        reply = self._replies.pop(command.key)
        return reply.value if isinstance(reply, Reply) else None

    def object_value(self, request: canopen.SdoRequest, timeout: float) -> int | None:
        """Return the value of an object, even when the drive reports a fault; None without an answer."""
        self._answers.clear()
        found: list[int] = []

        def answered() -> bool:
            try:
                results = [canopen.sdo_result(payload, request) for payload in self._answers]
            except canopen.SdoAbortError:
                return True
            found.extend(result for result in results if result is not None)
            return bool(found)

        self._tried(0x600 + self._options.node, request.payload(), answered, timeout)
        return found[0] if found else None

    def _tried(
        self, identifier: int, payload: bytes, done: Callable[[], bool], timeout: float
    ) -> bool:
        """Send a question and wait for its answer despite errors. Return whether the answer arrived."""
        end = self.clock.now() + timeout
        try:
            self.send(identifier, payload)
            while not done():
                left = end - self.clock.now()
                if left <= 0.0:
                    return False
                self.receive(left)
        except Exception:
            self.clock.sleep_until(end)  # the bus may recover
            return False
        return True

    def transfer(self, request: canopen.SdoRequest) -> int:
        """Read or write an object.

        Raises
        ------
        SdoAbortError
            The drive refuses the access.
        DriveFaultError
        """
        self._answers.clear()
        self.send(0x600 + self._options.node, request.payload())
        found: list[int] = []

        def answered() -> bool:
            for payload in self._answers:
                result = canopen.sdo_result(payload, request)
                if result is not None:
                    found.append(result)
            return bool(found)

        self.wait(answered, _ANSWER, f"no answer to object {request.index:04X}h")
        return found[0]

    def upload(self, index: int, subindex: int) -> bytes:
        """Read an object of any length, e.g. a text.

        Raises
        ------
        SdoAbortError
            The drive refuses the access.
        InputError
            The answer cannot be read.
        DriveFaultError
        """

        def exchange(request: bytes) -> bytes:
            self._answers.clear()
            self.send(0x600 + self._options.node, request)
            self.wait(lambda: bool(self._answers), _ANSWER, f"no answer to object {index:04X}h")
            return self._answers[0]

        return sdo_upload.upload(exchange, index, subindex)

    # From the drive.

    def wait(
        self,
        done: Callable[[], bool],
        timeout: float,
        missing: str,
        kind: str = "drive_fault",
        advice: str = "",
        *,
        meanwhile: Meanwhile | None = None,
    ) -> None:
        """Receive until a condition holds or a fault is known.

        Frames that arrived in time count, even if this program reads them later.

        Raises
        ------
        DriveFaultError
        """
        begin = self.clock.now()
        end = begin + timeout
        while not done():
            left = pause = end - self.clock.now()
            if meanwhile is not None:
                pause = min(left, meanwhile())
            if (not self.receive(max(0.0, pause)) and left <= 0.0) or left < -timeout:
                raise DriveFaultError(
                    kind,
                    f"{missing} within {1e3 * timeout:g} ms{advice}",
                    measured=self.clock.now() - begin,
                    allowed=timeout,
                )
            self.raise_fault()

    def drain(self, timeout: float) -> None:
        """Read the frames that arrive within a time."""
        end = self.clock.now() + timeout
        for _ in range(_MOST_WAITING):
            if not self.receive(max(0.0, end - self.clock.now())):
                break

    def listen(self, duration: float) -> None:
        """Listen for another master of the drive, without sending.

        Raises
        ------
        DriveFaultError
            "foreign_master", as soon as a frame of another master arrives.
        """
        self.foreign.begin()
        end = self.clock.now() + duration
        while (left := end - self.clock.now()) > 0.0:
            self.receive(left)
            self.raise_foreign()

    def raise_foreign(self) -> None:
        """Raise the known fault if it is another master."""
        if self._fault is not None and self._fault.kind == "foreign_master":
            self.raise_fault()

    def read_waiting(self) -> None:
        """Read the frames that have arrived, e.g. while the host paused.

        Raises
        ------
        DriveFaultError
        """
        for _ in range(_MOST_WAITING):
            if not self.receive(0.0):
                break
        self.raise_fault()

    def forget_fault(self, but: str = "") -> None:
        """Drop a stored fault, unless it is of the kind `but`."""
        if self._fault is not None and self._fault.kind != but:
            self._fault = None

    def raise_fault(self) -> None:
        """Raise the first stored fault, once."""
        if self._fault is not None:
            fault, self._fault = self._fault, None
            raise fault

    def receive(self, timeout: float) -> bool:
        """Read a frame. Return whether there was one."""
        try:
            message = self._bus.recv(timeout)
        except (can.CanError, OSError) as error:
            raise DriveFaultError("bus", f"nothing can be received: {error}") from error
        if message is None:
            return False
        if message.is_error_frame:
            meaning = error_frame_meaning(message.arbitration_id, bytes(message.data))
            if meaning:
                self._note("bus", f"the CAN controller reported an error frame: {meaning}")
            return True
        if message.is_extended_id or message.is_remote_frame or message.is_fd:
            return True  # not a frame of the drive
        payload, when = bytes(message.data), self._arrival(message)
        if self.foreign.concerns(message.arbitration_id):
            self._take_foreign(when, message.arbitration_id, payload)
            return True
        if self.tap is not None:
            self.tap(when, message.arbitration_id, payload, False)
        answers = message.arbitration_id == self._options.position_id
        self.watch.came(when, len(payload), answers=answers)
        self._sort(message.arbitration_id, payload)
        return True

    def _arrival(self, message: can.Message) -> float:
        """Return the arrival time of a frame [s] on our clock, from the bus's stamp if the bus uses the same clock."""
        if self._virtual:
            return message.timestamp
        now = self.clock.now()
        if self.stamped:  # the kernel's stamp, from the wall clock; the frame may have waited since
            return now - min(1.0, max(0.0, time.time() - message.timestamp))
        return now

    def _sort(self, identifier: int, payload: bytes) -> None:
        node = self._options.node
        if self._seen.take(identifier, payload):
            return
        if identifier == self._reply_id:
            self._take_reply(payload)
        elif identifier == 0x580 + node:
            self._answers.append(payload)
            self._note_second(self.alone.answered())
        elif identifier == canopen.emergency_id(node):
            self._take_emergency(payload)
        elif identifier == canopen.heartbeat_id(node) and len(payload) == 1:
            self._take_heartbeat(payload[0])

    def _take_foreign(self, when: float, identifier: int, payload: bytes) -> None:
        """Handle a frame that only a master sends: our own, returned, or one of another master."""
        if self.foreign.is_own(self.clock.now(), identifier, payload):
            return
        meaning = self.foreign.meaning(when, identifier, payload)
        if self.tap is not None:
            self.tap(when, identifier, payload, False)
        if meaning:
            self._note("foreign_master", meaning)

    def _take_reply(self, payload: bytes) -> None:
        try:
            reply = Reply.of(payload)
        except DriveError as error:
            self._replies[error.letters, error.index] = error
            if error.letters == "TC":
                self._note("drive_fault", str(error))
            return
        except InputError as error:
            kind = "sensor" if payload[:2] == b"AN" else "drive_fault"
            self._note(kind, f"an unreadable reply: {error}")
            return
        if reply.letters == "AN":
            self._seen.take_voltage(float(reply.value))
        if reply.key == ("TC", 0):
            wrong = self.echoes.came(float(reply.value))
            if wrong:
                self._note("command_echo", wrong)
        self._replies[reply.key] = reply

    def _take_emergency(self, payload: bytes) -> None:
        emergency = Emergency.of(payload)
        if emergency is not None and emergency.code:
            ours = emergency.code == HOST_HEARTBEAT
            self._note(
                "host_heartbeat_lost" if ours else "drive_fault",
                f"the drive reports {emergency.meaning} (emergency 0x{emergency.code:04X})",
            )

    def _take_heartbeat(self, state: int) -> None:
        self.heard = self.clock.now()
        if state == 0:
            if self.up:
                self._note("drive_fault", "the drive has restarted")
            self._note_second(self.alone.boots())
        elif self.up and canopen.STATES.get(state) != "operational":
            name = canopen.STATES.get(state, f"0x{state:02X}")
            self._note(
                "drive_fault", f"the drive has left the state 'operational': its state is '{name}'"
            )

    def _note_second(self, meaning: str) -> None:
        """Note a second node that answers, while the drive is being connected."""
        if meaning and not self.up:
            self._note("drive_fault", meaning)

    def _note(self, kind: str, message: str) -> None:
        """Store the first fault, because later ones are often its consequence."""
        if self._fault is None:
            self._fault = DriveFaultError(kind, message)
