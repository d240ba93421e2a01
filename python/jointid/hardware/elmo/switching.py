"""Switch an Elmo drive's motor on, watched by our heartbeat, and off, by all available commands."""

from __future__ import annotations

import math

from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.codec import Command
from jointid.hardware.elmo.errors import DriveStatus, failure_meaning
from jointid.hardware.elmo.link import ElmoLink
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.session.drive import DriveEnd, DriveFaultError

CYCLES = 1.0 / 3.0  # share of the drive's heartbeat timeout: one heartbeat may be lost
_ENABLE = 3.0  # [s] to wait for the motor: commutation and brake take their time
_LOOK = 0.02  # [s] between two queries of the motor state
_SEEN_OFF = 0.2  # [s], longest time to try to switch off
_SOON = 3  # number of tries in consecutive cycles
_NETWORK = 2  # tries after which the network is stopped, too
_CONTROL, _STATUS = 0x6040, 0x6041  # words of CiA 402
_SWITCHED_ON, _OPERATION = 0x02, 0x04  # bits of the status word
ZERO, OFF = Command(letters="TC", value=0.0), Command(letters="MO", value=0)


class MotorSwitch:
    """Switches the motor on and off.

    Parameters
    ----------
    link : ElmoLink
    options : ElmoOptions
    """

    def __init__(self, link: ElmoLink, options: ElmoOptions) -> None:
        self._link, self._options = link, options
        self._heartbeat_id = canopen.heartbeat_id(options.master_node)
        self._beaten = -math.inf
        self.seen_off = False
        self._failure = ""

    def forget(self) -> None:
        """Reset the state for another drive, or after use by another program."""
        self.seen_off, self._failure = False, ""

    def beat(self) -> None:
        """Send our heartbeat."""
        self._beaten = self._link.send(self._heartbeat_id, b"\x05")

    def on(self) -> None:
        """Switch the motor on at zero torque. Our heartbeat starts before and continues meanwhile.

        Raises
        ------
        DriveFaultError
            The motor does not come on.
        """
        link = self._link
        self.seen_off = False
        link.echoes.end()
        self.beat()
        end = link.clock.now() + _ENABLE
        link.ask(Command(letters="MO", value=1), _ENABLE, meanwhile=self._beat_in_time)
        while not self._status().motor_on:
            if link.clock.now() > end:
                raise DriveFaultError(
                    "drive_fault", "the motor does not switch on (MO=1, SR bit 4)"
                )
            link.clock.sleep_until(link.clock.now() + self._beat_in_time())
        link.ask(ZERO, meanwhile=self._beat_in_time)
        self.beat()  # restart the timeout before the first cycle
        link.echoes.begin()

    def off(self, period: float) -> DriveEnd:
        """Send TC = 0 and MO = 0 in each cycle [s] until the drive confirms that its motor is off.

        Without a confirmation, send the control word 6040h by SDO, then an NMT stop. A drive that cannot be
        reached stops on its own watchdog, because our heartbeat is missing.
        """
        link = self._link
        link.echoes.end()
        if self.seen_off:
            return DriveEnd(state="off", failure=self._failure)
        end = link.clock.now() + _SEEN_OFF
        tries, pause = 0, period
        register: int | None = None
        while not self.seen_off and link.clock.now() < end:
            self._try(self._options.command_id, ZERO.payload())
            self._try(self._options.command_id, OFF.payload())
            register = self._register("SR", pause)
            self.seen_off = register is not None and not DriveStatus.of(register).motor_on
            if tries and not self.seen_off:
                self._otherwise(pause, last=tries >= _NETWORK)
            if register is None:  # it may have restarted, and ignores commands then
                self._network(canopen.START)
            tries += 1
            if tries > _SOON:  # do not flood a slow drive
                pause = min(2.0 * pause, 0.02)
        if not self.seen_off:
            return DriveEnd(state="on")
        if register is None or DriveStatus.of(register).failure:
            self._failure = failure_meaning(self._register("MF", 10.0 * period) or 0)
        return DriveEnd(state="off", failure=self._failure)

    def _otherwise(self, pause: float, *, last: bool) -> None:
        """Switch off without the interpreter: send "disable voltage" by SDO and, at the end, an NMT stop."""
        link, request = self._link, 0x600 + self._options.node
        stop = canopen.SdoRequest(index=_CONTROL, subindex=0, value=0, size=2)
        self._try(request, stop.payload())
        status = link.object_value(canopen.SdoRequest(index=_STATUS, subindex=0), pause)
        self.seen_off = status is not None and not status & (_SWITCHED_ON | _OPERATION)
        if last and not self.seen_off:
            self._network(canopen.STOP)
            link.clock.sleep_until(link.clock.now() + pause)
            self._network(canopen.START)  # only an operational drive answers

    def _status(self) -> DriveStatus:
        register = self._link.ask(Command(letters="SR"), meanwhile=self._beat_in_time).value
        return DriveStatus.of(int(register))

    def _register(self, letters: str, timeout: float) -> int | None:
        value = self._link.number(letters, timeout)
        return None if value is None else int(value)

    def _beat_in_time(self) -> float:
        """Send our heartbeat if it is due. Return the time until the next [s]."""
        every = min(_LOOK, CYCLES * self._options.heartbeat)
        now = self._link.clock.now()
        if now - self._beaten >= every:
            self.beat()
        return every

    def _network(self, command: int) -> None:
        self._try(canopen.NMT, canopen.network(command, self._options.node))

    def _try(self, identifier: int, payload: bytes) -> None:
        try:
            self._link.send(identifier, payload)
        except Exception:  # try the next command after any error of the bus
            return  # the next round tries again; finally the drive's own watchdog stops it
