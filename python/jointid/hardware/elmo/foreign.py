"""Frames of another master: by them somebody else commands our drive, or feeds its watchdog."""

from __future__ import annotations

import socket
import struct
from collections import deque

import can

from jointid.base.errors import InputError
from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.codec import Command
from jointid.hardware.elmo.options import ElmoOptions

_RETURN = (
    2.0  # [s] in which an interface gives a frame of our own back, also to a host that stood still
)
_MOST_SENT = 4096  # frames of our own that are remembered
_MOST_KEPT = 20  # foreign frames for the recording's metadata
_NETWORK = {
    canopen.START: "start",
    canopen.STOP: "stop",
    canopen.PRE_OPERATIONAL: "enter pre-operational",
    canopen.RESET_NODE: "reset node",
    canopen.RESET_COMMUNICATION: "reset communication",
}


class ForeignWatch:
    """Tells our own frames, which some interfaces give back, from another master's.

    Where it is not known whether the interface gives them back, it is seen from the first frame that is
    sent on a bus on which nobody else commands the drive; should most of them then stay away, it was a
    foreign frame.

    Parameters
    ----------
    options : ElmoOptions
    gives_back : bool, optional
        Whether the interface does, see `gives_back`; False: each such frame is foreign. Default: not known.

    Attributes
    ----------
    frames : list of str
        The first foreign frames: time [s], identifier and bytes in hexadecimal digits.
    """

    def __init__(self, options: ElmoOptions, gives_back: bool | None = None) -> None:
        self._options = options
        self._known = False if gives_back is False else None  # one that should may fail to
        self._commanding = frozenset(options.commanding)
        self._sent: deque[tuple[float, int, bytes]] = deque(maxlen=_MOST_SENT)
        self._given_back: bool | None = self._known
        self._balance = 0  # frames that came back, less those that did not
        self.frames: list[str] = []

    def begin(self) -> None:
        """Nothing of ours is on its way, and it may not be known yet whether it comes back."""
        self._sent.clear()
        self._given_back, self._balance = self._known, 0
        self.frames = []

    def decide(self) -> None:
        """A frame has been sent and answered: if it has not come back, none will."""
        if self._given_back is None:
            self._given_back = False
            self._sent.clear()

    def sent(self, when: float, identifier: int, payload: bytes) -> None:
        """A frame of ours [s]."""
        if self._given_back is not False:
            self._sent.append((when, identifier, payload))

    def concerns(self, identifier: int) -> bool:
        """Whether only a master of this drive sends such frames."""
        return identifier in self._commanding

    def is_own(self, when: float, identifier: int, payload: bytes) -> bool:
        """Whether a frame is one of ours that comes back; each one comes back once."""
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
        """Return what a foreign frame does to our drive, and keep it; empty when it is for other nodes."""
        node, master = self._options.node, self._options.master_node
        if identifier == canopen.NMT and (len(payload) != 2 or payload[1] not in (0, node)):
            return ""
        if len(self.frames) < _MOST_KEPT:
            self.frames.append(f"{when:.6f} {identifier:03X}#{payload.hex().upper()}")
        if identifier == canopen.heartbeat_id(master):
            return (
                f"another node sends the heartbeat of node {master} ({identifier:03X}h): it would keep the drive on "
                "after this program has died; give the session a node of its own (master in [session.drive])"
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
    """Return whether a bus gives its own frames back, where that is a matter of its settings; None: not known.

    Known for python-can's SocketCAN and virtual buses and for the emulated one. With SocketCAN a message's
    `is_rx` does not tell: it is False for the frames of all programs on this host.
    """
    told = getattr(bus, "receive_own_messages", None)
    if isinstance(told, bool):
        return told
    if "socketcan" not in type(bus).__module__.split("."):
        return None
    try:
        option = bus.socket.getsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_RECV_OWN_MSGS)  # type: ignore[attr-defined]
    except (AttributeError, OSError):  # a system without SocketCAN, or a bus of a like name
        return None
    return bool(option)
