"""The object dictionary of an emulated Elmo drive: objects of CiA 301, of CiA 402 and of Elmo.

Source: Elmo's CANopen DS 301 implementation guide (MAN-CAN301IG). Where it is silent: CiA 301 and 402.
"""

from __future__ import annotations

from jointid.hardware.elmo.emulated_interpreter import VERSION, Interpreter
from jointid.hardware.elmo.emulated_motor import ElmoMotor
from jointid.hardware.emulated.object_dictionary import (
    NOT_STORED,
    AccessError,
    Entry,
    ObjectDictionary,
    one_of,
    within,
)
from jointid.hardware.emulated.pdo import EVENT, OFF, Pdo, TransmitPdo
from jointid.hardware.emulated.sdo_server import SdoServer

VENDOR, PRODUCT, REVISION = 0x9A, 0x00030924, 0x01010301
_SERVO = 0x00020192  # 1000h: a servo drive after CiA 402
_NO_REMOTE = 0x40000000  # bit of a PDO's COB-ID: no remote frames
_TYPES_SENT = frozenset({*range(241), *EVENT})
_TYPES_RECEIVED = frozenset({1, *EVENT})
_WATCHED = 1  # largest number of watched heartbeats
_SIGNATURES = {0x1010: 0x65766173, 0x1011: 0x64616F6C}  # "save", "load"
_BINARY_RESULT = 0x80000000  # bit of 2F20h:2: send TPDO2 after each executed command
# Objects of CiA 402 that only store a value, because the binary interpreter moves this drive.
_MODES = (-1, 1, 3, 4, 6)


