"""Check whether a node on a CAN bus follows CiA 301, with `canopen`, which knows nothing of this project.

    python tools/canopen_conformance.py --emulate                              # the emulated Elmo drive
    python tools/canopen_conformance.py --interface socketcan --channel can0   # a real one, its motor off

Nothing moves: the motor stays off, and the node's communication is reset before and after. Prints a line for
each check and ends with 0 when all passed, 1 when one failed. --plain leaves out the checks of Elmo's own objects.
"""

from __future__ import annotations

import argparse
import contextlib
import queue
import struct
import sys
import time
import uuid
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import can
import canopen

PATIENCE = 5.0  # [s] for an answer: the machine may be busy, a node is not
MASTER = 0x55  # a node that does not exist; its heartbeat is awaited and stays away
POSITION, TORQUE = 0x60640020, 0x60770010
Check = Callable[["Node"], Iterator["Finding"]]


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Result of one check."""

    name: str
    passed: bool
    said: str


def _dictionary() -> canopen.ObjectDictionary:
    """Return the description of the fourth PDO and of two objects that `canopen` needs to map them."""
    found = canopen.ObjectDictionary()  # type: ignore[no-untyped-call]
    kinds = canopen.objectdictionary
    wide, short, byte = kinds.UNSIGNED32, kinds.UNSIGNED16, kinds.UNSIGNED8
    parts = {
        0x1803: {0: byte, 1: wide, 2: byte, 3: short, 5: short},
        0x1A03: {0: byte, **dict.fromkeys(range(1, 9), wide)},
    }
    for index, types in parts.items():
        record = kinds.ODRecord(f"{index:04X}h", index)
        for subindex, kind in types.items():
            variable = kinds.ODVariable(str(subindex), index, subindex)
            variable.data_type = kind
            record.add_member(variable)
        found.add_object(record)
    for index, kind in ((0x6064, kinds.INTEGER32), (0x6077, kinds.INTEGER16)):
        variable = kinds.ODVariable(f"{index:04X}h", index)
        variable.data_type = kind
        found.add_object(variable)
    return found


class Node:
    """The tested node, and its frames."""

    def __init__(self, network: canopen.Network, number: int) -> None:
        self.network, self.number = network, number
        self.remote = canopen.RemoteNode(number, _dictionary())
        network.add_node(self.remote)
        self.remote.sdo.RESPONSE_TIMEOUT = PATIENCE
        self.remote.sdo.MAX_RETRIES = 1  # with 0 the library asks without end
        self._frames: dict[int, queue.Queue[bytes]] = {}

    def listen(self, identifier: int) -> None:
        """Keep the frames with an identifier from now on."""
        self._frames[identifier] = queue.Queue()

        def keep(_: int, content: bytearray, __: float) -> None:
            self._frames[identifier].put(bytes(content))

        self.network.subscribe(identifier, keep)

    def next(self, identifier: int, where: Callable[[bytes], bool] = bool) -> bytes:
        """Return the next frame with the wanted identifier; empty if none arrives in time."""
        end = time.monotonic() + PATIENCE
        with contextlib.suppress(queue.Empty):
            while (left := end - time.monotonic()) > 0.0:
                frame = self._frames[identifier].get(timeout=left)
                if where(frame):
                    return frame
        return b""

    def waiting(self, identifier: int) -> int:
        """Return the number of frames with an identifier that arrived and were not read."""
        return self._frames[identifier].qsize()

    def forget(self, identifier: int) -> None:
        """Discard all frames that have arrived."""
        while self.waiting(identifier):
            self._frames[identifier].get()

    def send(self, identifier: int, content: bytes) -> None:
        """Send a frame."""
        self.network.send_message(identifier, content)

    def command(self, command: int) -> None:
        """Send a network command to this node."""
        self.send(0, bytes((command, self.number)))

    def ask(self, content: bytes) -> bytes:
        """Send the bytes of an SDO request and return those of the answer."""
        answers = 0x580 + self.number
        self.forget(answers)
        self.send(0x600 + self.number, content)
        return self.next(answers)

    def read(self, index: int, subindex: int = 0) -> bytes:
        """Return an object's bytes."""
        return bytes(self.remote.sdo.upload(index, subindex))

    def number_of(self, index: int, subindex: int = 0) -> int:
        """Return an object's number."""
        return int.from_bytes(self.read(index, subindex), "little")

    def write(self, index: int, subindex: int, content: bytes, *, segmented: bool = False) -> None:
        """Write an object."""
        self.remote.sdo.download(index, subindex, content, force_segment=segmented)

    def abort(self, act: Callable[[], object]) -> int:
        """Return the code by which a transfer is aborted; 0 if it is not."""
        try:
            act()
        except canopen.SdoAbortedError as error:
            return int(error.code)
        return 0


