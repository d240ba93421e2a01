"""Objects of an Elmo drive that a session sets: position at each SYNC, heartbeats in both directions."""

from __future__ import annotations

from jointid.hardware.can.canopen_frames import SdoAbortError, SdoRequest
from jointid.hardware.elmo.link import ElmoLink
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.session.drive import DriveFaultError
from jointid.hardware.session.drive_report import Reported

_Write = tuple[int, int, int, int]  # index, subindex, value, size
_EMERGENCIES = (
    0x188  # events of 2F21h that a session needs: heartbeat, motor failure, command refused
)


def map_position(link: ElmoLink, options: ElmoOptions) -> None:
    """Map position and torque into the fourth PDO, sent at each SYNC. The PDO is off while it is mapped."""
    cob = options.position_id
    _write(
        link,
        (0x1803, 1, 0xC0000000 | cob, 4),
        (0x1A03, 0, 0, 1),
        (0x1803, 2, 1, 1),
        (0x1A03, 1, 0x60640020, 4),
        (0x1A03, 2, 0x60770010, 4),
        (0x1A03, 0, 2, 1),
        (0x1803, 1, cob, 4),
    )


def arm_watchdogs(link: ElmoLink, options: ElmoOptions) -> None:
    """Set the drive to stop when our heartbeat is missing, and to send its own heartbeat.

    Raises
    ------
    DriveFaultError
        The drive refuses an object, or has another value afterwards.
    """
    _write(
        link,
        (0x1016, 1, options.master_node << 16 | round(1e3 * options.heartbeat), 4),
        (0x1017, 0, round(1e3 * options.drive_heartbeat), 2),
        (0x6007, 0, 2, 2),
        (0x1029, 1, 1, 1),
        (0x2F21, 0, _object(link, 0x2F21, 0) | _EMERGENCIES, 2),
    )
    for each in watchdog_objects(link, options):
        if each.differs:
            raise DriveFaultError(
                "drive_fault",
                f"the drive's watchdog is not armed: object {each}; the motor would go on after this program has died",
            )


def watchdog_objects(link: ElmoLink, options: ElmoOptions) -> tuple[Reported, ...]:
    """Return the settings that stop the drive without our heartbeat, read back, with the needed values."""
    watched = options.master_node << 16 | round(1e3 * options.heartbeat)
    emergencies = _object(link, 0x2F21, 0)
    return (
        Reported(
            name="1016h:1",
            meaning=f"heartbeat expected from node {options.master_node}, within {1e3 * options.heartbeat:g} ms",
            value=_hexadecimal(_object(link, 0x1016, 1), 8),
            expected=_hexadecimal(watched, 8),
        ),
        Reported(
            name="1017h",
            meaning="time between two heartbeats of the drive",
            value=_object(link, 0x1017, 0),
            unit="ms",
            expected=round(1e3 * options.drive_heartbeat),
        ),
        Reported(
            name="6007h",
            meaning="reaction to a missing heartbeat (0: none, 2: motor off)",
            value=_object(link, 0x6007, 0),
            expected=2,
        ),
        Reported(
            name="1029h:1",
            meaning="drive state after a missing heartbeat (1: no change, the drive still answers)",
            value=_object(link, 0x1029, 1),
            expected=1,
        ),
        Reported(
            name="2F21h",
            meaning="required emergency messages that are enabled",
            value=_hexadecimal(emergencies & _EMERGENCIES, 3),
            expected=_hexadecimal(_EMERGENCIES, 3),
        ),
    )


def disarm_watchdogs(link: ElmoLink) -> None:
    """Switch off the heartbeat supervision: from now on we send no heartbeat, and this is no failure."""
    _write(link, (0x1016, 1, 0, 4), (0x1017, 0, 0, 2))


def _object(link: ElmoLink, index: int, subindex: int) -> int:
    """Return the value of an object; 0 if the drive refuses."""
    try:
        return int(link.transfer(SdoRequest(index=index, subindex=subindex)))
    except SdoAbortError:
        return 0


def _hexadecimal(value: int, digits: int) -> str:
    return f"{value:0{digits}X}h"


def _write(link: ElmoLink, *objects: _Write) -> None:
    for index, subindex, value, size in objects:
        try:
            link.transfer(SdoRequest(index=index, subindex=subindex, value=value, size=size))
        except SdoAbortError as error:
            raise DriveFaultError("drive_fault", str(error)) from error
