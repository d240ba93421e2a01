"""Objects of an Elmo drive that a session sets: position at each SYNC, heartbeats both ways."""

from __future__ import annotations

from jointid.hardware.can.canopen_frames import SdoAbortError, SdoRequest
from jointid.hardware.elmo.link import ElmoLink
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.session.drive import DriveFaultError

_Write = tuple[int, int, int, int]  # index, subindex, value, size


def identity(link: ElmoLink) -> dict[str, str]:
    """Identity of the drive, from object 1018h."""
    found = {}
    for name, subindex in (("vendor", 1), ("product", 2), ("revision", 3)):
        try:
            value = link.transfer(SdoRequest(index=0x1018, subindex=subindex))
        except SdoAbortError:
            continue
        found[name] = f"0x{value:X}"
    return found


def map_position(link: ElmoLink, options: ElmoOptions) -> None:
    """Position and torque in the fourth PDO, at each SYNC: off, mapped, on."""
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
    """Let the drive stop by itself when our heartbeat is missing, and send its own."""
    _write(
        link,
        (0x1016, 1, link.master << 16 | round(1e3 * options.heartbeat), 4),
        (0x1017, 0, round(1e3 * options.drive_heartbeat), 2),
        (0x6007, 0, 2, 2),
        (0x1029, 1, 1, 1),
        (0x2F21, 0, _object(link, 0x2F21, 0) | 0x188, 2),
    )


def disarm_watchdogs(link: ElmoLink) -> None:
    """From now on no heartbeat is sent, which is no failure."""
    _write(link, (0x1016, 1, 0, 4), (0x1017, 0, 0, 2))


def _object(link: ElmoLink, index: int, subindex: int) -> int:
    """Value of an object; 0 when the drive refuses to give it."""
    try:
        return int(link.transfer(SdoRequest(index=index, subindex=subindex)))
    except SdoAbortError:
        return 0


def _write(link: ElmoLink, *objects: _Write) -> None:
    for index, subindex, value, size in objects:
        try:
            link.transfer(SdoRequest(index=index, subindex=subindex, value=value, size=size))
        except SdoAbortError as error:
            raise DriveFaultError("drive_fault", str(error)) from error