def mandatory(node: Node) -> Iterator[Finding]:
    """Check the objects of CiA 301 that every device has, or that a watchdog needs, with their sizes."""
    sizes = {
        (0x1000, 0): 4,
        (0x1001, 0): 1,
        (0x1003, 0): 1,
        (0x1005, 0): 4,
        (0x1014, 0): 4,
        (0x1016, 0): 1,
        (0x1016, 1): 4,
        (0x1017, 0): 2,
        (0x1018, 0): 1,
        (0x1029, 1): 1,
        **{(0x1018, subindex): 4 for subindex in (1, 2, 3, 4)},
        (0x1400, 1): 4,
        (0x1400, 2): 1,
        (0x1600, 0): 1,
        (0x1800, 1): 4,
        (0x1800, 2): 1,
        (0x1A00, 0): 1,
        (0x1200, 1): 4,
        (0x1200, 2): 4,
    }
    for (index, subindex), size in sizes.items():
        found = b""
        code = node.abort(lambda at=(index, subindex): node.read(*at))  # type: ignore[misc]
        if not code:
            found = node.read(index, subindex)
        said = f"abort {code:08X}h" if code else f"{len(found)} bytes {found.hex()}"
        yield Finding(
            name=f"{index:04X}h:{subindex} is there", passed=len(found) == size, said=said
        )
    for name, number, wanted in (
        ("1018h:0 counts four", node.number_of(0x1018), 4),
        ("1014h is the emergency's", node.number_of(0x1014) & 0x7FF, 0x80 + node.number),
        ("1001h shows no error", node.number_of(0x1001), 0),
    ):
        yield equal(name, number, wanted)


def texts(node: Node) -> Iterator[Finding]:
    """Check that texts come in segments."""
    for index in (0x1008, 0x100A):
        found = node.read(index)
        passed = len(found) > 4 and found.isascii() and found.decode("ascii").isprintable()
        yield Finding(name=f"{index:04X}h is a text", passed=passed, said=repr(found))


def aborts(node: Node) -> Iterator[Finding]:
    """Check that invalid reads and writes are aborted, with the code of the reason."""
    for name, act, codes in (
        ("no object, read", lambda: node.read(0x5FFF), {0x06020000}),
        ("no object, written", lambda: node.write(0x5FFF, 0, bytes(4)), {0x06020000}),
        ("no sub-index", lambda: node.read(0x1018, 9), {0x06090011}),
        ("read only", lambda: node.write(0x1018, 1, bytes(4)), {0x06010002}),
        ("too long", lambda: node.write(0x1017, 0, bytes(4)), {0x06070010, 0x06070012}),
        ("too short", lambda: node.write(0x1017, 0, bytes(1)), {0x06070010, 0x06070013}),
        (
            "too long, in segments",
            lambda: node.write(0x1017, 0, bytes(9), segmented=True),
            {0x06070010, 0x06070012},
        ),
        ("out of range", lambda: node.write(0x1029, 1, b"\x07"), {0x06090030}),
        ("no such node", lambda: node.write(0x1016, 1, b"\x64\0\x01\x01"), {0x06090030}),
        ("history set", lambda: node.write(0x1003, 0, b"\x01"), {0x06090030}),
        ("no error kept", lambda: node.read(0x1003, 1), {0x08000024, 0x06090011}),
    ):
        code = node.abort(act)
        yield Finding(name=f"abort: {name}", passed=code in codes, said=f"{code:08X}h")
    for name, content, code in (
        ("block transfer", b"\xc2\x17\x10\x00" + bytes(4), 0x05040001),
        ("four bytes", b"\x40\x17\x10\x00", 0x05040001),
        ("segment of nothing", b"\x60" + bytes(7), 0x05040001),
    ):
        yield equal(f"abort: {name}", node.ask(content), b"\x80", code)
    yield equal("abort: the node goes on", len(node.read(0x1017)), 2)


