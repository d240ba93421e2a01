"""Wiring and addresses of an Elmo drive."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from jointid.base.errors import InputError
from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.torque_source import AnalogInput, SyncedConverter
from jointid.hardware.session.watchdog import Watchdog
from jointid.joint.joint import Joint


@dataclass(frozen=True, slots=True, kw_only=True)
class ElmoOptions:
    """Wiring and addresses of a drive.

    Attributes
    ----------
    node : int
        The drive's node, 1 to 127.
    counts_per_turn : int
        Encoder counts per motor revolution.
    position_offset : float
        Joint angle at encoder count 0 [rad].
    cob_command, cob_reply, cob_position : int, optional
        COB-IDs of interpreter commands, of replies and of the position's PDO. Default: 0x300, 0x280 and
        0x480, plus the node.
    master : int, optional
        The session's own node, 1 to 127; the drive watches its heartbeat. No other device on the bus may
        use it. Default: 1, or 2 if the drive is node 1.
    listen : float
        Time to listen for another master before the first frame is sent [s].
    heartbeat : float
        The drive stops after this time without the session's heartbeat. The session stops after this time
        without the drive's heartbeat [s].
    drive_heartbeat : float
        Time between two heartbeats of the drive [s]; at most half of `heartbeat`.
    acknowledge : bool
        Start even if the drive still reports an earlier failure. Enabling clears it.
    torque : SyncedConverter, AnalogInput or None
        Source of the joint's torque sensor signal.
    bitrate : float
        Bit rate of the bus [bit/s], used to estimate its load.
    execution_delay : float
        Delay from a command's arrival until the drive's idle loop acts on it [s].
    mantissa_bits : int
        Bits of a current command that the drive keeps: 24 for a float, 4 over the thesis's link. Commands are
        rounded to them.
    """

    node: int = 127
    counts_per_turn: int = 8000
    position_offset: float = 0.0
    cob_command: int | None = None
    cob_reply: int | None = None
    cob_position: int | None = None
    master: int | None = None
    listen: float = 0.25
    heartbeat: float = 0.05
    drive_heartbeat: float = 0.02
    acknowledge: bool = False
    torque: SyncedConverter | AnalogInput | None = field(default_factory=SyncedConverter)
    bitrate: float = 500_000.0
    execution_delay: float = 0.3e-3
    mantissa_bits: int = 24

    def __post_init__(self) -> None:
        if not 10e3 <= self.bitrate <= 1e6:
            raise InputError(
                "10 000 to 1 000 000 bit/s is expected", argument="bitrate", value=self.bitrate
            )
        if not 0.0 <= self.execution_delay <= 0.1:
            raise InputError(
                "0 to 0.1 s is expected", argument="execution_delay", value=self.execution_delay
            )
        if not math.isfinite(self.position_offset):
            raise InputError(
                "a finite angle is expected", argument="position_offset", value=self.position_offset
            )
        self._check_identifiers()
        if not 1 <= self.mantissa_bits <= 24:
            raise InputError(
                "1 to 24 is expected", argument="mantissa_bits", value=self.mantissa_bits
            )
        if not 1 <= self.node <= 127:
            raise InputError("1 to 127 is expected", argument="node", value=self.node)
        if not 1 <= self.master_node <= 127 or self.master == self.node:
            raise InputError(
                f"1 to 127 is expected, other than the drive's node {self.node}",
                argument="master",
                value=self.master,
            )
        if not 0.0 <= self.listen <= 60.0:
            raise InputError("0 to 60 s is expected", argument="listen", value=self.listen)
        if self.counts_per_turn < 1:
            raise InputError(
                "at least 1 is expected", argument="counts_per_turn", value=self.counts_per_turn
            )
        if not 0.005 <= self.heartbeat <= 10.0:
            raise InputError(
                "0.005 to 10 s is expected", argument="heartbeat", value=self.heartbeat
            )
        if not 0.001 <= self.drive_heartbeat <= 0.5 * self.heartbeat:
            raise InputError(
                f"0.001 s to {0.5 * self.heartbeat:g} s (half of heartbeat) is expected",
                argument="drive_heartbeat",
                value=self.drive_heartbeat,
            )

    def _check_identifiers(self) -> None:
        used = {
            "cob_command": self.command_id,
            "cob_reply": self.reply_id,
            "cob_position": self.position_id,
        }
        if isinstance(self.torque, SyncedConverter):
            used["identifier"] = self.torque.identifier
        for name, identifier in used.items():
            if not 0x81 <= identifier <= 0x7FF:
                raise InputError(
                    f"0x{identifier:X} is not a valid identifier; 0x081 to 0x7FF is expected",
                    argument=name,
                )
        for name, identifier in used.items():
            others = [
                other for other, value in used.items() if value == identifier and other != name
            ]
            if others:
                raise InputError(
                    f"{name} and {others[0]} are both 0x{identifier:X}; each frame needs its own identifier",
                    argument=name,
                )

    @property
    def watchdog(self) -> Watchdog:
        """Reaction of the drive to a missing heartbeat. `connect` reads it back, and refuses a drive that differs."""
        return Watchdog(time=self.heartbeat, fed_by="heartbeat", then="off", read_back=True)

    @property
    def command_id(self) -> int:
        """COB-ID of interpreter commands."""
        return self.cob_command if self.cob_command is not None else 0x300 + self.node

    @property
    def reply_id(self) -> int:
        """COB-ID of interpreter replies."""
        return self.cob_reply if self.cob_reply is not None else 0x280 + self.node

    @property
    def position_id(self) -> int:
        """COB-ID of the PDO with the position."""
        return self.cob_position if self.cob_position is not None else 0x480 + self.node

    @property
    def master_node(self) -> int:
        """Our node: `master`, or by default the first that is not the drive's."""
        if self.master is not None:
            return self.master
        return 2 if self.node == 1 else 1

    @property
    def answering(self) -> tuple[int, ...]:
        """COB-IDs that the drive and the sensor send: replies, position, emergency, boot-up, SDO, sensor."""
        found = [
            self.reply_id,
            self.position_id,
            canopen.emergency_id(self.node),
            canopen.heartbeat_id(self.node),
            0x580 + self.node,
        ]
        if isinstance(self.torque, SyncedConverter):
            found.append(self.torque.identifier)
        return tuple(sorted(set(found)))

    @property
    def commanding(self) -> tuple[int, ...]:
        """COB-IDs that only a master of this drive sends: NMT, SYNC, the drive's RPDOs and SDO, our heartbeat."""
        found = {canopen.NMT, canopen.SYNC, self.command_id, 0x600 + self.node}
        found |= {0x200 + self.node, 0x400 + self.node, 0x500 + self.node}
        found.add(canopen.heartbeat_id(self.master_node))
        return tuple(sorted(found - set(self.answering)))

    @property
    def received(self) -> tuple[int, ...]:
        """COB-IDs of the frames that a session receives: the drive's, the sensor's, and another master's."""
        return tuple(sorted({*self.answering, *self.commanding}))

    def resolution(self, joint: Joint) -> float:
        """Return the joint angle per encoder count [rad]."""
        return 2.0 * math.pi / abs(self.counts_per_turn * joint.gear_ratio)

    def per_count(self, joint: Joint) -> float:
        """Return the joint angle per encoder count, with its sign [rad]."""
        return 2.0 * math.pi / (self.counts_per_turn * joint.gear_ratio)

    def angle(self, counts: int, joint: Joint) -> float:
        """Return the joint angle of encoder counts [rad]."""
        per_turn = self.counts_per_turn * joint.gear_ratio
        return counts * (2.0 * math.pi / per_turn) + self.position_offset
