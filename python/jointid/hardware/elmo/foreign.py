"""Detect frames of another master, which commands our drive or feeds its watchdog."""

from __future__ import annotations

import socket
import struct
from collections import deque

import can

from jointid.base.errors import InputError
from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.codec import Command
from jointid.hardware.elmo.options import ElmoOptions

_RETURN = 2.0  # [s] in which an interface returns our own frame, also on a host that paused
_MOST_SENT = 4096  # own frames that are stored
_MOST_KEPT = 20  # foreign frames in the recording's metadata
_NETWORK = {
    canopen.START: "start",
    canopen.STOP: "stop",
    canopen.PRE_OPERATIONAL: "enter pre-operational",
    canopen.RESET_NODE: "reset node",
    canopen.RESET_COMMUNICATION: "reset communication",
}


class ForeignWatch:
    """Distinguish our own frames, which some interfaces return, from frames of another master.

    If it is unknown whether the interface returns own frames, our first frame on a bus without another master
    decides. If most later frames do not come back, the first returned frame was a foreign one.

    Parameters
    ----------
    options : ElmoOptions
    gives_back : bool, optional
        Whether the interface returns own frames, see `gives_back`. False: every such frame is foreign.
        Default: unknown.

    Attributes
    ----------
    frames : list of str
        The first foreign frames: time [s], identifier and bytes in hexadecimal digits.
    """

    def __init__(self, options: ElmoOptions, gives_back: bool | None = None) -> None:
        self._options = options
        self._known = False if gives_back is False else None  # True may be wrong
        self._commanding = frozenset(options.commanding)
        self._sent: deque[tuple[float, int, bytes]] = deque(maxlen=_MOST_SENT)
        self._given_back: bool | None = self._known
        self._balance = 0  # returned own frames minus those not returned
        self.frames: list[str] = []

    def begin(self) -> None:
        """Start again: none of our frames is on the bus. It may be unknown whether they come back."""
        self._sent.clear()
        self._given_back, self._balance = self._known, 0
        self.frames = []

    def decide(self) -> None:
        """Decide after a frame was sent and answered: if it has not come back, no frame will."""
        if self._given_back is None:
            self._given_back = False
            self._sent.clear()

    def sent(self, when: float, identifier: int, payload: bytes) -> None:
        """Note a frame that we sent [s]."""
        if self._given_back is not False:
            self._sent.append((when, identifier, payload))

    def concerns(self, identifier: int) -> bool:
        """Return whether only a master of this drive sends such frames."""
        return identifier in self._commanding

    def is_own(self, when: float, identifier: int, payload: bytes) -> bool:
        """Return whether a frame is our own, returned by the interface. Each frame comes back once."""
        while self._sent and self._sent[0][0] < when - _RETURN:
            self._sent.popleft()
            self._balance -= 1
        if self._balance < 0:
            self._given_back = False
            self._sent.clear()
        for place, (_, other, content) in enumerate(self._sent):
            if (other, content) == (identifier, payload):
                del self._sent[place]
                self._given_back = True
                self._balance += 1
                return True
        return False

    def meaning(self, when: float, identifier: int, payload: bytes) -> str:
        """Return the effect of a foreign frame on our drive and store it; empty when it is for other nodes."""
        node, master = self._options.node, self._options.master_node
        if identifier == canopen.NMT and (len(payload) != 2 or payload[1] not in (0, node)):
            return ""
        if len(self.frames) < _MOST_KEPT:
            self.frames.append(f"{when:.6f} {identifier:03X}#{payload.hex().upper()}")
        if identifier == canopen.heartbeat_id(master):
            return (
                f"another node sends the heartbeat of node {master} ({identifier:03X}h): this heartbeat would keep "
                "the drive on after this program has died; choose an unused node for the session (master in "
                "[session.drive])"
            )
        return f"another program commands the drive: {self._act(identifier, payload)}"

    def _act(self, identifier: int, payload: bytes) -> str:
        shown = f"{identifier:03X}#{payload.hex().upper()}"
        if identifier == canopen.NMT:
            return f"network command '{_NETWORK.get(payload[0], 'not known')}' ({shown})"
        if identifier == canopen.SYNC:
            return f"SYNC, which it answers ({shown})"
        if identifier == 0x600 + self._options.node and len(payload) == 8:
            index, subindex = struct.unpack_from("<HB", payload, 1)
            return f"access to object {index:04X}h:{subindex} ({shown})"
        if identifier == self._options.command_id:
            try:
                command = Command.of(payload)
            except InputError:
                return shown
            place = f"[{command.index}]" if command.index else ""
            value = "" if command.value is None else f" = {command.value:g}"
            return f"{command.letters}{place}{value} ({shown})"
        return f"a PDO ({shown})"


def gives_back(bus: can.BusABC) -> bool | None:
    """Return whether a bus returns its own frames, if its settings show it; None: unknown.

    Known for python-can's SocketCAN and virtual buses and for the emulated bus. With SocketCAN a message's
    `is_rx` does not show it: it is False for the frames of all programs on this host.
    """
    told = getattr(bus, "receive_own_messages", None)
    if isinstance(told, bool):
        return told
    if "socketcan" not in type(bus).__module__.split("."):
        return None
    try:
        option = bus.socket.getsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_RECV_OWN_MSGS)  # type: ignore[attr-defined]
    except (AttributeError, OSError):  # a system without SocketCAN, or another bus of the same name
        return None
    return bool(option)