def segments(node: Node) -> Iterator[Finding]:
    """Check writing in segments: a transfer that goes wrong ends, and the next one is not disturbed."""
    node.write(0x1017, 0, struct.pack("<H", 700), segmented=True)
    yield equal("written in segments", node.number_of(0x1017), 700)
    node.ask(b"\x21\x17\x10\x00\x02\x00\x00\x00")
    yield equal("wrong toggle", node.ask(b"\x1b\x01\x02" + bytes(5)), b"\x80", 0x05030000)
    yield equal("and what was there stays", node.number_of(0x1017), 700)
    node.ask(b"\x40\x08\x10\x00" + bytes(4))
    yield equal("wrong toggle, read", node.ask(b"\x70" + bytes(7)), b"\x80", 0x05030000)
    node.ask(b"\x40\x08\x10\x00" + bytes(4))
    node.send(0x600 + node.number, b"\x80\x08\x10\x00" + bytes(4))  # no answer is due
    yield equal("after the client's abort", node.ask(b"\x60" + bytes(7)), b"\x80", 0x05040001)
    node.write(0x1017, 0, bytes(2))


def mapping(node: Node) -> Iterator[Finding]:
    """Check the rules of mapping: off, count 0, entries, count, on."""
    cob, entry = 0x480 + node.number, struct.Struct("<I")
    off, on = entry.pack(0xC0000000 | cob), entry.pack(0x40000000 | cob)
    node.write(0x1803, 1, off)
    refused: list[tuple[str, Callable[[], object]]] = []

    def refuse(name: str, index: int, subindex: int, content: bytes) -> None:
        refused.append((name, lambda: node.write(index, subindex, content)))

    node.write(0x1A03, 0, b"\0")
    node.write(0x1A03, 1, entry.pack(POSITION))
    node.write(0x1A03, 2, entry.pack(TORQUE))
    refuse("what does not exist", 0x1A03, 3, entry.pack(0x5FFF0020))
    refuse("what cannot be mapped", 0x1A03, 3, entry.pack(0x10170010))
    refuse("another length", 0x1A03, 3, entry.pack(0x60640010))
    refuse("more than is there", 0x1A03, 0, b"\x04")
    refuse("transmission type F5h", 0x1803, 2, b"\xf5")
    refuse("a reserved identifier", 0x1803, 1, entry.pack(0x80000601))
    yield from _all_refused(node, refused)
    for subindex in (3, 4):
        node.write(0x1A03, subindex, entry.pack(POSITION))
    refuse("more than eight bytes", 0x1A03, 0, b"\x04")
    yield from _all_refused(node, refused)
    node.write(0x1A03, 0, b"\x02")
    refuse("an entry while the count is not 0", 0x1A03, 3, entry.pack(POSITION))
    yield from _all_refused(node, refused)
    node.write(0x1803, 2, b"\x01")
    node.write(0x1803, 1, on)
    refuse("a count while it is on", 0x1A03, 0, b"\0")
    refuse("another identifier while it is on", 0x1803, 1, entry.pack(0x40000000 | cob - 1))
    yield from _all_refused(node, refused)
    node.remote.tpdo.read()  # type: ignore[no-untyped-call]
    names = [each.name for each in node.remote.tpdo[4].map]
    yield equal("the client's library reads the mapping", names, ["6064h", "6077h"])
    node.remote.tpdo[4].save()
    yield equal("and writes it", node.number_of(0x1A03), 2)


def _all_refused(node: Node, acts: list[tuple[str, Callable[[], object]]]) -> Iterator[Finding]:
    for name, act in acts:
        code = node.abort(act)
        yield Finding(name=f"mapping refuses {name}", passed=code != 0, said=f"{code:08X}h")
    acts.clear()


