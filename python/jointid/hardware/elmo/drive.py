"""An Elmo SimplIQ drive over CAN: brought up, driven by current, shut down."""

from __future__ import annotations

import math
import struct
from typing import Any

import can

from jointid.base.errors import InputError
from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo import setup as elmo_setup
from jointid.hardware.elmo.codec import Command
from jointid.hardware.elmo.decoder import ElmoDecoder
from jointid.hardware.elmo.errors import DriveStatus, failure_meaning
from jointid.hardware.elmo.link import ElmoLink, Tap
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.recorded_options import elmo_options_document
from jointid.hardware.elmo.timing import command_latency
from jointid.hardware.elmo.torque_source import AnalogInput, SyncedConverter
from jointid.hardware.session.clock import Clock
from jointid.hardware.session.drive import DriveEnd, DriveFaultError, DriveSample
from jointid.joint.joint import Joint

_BOOT, _ENABLE = 2.0, 3.0  # [s] to wait for each
_UNIT_MODE = 0.5  # [s] that changing it may take
_CYCLES = 1.0 / 3.0  # of the time that the drive waits for a heartbeat: one may be lost
_IN_USE_ANSWER = (
    0.02  # [s] for an answer before the drive is reset: only one that is in use gives one
)
_SEEN_OFF = 0.2  # [s] that switching off is tried for, at most
_SOON = 3  # times that switching off is repeated in the next cycle
_LOST = 1.5  # periods after which an answer is lost, not late: one cycle is spent waiting for it
_UNREAD = 3  # questions for the sensor without an answer
_ZERO, _OFF = Command(letters="TC", value=0.0), Command(letters="MO", value=0)
_IN_USE = "the motor is on already: another program commands the drive; switch the motor off there"


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
                "missing, so no torque can be commanded; it stands in the joint file under [drive]",
                argument="torque_constant",
            )
        self.joint = joint
        self.options = options if options is not None else ElmoOptions()
        self._seen = ElmoDecoder(joint, self.options)
        self._link = ElmoLink(bus, self.options, self._seen, clock)
        self._per_ampere = joint.torque_constant * joint.gear_ratio
        self._command_id = self.options.command_id
        self._heartbeat_id = canopen.heartbeat_id(self._link.master)
        self._asked = 0.0
        self._cycle = 0
        self._read = self._unread = self._unheard = 0
        self._period = 0.002
        self._found_off = self._seen_off = False
        self._failure = ""
        self._identity: dict[str, Any] = {
            "drive": "Elmo SimplIQ",
            "node": self.options.node,
            "stamped_frames": self._link.stamped,
        }
        self._peak = math.inf
        self._most_current = joint.limits.current

    @property
    def clock(self) -> Clock:
        """What the samples are stamped by."""
        return self._link.clock

    @property
    def tap(self) -> Tap | None:
        """Called with each frame: time, identifier, payload, whether it was sent."""
        return self._link.tap

    @tap.setter
    def tap(self, tap: Tap | None) -> None:
        self._link.tap = tap

    @property
    def resolution(self) -> float:
        """Output angle of an encoder count [rad]."""
        return self.options.resolution(self.joint)

    def identity(self) -> dict[str, Any]:
        """What the drive reported about itself."""
        return dict(self._identity)

    def metadata(self) -> dict[str, Any]:
        """What a replay of the frame log needs: drive type and options."""
        return {"drive_type": "elmo", "drive_options": elmo_options_document(self.options)}

    def connect(self, period: float) -> None:
        """Reset the drive's communication, map its PDOs, arm the watchdogs; motor off, torque mode.

        A drive whose motor is on is not changed: another program moves it.
        """
        link, node = self._link, self.options.node
        if period > _CYCLES * self.options.heartbeat:
            raise DriveFaultError(
                "drive_fault",
                f"a period of {1e3 * period:g} ms is too long for a heartbeat awaited every "
                f"{1e3 * self.options.heartbeat:g} ms, which each cycle sends; at most a third of it is expected",
            )
        self._period, self._cycle = period, 0
        self._found_off = self._seen_off = link.up = False
        self._failure = ""
        self._read = self._unheard = self._seen.readings
        self._unread = -1
        link.drain(0.01)
        self._seen.forget()
        self._refuse_if_motor_on(_IN_USE_ANSWER)
        link.booted = False
        link.forget_fault(but="bus")
        link.send(canopen.NMT, canopen.network(canopen.RESET_COMMUNICATION, node))
        link.wait(
            lambda: link.booted,
            _BOOT,
            f"no boot-up message from node {node}",
            advice="; check that the drive is on, and that this is its node",
        )
        self._identity |= elmo_setup.identity(link)
        elmo_setup.map_position(link, self.options)
        elmo_setup.arm_watchdogs(link, self.options)
        link.send(canopen.NMT, canopen.network(canopen.START, node))
        self._refuse_if_motor_on()
        self._found_off = True
        for command in (_OFF, Command(letters="RM", value=0), Command(letters="UM", value=1)):
            link.ask(command)
        end = link.clock.now() + _UNIT_MODE
        while self._status().unit_mode != 1 and link.clock.now() < end:
            link.clock.sleep_until(link.clock.now() + 0.02)
        self._peak = float(link.ask(Command(letters="PL", index=1)).value)
        rated = float(link.ask(Command(letters="CL", index=1)).value)
        self._seen.rated_current = rated
        self._identity |= {"peak_current": self._peak, "continuous_current": rated}
        link.heard = link.clock.now()
        link.up = True

    def problems(self, torque_limit: float) -> list[str]:
        """Reasons not to enable the motor."""
        reasons = []
        if not math.isfinite(torque_limit):
            reasons.append(
                "the session has no torque limit; give one in [limits] or [session.limits]"
            )
        if not self._peak > 0.0:
            reasons.append(
                f"the drive's peak current PL[1] is {self._peak:g} A; more than 0 is expected"
            )
        allowed = torque_limit / abs(self._per_ampere)
        if self._most_current is not None:
            allowed = min(allowed, self._most_current)
        if self._peak > allowed * (1.0 + 1e-6):
            reasons.append(
                f"the drive's peak current PL[1] is {self._peak:g} A, the session allows {allowed:.4g} A; "
                "set PL[1] down, or the session's torque limit or the joint's current limit up"
            )
        status = self._status()
        if status.problem:
            reasons.append(f"the drive reports {status.problem}")
        if status.failure and not self.options.acknowledge:
            meaning = failure_meaning(int(self._link.ask(Command(letters="MF")).value))
            reasons.append(
                f"the drive has shut its motor down before ({meaning or 'MF is 0'}); when that is "
                "fixed, start with acknowledge = true"
            )
        if status.unit_mode != 1:
            reasons.append(
                f"the drive is in unit mode {status.unit_mode}, not in torque mode (UM=1)"
            )
        if status.motor_on:
            reasons.append(_IN_USE)
        return reasons

    def enable(self) -> None:
        """Motor on, at zero torque, and watched: our heartbeat begins before the motor is on."""
        link = self._link
        self._seen_off = False
        self._beat()
        link.ask(Command(letters="MO", value=1))
        end = link.clock.now() + _ENABLE
        while not self._status().motor_on:
            self._beat()
            if link.clock.now() > end:
                raise DriveFaultError("drive_fault", "the motor does not come on (MO=1, SR bit 4)")
            link.clock.sleep_until(link.clock.now() + min(0.02, _CYCLES * self.options.heartbeat))
        self._beat()
        link.ask(_ZERO)
        self._beat()

    def _beat(self) -> None:
        """Send our heartbeat."""
        self._link.send(self._heartbeat_id, b"\x05")

    def read(self, timeout: float) -> DriveSample:
        """Position, current and sensor at a SYNC."""
        link, seen = self._link, self._seen
        end = link.clock.now() + timeout
        link.read_waiting()
        self._settle(timeout)
        asked = self._asked = link.clock.now()
        seen.begin()
        link.watch.sent(link.send(canopen.SYNC, b""))
        source = self.options.torque
        self._ask_analog_in_turn()
        self._cycle += 1
        self._answered(end - asked)
        self._look_alive()
        return DriveSample(
            time=link.watch.sampled,
            position=seen.position,
            reading=seen.reading,
            fresh=seen.fresh or source is None,
            clipped=seen.clipped,
            current=seen.current,
            torque=seen.current * self._per_ampere,
        )

    def command(self, torque: float) -> float:
        """Send a torque, and our heartbeat."""
        current = max(-self._peak, min(self._peak, torque / self._per_ampere))
        kept = self._kept(current)
        self._link.send(self._command_id, Command(letters="TC", value=kept).payload())
        self._beat()
        return kept * self._per_ampere

    def _kept(self, current: float) -> float:
        """What the drive keeps of a command [A]: never more than was asked for."""
        if self.options.mantissa_bits < 24:
            mantissa, exponent = math.frexp(current)
            steps = math.trunc(math.ldexp(mantissa, self.options.mantissa_bits))
            return math.ldexp(steps, exponent - self.options.mantissa_bits)
        return float(struct.unpack("<f", struct.pack("<f", current))[0])

    def disable(self) -> DriveEnd:
        """TC = 0, then MO = 0, again in each cycle until the drive confirms that its motor is off.

        A drive that is never reached stops by itself, because our heartbeat stays away.
        """
        if not self._found_off:
            return DriveEnd()  # another program moves its motor
        link, register = self._link, None
        end = link.clock.now() + _SEEN_OFF
        tries, pause = 0, self._period
        while not self._seen_off and link.clock.now() < end:
            self._try(self._command_id, _ZERO.payload())
            self._try(self._command_id, _OFF.payload())
            register = link.number("SR", pause)
            self._seen_off = register is not None and not DriveStatus.of(register).motor_on
            if register is None:  # it may have restarted, and ignores commands then
                self._try(canopen.NMT, canopen.network(canopen.START, self.options.node))
            tries += 1
            if tries > _SOON:  # a slow drive is not to be flooded
                pause = min(2.0 * pause, 0.02)
        if not self._seen_off:
            return DriveEnd(motor_off=False)
        if register is not None and DriveStatus.of(register).failure:
            self._failure = failure_meaning(link.number("MF", 10.0 * self._period) or 0)
        return DriveEnd(motor_off=True, failure=self._failure)

    def close(self) -> None:
        """Leave the drive pre-operational, its watchdogs disarmed when its motor is off."""
        link = self._link
        link.up = False
        if not self._found_off:
            return
        link.forget_fault()
        try:
            link.drain(0.01)
            link.forget_fault()
            if self._seen_off:
                elmo_setup.disarm_watchdogs(link)
            link.send(canopen.NMT, canopen.network(canopen.PRE_OPERATIONAL, self.options.node))
            link.drain(0.01)
        except DriveFaultError:
            return
        finally:
            self._found_off = self._seen_off = (
                False  # from now on another program may use the drive
            )

    @property
    def command_latency(self) -> float:
        """From sending a command until the drive acts on it [s], estimated."""
        return command_latency(self.options)

    def bus_load(self, period: float) -> float:
        """Share of the bus: SYNC, position, command with echo, both heartbeats, sensor."""
        bits = canopen.bits_on_wire
        total = bits(0) + 3 * bits(8) + bits(1) * (1.0 + period / self.options.drive_heartbeat)
        if isinstance(self.options.torque, SyncedConverter):
            total += bits(4)
        elif isinstance(self.options.torque, AnalogInput):
            total += (bits(4) + bits(8)) / self.options.torque.every
        return total / (self.options.bitrate * period)

    def _refuse_if_motor_on(self, timeout: float | None = None) -> None:
        """Raise if the motor is on, before anything is changed; without an answer the drive is not in use."""
        if timeout is None:
            on = self._status().motor_on
        else:
            register = self._link.number("SR", timeout)
            on = register is not None and DriveStatus.of(register).motor_on
        if on:
            raise DriveFaultError("drive_fault", _IN_USE)

    def _status(self) -> DriveStatus:
        return DriveStatus.of(int(self._link.ask(Command(letters="SR")).value))

    def _try(self, identifier: int, payload: bytes) -> None:
        try:
            self._link.send(identifier, payload)
        except Exception:  # after any error of a bus the next command is tried
            return  # again in the next round; in the end the drive's own watchdog stops it

    def _ask_analog_in_turn(self) -> None:
        """Ask for the torque sensor in every few cycles; the answer may take some cycles, but not many."""
        source = self.options.torque
        if not isinstance(source, AnalogInput) or self._cycle % source.every:
            return
        self._unread = self._unread + 1 if self._seen.readings == self._read else 0
        self._read = self._seen.readings
        if self._unread > _UNREAD:
            raise DriveFaultError(
                "sensor",
                f"the drive's analog input {source.number} was asked for {self._unread} times in a row "
                "without an answer",
                measured=self._unread,
                allowed=_UNREAD,
            )
        self._link.command(Command(letters="AN", index=source.number))

    def _look_alive(self) -> None:
        """Check the drive's heartbeat after the answer to a SYNC: earlier heartbeats have been read."""
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
        """Wait for the answer to the last SYNC before the next: an answer does not name its SYNC."""
        if self._seen.complete:
            return
        if self._link.clock.now() - self._asked > _LOST * self._period:
            self._seen.forget()
        else:
            self._answered(timeout)