class ElmoObjects(ObjectDictionary):
    """Objects of one drive and their functions.

    Parameters
    ----------
    motor : ElmoMotor
    interpreter : Interpreter
    """

    def __init__(self, motor: ElmoMotor, interpreter: Interpreter) -> None:
        super().__init__()
        self._motor, self._interpreter = motor, interpreter
        self._server = SdoServer(self)
        self.result = bytes(8)  # 2013h: result of the binary interpreter
        self._identify()
        self._watch()
        self._measure()
        self._control()
        node, settings = motor.settings.node, motor.settings
        # The interpreter's frames may have other identifiers than the defaults of the node.
        received = [OFF | 0x200 + node, settings.command_id, OFF | 0x400 + node, OFF | 0x500 + node]
        sent = [OFF | 0x180 + node, settings.reply_id, OFF | 0x380 + node, OFF | 0x480 + node]
        taken = [(0x60400010,), (0x20120040,), (), ()]
        given = [(0x60410010,), (0x20130040,), (), ()]
        self.received = [
            Pdo(
                *(self, 0x1400 + k, 0x1600 + k),
                cob=received[k],
                mapped=taken[k],
                types=_TYPES_RECEIVED,
                sent=False,
            )
            for k in range(4)
        ]
        self.sent = [
            TransmitPdo(
                *(self, 0x1800 + k, 0x1A00 + k),
                cob=_NO_REMOTE | sent[k],
                mapped=given[k],
                types=_TYPES_SENT,
                sent=True,
            )
            for k in range(4)
        ]

    def reset(self) -> None:
        """Restore the state after power-up. A reset of the communication does the same."""
        super().reset()
        self._server.forget()
        for pdo in (*self.received, *self.sent):
            pdo.reset()

    def answer(self, payload: bytes) -> bytes | None:
        """Return the answer to an SDO frame; None if it needs no answer."""
        return self._server.answer(payload)

    @property
    def master(self) -> int:
        """Node with the watched heartbeat."""
        return self.value(0x1016, 1) >> 16 & 0x7F

    @property
    def consumer_time(self) -> float:
        """Longest allowed gap of that heartbeat [s]; 0: no limit."""
        return (self.value(0x1016, 1) & 0xFFFF) * 1e-3 if self.master else 0.0

    @property
    def producer_time(self) -> float:
        """Time between two heartbeats of the drive [s]; 0: it sends none."""
        return self.value(0x1017, 0) * 1e-3

    def replies(self, number: int) -> bool:
        """Return whether a PDO, counted from 0, is sent when the interpreter has a result."""
        return bool(self.value(0x2F20, number + 1) & _BINARY_RESULT)

    def number(self, index: int, subindex: int) -> int:
        """Return the value of a numeric object."""
        entry = self.entry(index, subindex)
        return int.from_bytes(self.read(index, subindex), "little", signed=entry.signed)

    def emergency_wanted(self, bit: int) -> bool:
        """Return whether 2F21h enables the emergency of an event."""
        return bool(self.value(0x2F21, 0) >> bit & 1)

    # The entries.

    def _identify(self) -> None:
        serial = self._motor.settings.serial
        self.constant(0x1000, 0, 4, _SERVO)
        self.variable(0x1005, 0, 4, 0x80, check=one_of(0x80))
        for index, text in ((0x1008, "Cello"), (0x1009, "emulated"), (0x100A, VERSION)):
            self.add(index, 0, Entry(size=0, read=lambda text=text: text.encode("ascii")))  # type: ignore[misc]
        for index, signature in _SIGNATURES.items():
            self.constant(index, 0, 1, 1)
            self.add(
                *(index, 1),
                Entry(size=4, read=lambda: 1, write=lambda v, s=signature: _signed(v, s)),  # type: ignore[misc]
            )
        self.constant(0x1018, 0, 1, 4)
        for subindex, number in enumerate((VENDOR, PRODUCT, REVISION, serial), start=1):
            self.constant(0x1018, subindex, 4, number)
        self.constant(0x1200, 0, 1, 2)
        self.constant(0x1200, 1, 4, 0x600 + self._motor.settings.node)
        self.constant(0x1200, 2, 4, 0x580 + self._motor.settings.node)

    def _watch(self) -> None:
        settings = self._motor.settings
        self.constant(0x1016, 0, 1, _WATCHED)
        self.variable(0x1016, 1, 4, check=within(0, 0xFFFFFF))  # node and time
        self.variable(0x1017, 0, 2)
        self.constant(0x1029, 0, 1, 1)
        self.variable(0x1029, 1, 1, settings.error_behaviour, check=one_of(0, 1, 2))
        self.variable(*(0x6007, 0, 2, settings.abort_option), signed=True, check=one_of(0, 1, 2, 3))
        self.constant(0x2F20, 0, 1, 4)
        for subindex in range(1, 5):
            default = _BINARY_RESULT if subindex == 2 else 0
            self.variable(0x2F20, subindex, 4, default)
        self.variable(0x2F21, 0, 2, settings.emergency_events, check=within(0, 0x3FF))

    def _measure(self) -> None:
        motor = self._motor

        def measured(index: int, size: int, read: object, *, signed: bool = True) -> None:
            self.add(index, 0, Entry(size=size, signed=signed, read=read, sent=True))  # type: ignore[arg-type]

        measured(0x6041, 2, motor.power.status, signed=False)
        measured(0x6064, 4, lambda: motor.counts())  # faults replace `counts`
        for index in (0x6069, 0x606B, 0x606C):
            measured(index, 4, lambda: motor.speed())
        for index in (0x6074, 0x6077, 0x6078):  # torque: commanded, measured; current: measured
            measured(index, 2, motor.share_of_rated)
        measured(0x6079, 4, lambda: round(1e3 * motor.settings.supply), signed=False)
        self.add(0x6075, 0, Entry(size=4, read=lambda: round(1e3 * motor.rated_current)))
        self.add(0x6076, 0, Entry(size=4, read=lambda: round(1e3 * motor.rated_torque)))
        self.constant(0x6502, 0, 4, 0x2D)  # profile position, velocity, torque; homing

    def _control(self) -> None:
        motor = self._motor
        self.add(
            *(0x6040, 0),
            Entry(
                size=2,
                read=lambda: motor.power.word,
                write=motor.power.control,
                received=True,
            ),
        )
        self.variable(0x6060, 0, 1, -1, signed=True, check=one_of(*_MODES))
        self.add(
            0x6061, 0, Entry(size=1, signed=True, read=lambda: self.value(0x6060, 0), sent=True)
        )
        # The text interpreter: command, status, reply (1023h).
        self.constant(0x1023, 0, 1, 3)
        self.add(
            *(0x1023, 1),
            Entry(size=0, write_bytes=self._interpreter.take_text),
        )
        self.add(0x1023, 2, Entry(size=1, read=lambda: self._interpreter.text_status))
        self.add(0x1023, 3, Entry(size=0, read=lambda: self._interpreter.text))
        self.add(0x2012, 0, Entry(size=8, write_bytes=self._interpreter.take, received=True))
        self.add(0x2013, 0, Entry(size=8, read=lambda: self.result, sent=True))


def _signed(value: int, signature: int) -> None:
    """Refuse to store or restore without the signature. With it nothing changes, because nothing is stored here."""
    if value != signature:
        raise AccessError(NOT_STORED)