def pdos(node: Node) -> Iterator[Finding]:
    """Check the mapped PDO: at each SYNC, at each second one, by its timer, and not before the node is started."""
    cob = 0x480 + node.number
    node.listen(cob)
    node.send(0x080, b"")
    node.read(0x1017)  # its answer comes after the frames of a SYNC
    yield equal("no PDO before operational", node.waiting(cob), 0)
    node.command(0x01)
    node.send(0x080, b"")
    yield equal("a PDO at SYNC", len(node.next(cob)), 6)
    node.write(0x1803, 2, b"\x02")
    node.forget(cob)
    for _ in range(6):
        node.send(0x080, b"")
    node.read(0x1017)
    yield equal("type 2: at each second SYNC", node.waiting(cob), 3)
    node.write(0x1803, 2, b"\xff")
    node.forget(cob)
    node.send(0x080, b"")
    node.read(0x1017)
    yield equal("type 255: not at SYNC", node.waiting(cob), 0)
    node.write(0x1803, 5, struct.pack("<H", 20))
    yield equal("type 255: by its timer", len(node.next(cob)), 6)
    node.write(0x1803, 1, struct.pack("<I", 0xC0000000 | cob))
    node.command(0x80)


def heartbeats(node: Node) -> Iterator[Finding]:
    """Check the heartbeat: it names the node's state. A stopped node answers no SDO."""
    identifier = 0x700 + node.number
    node.write(0x1017, 0, struct.pack("<H", 30))
    for command, state in ((0x01, 0x05), (0x80, 0x7F), (0x02, 0x04)):
        node.command(command)
        found = node.next(identifier, lambda frame, state=state: frame == bytes((state,)))  # type: ignore[misc]
        yield equal(f"heartbeat {state:02X}h after {command:02X}h", found, bytes((state,)))
    answers = 0x580 + node.number
    node.forget(answers)
    node.send(0x600 + node.number, b"\x40\x17\x10\x00" + bytes(4))
    node.forget(identifier)
    node.next(identifier)  # by then the node would have answered
    yield equal("no SDO while it is stopped", node.waiting(answers), 0)
    node.send(0, bytes((0x01, node.number ^ 0x7F or 1)))
    node.forget(identifier)
    yield equal("another node's command is not ours", node.next(identifier), b"\x04")
    node.command(0x80)
    node.write(0x1017, 0, bytes(2))


def emergencies(node: Node) -> Iterator[Finding]:
    """Check that a missing heartbeat is an emergency, and that the emergency is cleared when it returns."""
    identifier, beat = 0x080 + node.number, (0x700 + MASTER, b"\x05")
    node.listen(identifier)
    with contextlib.suppress(canopen.SdoAbortedError):
        node.write(
            0x2F21, 0, struct.pack("<H", 0x188)
        )  # Elmo sends only the emergencies that are enabled
    with contextlib.suppress(canopen.SdoAbortedError):
        node.write(0x6007, 0, bytes(2))  # the motor is off, and no failure may remain
    node.write(0x1016, 1, struct.pack("<HBB", 100, MASTER, 0))
    node.send(*beat)
    found = node.next(identifier)
    yield equal("emergency 8130h", found[:2].hex(), "3081")
    yield equal("the error register in it", node.number_of(0x1001), found[2] if found else -1)
    yield equal("communication's bit", node.number_of(0x1001) & 0x11, 0x11)
    yield equal("kept in 1003h", node.number_of(0x1003, 1) & 0xFFFF, 0x8130)
    node.send(*beat)
    yield equal("emergency 0000h when it is back", node.next(identifier), bytes(8))
    node.write(0x1016, 1, bytes(4))
    yield equal("no error left", node.number_of(0x1001), 0)
    node.write(0x1003, 0, b"\0")
    yield equal("history cleared", node.number_of(0x1003), 0)


