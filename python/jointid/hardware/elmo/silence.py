"""Stop our heartbeat on purpose to test an Elmo drive's own watchdog."""

from __future__ import annotations

from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.errors import DriveStatus, Emergency, failure_meaning
from jointid.hardware.elmo.link import HOST_HEARTBEAT, ElmoLink
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.switching import CYCLES, MotorSwitch
from jointid.hardware.session.drive import DriveFaultError
from jointid.hardware.session.silence import DriveSilence

_LISTENED = 2.0  # multiple of the drive's watchdog time
_ANSWER = 0.05  # [s] for a register
_MISSED = "heartbeat lost"  # text of `failure_meaning`


def fall_silent(link: ElmoLink, options: ElmoOptions, switch: MotorSwitch) -> DriveSilence:
    """Send nothing for twice the drive's watchdog time, then read its state. The motor must be on.

    The times come from the frames: our last heartbeat and the drive's emergency.

    Parameters
    ----------
    link : ElmoLink
    options : ElmoOptions
    switch : MotorSwitch

    Raises
    ------
    DriveFaultError
        The motor is off at the start, or the drive reports another fault.
    """
    beaten: list[float] = []
    told: list[float] = []
    ours, theirs = (
        canopen.heartbeat_id(options.master_node),
        canopen.emergency_id(options.node),
    )
    before = link.tap

    def watch(when: float, identifier: int, payload: bytes, sent: bool) -> None:
        if before is not None:
            before(when, identifier, payload, sent)
        if sent and identifier == ours:
            beaten.append(when)
        elif not sent and identifier == theirs:
            emergency = Emergency.of(payload)
            if emergency is not None and emergency.code == HOST_HEARTBEAT:
                told.append(when)

    link.read_waiting()
    register = link.number("SR", CYCLES * options.heartbeat)
    if register is None or not DriveStatus.of(int(register)).motor_on:
        raise DriveFaultError("drive_fault", "the motor was off before the heartbeat was stopped")
    link.echoes.end()  # no commands are sent from here
    link.tap = watch
    try:
        switch.beat()
        last = beaten[-1]
        link.drain(_LISTENED * options.heartbeat)
        _raise_others(link)
        asked = link.clock.now()
        register = link.number("SR", _ANSWER)
        failure = link.number("MF", _ANSWER)
    finally:
        link.tap = before
    meaning = "" if failure is None else failure_meaning(int(failure))
    return DriveSilence(
        allowed=options.heartbeat,
        state=None
        if register is None
        else "on"
        if DriveStatus.of(int(register)).motor_on
        else "off",
        told=told[0] - last if told else None,
        asked=asked - last,
        missed_host=bool(told) or _MISSED in meaning,
        failure=meaning,
    )


def _raise_others(link: ElmoLink) -> None:
    """Raise a fault other than the expected one."""
    try:
        link.raise_fault()
    except DriveFaultError as fault:
        if fault.kind != "host_heartbeat_lost":
            raise
