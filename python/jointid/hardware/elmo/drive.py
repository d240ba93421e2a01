"""An Elmo SimplIQ drive over CAN: connect, command current, switch off."""

from __future__ import annotations

import math
import struct
from typing import Any

import can

from jointid.base.errors import InputError
from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.can.wire_time import bits_on_wire
from jointid.hardware.elmo import registers
from jointid.hardware.elmo import setup as elmo_setup
from jointid.hardware.elmo.codec import Command
from jointid.hardware.elmo.decoder import ElmoDecoder
from jointid.hardware.elmo.errors import DriveStatus
from jointid.hardware.elmo.link import ElmoLink, Tap
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.recorded_options import elmo_options_document
from jointid.hardware.elmo.report import elmo_report
from jointid.hardware.elmo.silence import fall_silent
from jointid.hardware.elmo.start_problems import IN_USE, reasons_not_to_start
from jointid.hardware.elmo.switching import CYCLES, OFF, MotorSwitch
from jointid.hardware.elmo.timing import command_latency
from jointid.hardware.elmo.torque_source import AnalogInput, SyncedConverter
from jointid.hardware.session.clock import Clock
from jointid.hardware.session.drive import DriveEnd, DriveFaultError, DriveSample
from jointid.hardware.session.drive_report import DriveReport, Reported
from jointid.hardware.session.silence import DriveSilence
from jointid.joint.joint import Joint

_BOOT = 2.0  # [s] to wait for the boot-up message
_UNIT_MODE = 0.5  # [s] that a change of the unit mode may take
_IN_USE_ANSWER = 0.02  # [s] for an answer before the reset: only a drive in use answers
_UNREAD = 3  # questions to the sensor without an answer
_LOST = 1.5  # periods after which a missing answer to a SYNC counts as lost
_LEAST = 0.25  # share of the time for an answer below which none would arrive in time