def elmo(node: Node) -> Iterator[Finding]:
    """Check Elmo's interpreters: binary by PDO and by SDO, text by SDO."""
    reply = 0x280 + node.number
    node.listen(reply)
    node.command(0x01)
    node.send(0x300 + node.number, b"SR\0\0")
    yield equal("a reply by PDO", node.next(reply)[:4], b"SR\0\0")
    node.send(0x300 + node.number, b"TC\0\x80" + struct.pack("<f", 0.1))
    refused = node.next(reply)
    yield equal("TC is refused while the motor is off", refused[3:5].hex(), "403a")
    node.send(0x300 + node.number, b"QQ\0\0")
    yield equal("an unknown command is refused", node.next(reply)[3:5].hex(), "4002")
    node.forget(reply)
    node.write(0x2012, 0, b"UM\0\x40" + bytes(4))
    yield equal("a command by SDO", node.next(reply)[:2], b"UM")
    yield equal("its result by SDO", node.read(0x2013)[:2], b"UM")
    node.write(0x1023, 1, b"VR", segmented=True)
    yield equal("a text's status", node.number_of(0x1023, 2), 1)
    found = node.read(0x1023, 3)
    yield Finding(name="the version as a text", passed=len(found) > 4, said=repr(found))
    node.command(0x80)


CHECKS: tuple[Check, ...] = (
    *(mandatory, texts, aborts, segments, mapping, pdos, heartbeats, emergencies, elmo),
)


def equal(name: str, found: Any, wanted: Any, code: int | None = None) -> Finding:
    """Compare an answer. With a code, compare an SDO's answer: its first byte and its abort code."""
    if code is not None:
        passed = found[:1] == wanted and found[4:8] == struct.pack("<I", code)
        return Finding(name=name, passed=passed, said=found.hex() or "no answer")
    said = found.hex() if isinstance(found, bytes) else str(found)
    return Finding(name=name, passed=found == wanted, said=said or "nothing")


def findings(network: canopen.Network, number: int, *, plain: bool = False) -> Iterator[Finding]:
    """Run all checks on a node, and yield their results."""
    node = Node(network, number)
    node.listen(0x580 + number)
    node.listen(0x700 + number)
    node.command(0x82)
    yield equal("boot-up after a reset", node.next(0x700 + number, lambda _: True), b"\0")
    for check in CHECKS:
        if plain and check is elmo:
            continue
        try:
            yield from check(node)
        except (canopen.SdoAbortedError, canopen.SdoCommunicationError) as error:
            yield Finding(name=f"{check.__name__}: done to its end", passed=False, said=str(error))
    node.command(0x82)


@contextlib.contextmanager
def emulated() -> Iterator[tuple[str, str]]:
    """Run an emulated drive on a virtual bus, in a thread; yield interface and channel."""
    import jointid as jid
    from jointid.hardware import EmulatorThread
    from jointid.hardware.elmo import EmulatedElmo
    from jointid.simulation.stepped import stepped_joint

    channel = uuid.uuid4().hex
    friction = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
    joint = jid.thesis_joint().with_parameters(
        {**friction, "sensor_gain": 1.0, "sensor_offset": 0.0}
    )
    drive = EmulatedElmo(stepped_joint(joint, period=2e-3))
    with can.Bus(channel, interface="virtual") as there, EmulatorThread(there, drive):
        yield "virtual", channel


def main(arguments: list[str] | None = None) -> int:
    """Read the command line, test the node, print the results."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--emulate", action="store_true", help="test the emulated drive, without a real bus"
    )
    parser.add_argument("--interface", default="socketcan")
    parser.add_argument("--channel", default="can0")
    parser.add_argument("--bitrate", type=int, default=500_000)
    parser.add_argument("--node", type=int, default=127)
    parser.add_argument(
        "--plain", action="store_true", help="skip the checks of Elmo's own objects"
    )
    given = parser.parse_args(arguments)
    failed = total = 0
    with contextlib.ExitStack() as opened:
        where = (given.interface, given.channel)
        if given.emulate:
            where = opened.enter_context(emulated())
        network = canopen.Network()
        network.connect(interface=where[0], channel=where[1], bitrate=given.bitrate)
        opened.callback(network.disconnect)
        for found in findings(network, given.node, plain=given.plain):
            total += 1
            failed += not found.passed
            print("ok    " if found.passed else "FAILED", f"{found.name}: {found.said}")
    print(f"{total - failed} of {total} checks passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
