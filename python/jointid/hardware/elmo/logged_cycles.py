"""Reconstruct a session's cycles from its frames: the samples and the commanded currents."""

from __future__ import annotations

import math
from collections.abc import Iterable

from jointid.base.errors import InputError
from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.can.frame_log import LoggedFrame
from jointid.hardware.elmo.codec import Command, DriveError, Reply
from jointid.hardware.elmo.decoder import ElmoDecoder
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.timing import SyncWatch
from jointid.hardware.session.cycle import LoggedCycle
from jointid.joint.joint import Joint


class CycleReader:
    """Read frames in the order in which a session sent and received them.

    A cycle ends with our heartbeat, which follows each command. Before the first cycle heartbeats come alone.

    Parameters
    ----------
    joint : Joint
    options : ElmoOptions
    stamped : bool
        Whether the position frame's arrival time is exact and gives the sample time. Otherwise the SYNC gives it.
    rated_current : float
        The drive's CL[1] [A], used if the frames do not contain it; NaN: unknown.
    """

    def __init__(
        self, joint: Joint, options: ElmoOptions, *, stamped: bool, rated_current: float
    ) -> None:
        self._options = options
        constant = math.nan if joint.torque_constant is None else joint.torque_constant
        self._per_ampere = constant * joint.gear_ratio
        self._seen = ElmoDecoder(joint, options)
        self._seen.rated_current = rated_current
        self._ours = canopen.heartbeat_id(options.master_node)
        self._sent_by_us = {canopen.NMT, options.command_id, 0x600 + options.node, self._ours}
        self._watch = SyncWatch(options.bitrate, stamped=stamped)
        self._synced = math.nan
        self._commanded: float | None = None
        self._open = False
        self.cycles: list[LoggedCycle] = []

    def read(self, frames: Iterable[LoggedFrame]) -> None:
        """Read all frames of a log.

        Raises
        ------
        InputError
            Frames are missing.
        """
        for when, identifier, payload, extended, fd, _ in frames:
            if extended or fd:  # not CANopen: from another node
                continue
            if identifier == canopen.SYNC:
                self._begin(when)
                continue
            if identifier in self._sent_by_us:
                self._watch.own(when, len(payload))
            else:
                answers = identifier == self._options.position_id
                self._watch.came(when, len(payload), answers=answers)
            if identifier == self._options.command_id:
                self._take_command(payload)
            elif identifier == self._ours:
                self._end(when)
            elif identifier == self._options.reply_id:
                self._replied(payload)
            else:
                self._seen.take(identifier, payload)
        self._last()

    def _begin(self, when: float) -> None:
        self._last()  # the sample that ended a run, after which the joint was braked
        if self._open and self.cycles:  # in a run every SYNC has a command
            what = "command" if self._commanded is None else "host's heartbeat"
            raise InputError(self._missing(what, when))
        if not self._seen.complete:
            self._seen.forget()  # the session has dropped the last answer, too
        self._seen.begin()
        self._synced, self._commanded = when, None
        self._open = True
        self._watch.sent(when)

    def _take_command(self, payload: bytes) -> None:
        try:
            command = Command.of(payload)
        except InputError:
            return  # a command of another program
        if command.letters == "TC" and command.value is not None:
            self._commanded = float(command.value)

    def _replied(self, payload: bytes) -> None:
        try:
            reply = Reply.of(payload)
        except (DriveError, InputError):
            return  # the session's own recording holds the intended command
        if reply.letters == "AN":
            self._seen.take_voltage(float(reply.value))
        elif reply.key == ("CL", 1):
            self._seen.rated_current = float(reply.value)

    def _end(self, when: float) -> None:
        if not self.cycles and (not self._open or self._commanded is None):
            self._open = False  # the motor is being switched on: our heartbeat has started
            return
        if self._commanded is None:
            raise InputError(self._missing("command" if self._open else "", when))
        torque, self._commanded = self._per_ampere * self._commanded, None
        if self._open and self._seen.complete:
            self._keep(when, torque)
        else:  # the session held its torque, or a frame is missing: only its recording shows which
            what = f"{self._seen.lacking} that answers" if self._open else ""
            lost = self._missing(what, when)
            self.cycles.append(
                LoggedCycle(taken=math.nan, acted=when, position=math.nan, torque=torque, lost=lost)
            )
        self._open = False

    def _last(self) -> None:
        """Store the sample that ended the run. It has no command."""
        if self._open and self.cycles and self._seen.complete and self._commanded in (None, 0.0):
            self._keep(self._watch.sampled, self.cycles[-1].torque)
            self._open = False

    def _keep(self, acted: float, torque: float) -> None:
        self.cycles.append(
            LoggedCycle(
                taken=self._watch.sampled,
                acted=acted,
                position=self._seen.position,
                reading=self._seen.reading,
                current=self._seen.current,
                torque=torque,
            )
        )

    def _missing(self, what: str, when: float) -> str:
        link = "" if what.endswith("answers") else " that follows"
        missing = f"the {what}{link} the SYNC at {self._synced:.6f} s is missing"
        if not what:
            missing = f"the SYNC before the host's heartbeat at {when:.6f} s is missing"
        return f"{missing}, in cycle {len(self.cycles) + 1}; frames are missing from the log"