class ElmoDrive:
    """A `Drive` on a CAN bus.

    Parameters
    ----------
    bus : can.BusABC
        Stays open after `close`.
    joint : Joint
        The joint; needs gear ratio and torque constant.
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
                "missing, so no torque can be commanded; state torque_constant under [drive] of the joint file",
                argument="torque_constant",
            )
        self.joint = joint
        self.options = options if options is not None else ElmoOptions()
        self.watchdog = self.options.watchdog
        self._seen = ElmoDecoder(joint, self.options)
        self._link = ElmoLink(bus, self.options, self._seen, clock)
        self._per_ampere = joint.torque_constant * joint.gear_ratio
        self._command_id = self.options.command_id
        self._switch = MotorSwitch(self._link, self.options)
        self._asked = 0.0
        self._given_up = -math.inf
        self._cycle = 0
        self._read = self._unread = self._unheard = 0
        self._period = 0.002
        self._found_off = False
        self._identity: dict[str, Any] = {
            "drive": "Elmo SimplIQ",
            "node": self.options.node,
            "master": self.options.master_node,
            "stamped_frames": self._link.stamped,
        }
        self._described: tuple[Reported, ...] = ()
        self._limits: tuple[Reported, ...] = ()
        self._peak = math.inf
        self._most_current = joint.limits.current

    @property
    def clock(self) -> Clock:
        """Clock of the sample times."""
        return self._link.clock

    @property
    def tap(self) -> Tap | None:
        """Callable that receives each frame: time, identifier, payload, whether it was sent."""
        return self._link.tap

    @tap.setter
    def tap(self, tap: Tap | None) -> None:
        self._link.tap = tap

    @property
    def resolution(self) -> float:
        """Joint angle per encoder count [rad]."""
        return self.options.resolution(self.joint)

    def identity(self) -> dict[str, Any]:
        """Identity that the drive reports, and problems of the frames on its bus."""
        found = dict(self._identity)
        if self._link.echoes.lost:
            found["lost_echoes"] = self._link.echoes.lost
        if self._link.foreign.frames:
            found["foreign_frames"] = list(self._link.foreign.frames)
        return found

    def report(self) -> DriveReport:
        """Return the drive's identity, settings and present state; connected, motor off.

        Raises
        ------
        DriveFaultError
            The drive does not answer, or sends no position.
        """
        sample = self.read(0.1)
        speed = self._link.number("VX")
        return elmo_report(
            self._link,
            self.options,
            identity=self._described,
            settings=self._limits,
            sample=sample,
            velocity=math.nan if speed is None else speed * self.options.per_count(self.joint),
        )

    def metadata(self) -> dict[str, Any]:
        """Drive type and options, which a replay of the frame log needs."""
        return {"drive_type": "elmo", "drive_options": elmo_options_document(self.options)}

    def connect(self, period: float) -> None:
        """Reset the drive's communication, map its PDOs and arm the watchdogs; motor off, torque mode.

        Listen first: do not change a drive whose motor is on or that another program commands.
        """
        link, node = self._link, self.options.node
        if period > CYCLES * self.options.heartbeat:
            raise DriveFaultError(
                "drive_fault",
                f"a period of {1e3 * period:g} ms is too long: each cycle sends the heartbeat, and the drive expects "
                f"one every {1e3 * self.options.heartbeat:g} ms; the period must be at most a third of this time",
            )
        self._period, self._cycle = period, 0
        self._found_off = link.up = False
        self._switch.forget()
        self._given_up = -math.inf
        self._read = self._unheard = self._seen.readings
        self._unread = -1
        link.drain(0.01)
        self._seen.forget()
        link.forget_fault(but="bus")
        link.listen(self.options.listen)
        self._refuse_if_motor_on(_IN_USE_ANSWER)
        link.foreign.decide()
        link.raise_foreign()
        link.alone.begin()
        link.forget_fault(but="bus")
        link.send(canopen.NMT, canopen.network(canopen.RESET_COMMUNICATION, node))
        link.wait(
            lambda: link.alone.booted,
            _BOOT,
            f"no boot-up message from node {node}",
            advice="; check that the drive is on, and that its node number is right",
        )
        self._described = registers.identity(link)
        self._identity |= {each.meaning: each.value for each in self._described}
        elmo_setup.map_position(link, self.options)
        elmo_setup.arm_watchdogs(link, self.options)
        link.send(canopen.NMT, canopen.network(canopen.START, node))
        self._refuse_if_motor_on()
        self._found_off = True
        for command in (OFF, Command(letters="RM", value=0), Command(letters="UM", value=1)):
            link.ask(command)
        end = link.clock.now() + _UNIT_MODE
        while self._status().unit_mode != 1 and link.clock.now() < end:
            link.clock.sleep_until(link.clock.now() + 0.02)
        self._peak = float(link.ask(Command(letters="PL", index=1)).value)
        rated = float(link.ask(Command(letters="CL", index=1)).value)
        self._seen.rated_current = rated
        self._limits = registers.limits(link, self.resolution)
        self._identity |= {
            "peak_current": self._peak,
            "continuous_current": rated,
            "limits": {each.name: each.value for each in self._limits},
        }
        link.heard = link.clock.now()
        link.up = True

    def problems(self, torque_limit: float) -> list[str]:
        """Return reasons not to enable the motor."""
        return reasons_not_to_start(
            self._link,
            self.options,
            peak=self._peak,
            allowed_current=self._most_current,
            allowed_torque=torque_limit,
            per_ampere=self._per_ampere,
        )

    def enable(self) -> None:
        """Switch the motor on at zero torque. Our heartbeat starts before, so the drive's watchdog is active."""
        self._switch.on()

    def read(self, timeout: float) -> DriveSample:
        """Send a SYNC and read position, current and torque sensor."""
        link, seen = self._link, self._seen
        end = link.clock.now() + timeout
        link.read_waiting()
        self._settle(timeout)
        asked = self._asked = link.clock.now()
        if end - asked < _LEAST * timeout:
            raise DriveFaultError(
                "stale_position",
                f"the answer to the last SYNC was late; none of the {1e3 * timeout:g} ms is left to wait for the "
                "next answer",
                measured=asked - end + timeout,
                allowed=timeout,
            )
        seen.begin()
        link.watch.sent(link.send(canopen.SYNC, b""))
        source = self.options.torque
        self._ask_analog_in_turn()
        self._cycle += 1
        self._answered(end - asked)
        self._look_alive()
        link.echoes.check()
        return DriveSample(
            time=link.watch.sampled,
            position=seen.position,
            reading=seen.reading,
            fresh=seen.fresh or source is None,
            clipped=seen.clipped,
            current=seen.current,
            torque=seen.current * self._per_ampere,
            confirmed=link.echoes.confirmed,
        )

    def command(self, torque: float) -> float:
        """Send a torque command and our heartbeat."""
        current = max(-self._peak, min(self._peak, torque / self._per_ampere))
        kept = self._kept(current)
        self._link.send(self._command_id, Command(letters="TC", value=kept).payload())
        self._link.echoes.sent(kept)
        self._switch.beat()
        return kept * self._per_ampere

    def _kept(self, current: float) -> float:
        """Return the part of a current command that the drive keeps [A]; never more than the command."""
        if self.options.mantissa_bits < 24:
            mantissa, exponent = math.frexp(current)
            steps = math.trunc(math.ldexp(mantissa, self.options.mantissa_bits))
            return math.ldexp(steps, exponent - self.options.mantissa_bits)
        return float(struct.unpack("<f", struct.pack("<f", current))[0])

    def disable(self) -> DriveEnd:
        """Send TC = 0, then MO = 0, until the drive confirms that its motor is off; then use SDO and NMT stop.

        A drive that cannot be reached stops on its own watchdog, because our heartbeat is missing.
        """
        if not self._found_off:
            return DriveEnd()  # another program moves its motor
        return self._switch.off(self._period)

    def fall_silent(self) -> DriveSilence:
        """Stop our heartbeat while the motor is on and observe the drive's watchdog. Its failure stays in the drive."""
        return fall_silent(self._link, self.options, self._switch)

    def close(self) -> None:
        """Leave the drive pre-operational. Disarm its watchdogs when its motor is off.

        If another program commands the drive, stop the drive: its motor is switched off and it accepts no
        more commands.
        """
        link = self._link
        link.up = False
        if not self._found_off:
            return
        link.forget_fault()
        try:
            link.drain(0.01)
            link.forget_fault()
            if self._switch.seen_off:
                elmo_setup.disarm_watchdogs(link)
            link.send(canopen.NMT, canopen.network(canopen.PRE_OPERATIONAL, self.options.node))
            link.drain(0.01)
            if (
                link.foreign.frames
            ):  # by now the drive has executed the other program's waiting command
                link.send(canopen.NMT, canopen.network(canopen.STOP, self.options.node))
                link.drain(0.01)
        except DriveFaultError:
            return
        finally:
            self._found_off = False  # from now on another program may use the drive
            self._switch.forget()

    @property
    def command_latency(self) -> float:
        """Estimate the delay from sending a command until the drive acts on it [s]."""
        return command_latency(self.options)

    def bus_load(self, period: float) -> float:
        """Return the share of the bus load: SYNC, position, command with echo, both heartbeats, sensor."""
        bits = bits_on_wire
        total = bits(0) + 3 * bits(8) + bits(1) * (1.0 + period / self.options.drive_heartbeat)
        if isinstance(self.options.torque, SyncedConverter):
            total += bits(4)
        elif isinstance(self.options.torque, AnalogInput):
            total += (bits(4) + bits(8)) / self.options.torque.every
        return total / (self.options.bitrate * period)

    def _refuse_if_motor_on(self, timeout: float | None = None) -> None:
        """Raise if the motor is on, before anything is changed. A drive that does not answer is not in use."""
        if timeout is None:
            on = self._status().motor_on
        else:
            register = self._link.number("SR", timeout)
            on = register is not None and DriveStatus.of(int(register)).motor_on
        if on:
            raise DriveFaultError("drive_fault", IN_USE)

    def _status(self) -> DriveStatus:
        return DriveStatus.of(int(self._link.ask(Command(letters="SR")).value))

    def _ask_analog_in_turn(self) -> None:
        """Query the torque sensor every few cycles. The answer may take some cycles, but not many."""
        source = self.options.torque
        if not isinstance(source, AnalogInput) or self._cycle % source.every:
            return
        self._unread = self._unread + 1 if self._seen.readings == self._read else 0
        self._read = self._seen.readings
        if self._unread > _UNREAD:
            raise DriveFaultError(
                "sensor",
                f"the drive did not answer {self._unread} consecutive queries of its analog input {source.number}",
                measured=self._unread,
                allowed=_UNREAD,
            )
        self._link.command(Command(letters="AN", index=source.number))

    def _look_alive(self) -> None:
        """Check the drive's heartbeat after the answer to a SYNC, because earlier heartbeats have been read by then."""
        silent = self._link.clock.now() - self._link.heard
        if silent > self.options.heartbeat:
            raise DriveFaultError(
                "heartbeat_lost",
                f"the drive's heartbeat has been missing for {1e3 * silent:.0f} ms, more than "
                f"{1e3 * self.options.heartbeat:g} ms",
                measured=silent,
                allowed=self.options.heartbeat,
            )

    def _answered(self, timeout: float) -> None:
        seen, missing = self._seen, "no answer to the SYNC"
        self._link.wait(lambda: seen.complete, timeout, missing, kind="stale_position")
        if isinstance(self.options.torque, AnalogInput) and seen.readings == self._unheard:
            missing = "no reply to AN"
            self._link.wait(lambda: seen.readings > self._unheard, timeout, missing, kind="sensor")

    def _settle(self, timeout: float) -> None:
        """Wait for the answer to the last SYNC before the next SYNC, because an answer does not name its SYNC.

        Give up a missing answer after one more period. If it arrives later, it is taken for the answer to the
        next SYNC. The true answer to that SYNC is then one too many, which is a fault too.
        """
        seen, now = self._seen, self._link.clock.now()
        if seen.surplus and now - self._given_up < self.options.heartbeat:
            seen.surplus = 0
            raise DriveFaultError(
                "stale_position",
                "an answer to a SYNC was so late that it was taken for the answer to the next SYNC",
            )
        seen.surplus = 0
        if seen.complete:
            return
        if now - self._asked > _LOST * self._period:
            seen.forget()
            self._given_up = now
        else:
            self._answered(timeout)
