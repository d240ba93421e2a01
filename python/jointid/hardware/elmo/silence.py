"""Our heartbeat stopped on purpose: what an Elmo drive's own watchdog does."""

from __future__ import annotations

from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.errors import DriveStatus, Emergency, failure_meaning
from jointid.hardware.elmo.link import HOST_HEARTBEAT, ElmoLink
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.switching import CYCLES, MotorSwitch
from jointid.hardware.session.drive import DriveFaultError
from jointid.hardware.session.silence import DriveSilence

_LISTENED = 2.0  # times the drive's patience
_ANSWER = 0.05  # [s] for a register
_MISSED = "heartbeat lost"  # as `failure_meaning` says it


def fall_silent(link: ElmoLink, options: ElmoOptions, switch: MotorSwitch) -> DriveSilence:
    """Send nothing for twice the time of the drive's watchdog, then ask for its state; the motor is on before.

    Times are those of the frames: of our last heartbeat, and of the drive's emergency.

    Parameters
    ----------
    link : ElmoLink
    options : ElmoOptions
    switch : MotorSwitch

    Raises
    ------
    DriveFaultError
        The motor is not on at first, or the drive reports something else.
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
        raise DriveFaultError("drive_fault", "the motor is off before the heartbeat was stopped")
    link.echoes.end()  # of commands: none is sent
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
    """Raise a fault that is not the one awaited."""
    try:
        link.raise_fault()
    except DriveFaultError as fault:
        if fault.kind != "host_heartbeat_lost":
            raise
