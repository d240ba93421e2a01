"""A CAN bus opened for a session: only the frames that it needs, and errors that say what to do."""

from __future__ import annotations

import errno
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import SyncedConverter

if TYPE_CHECKING:
    import can

_NETWORKS = Path("/sys/class/net")
_IS_UP = 0x1  # IFF_UP


def needed_identifiers(drive: ElmoOptions) -> tuple[int, ...]:
    """COB-IDs of the frames that a session receives: replies, position, emergency, boot-up, SDO, sensor."""
    node = drive.node
    found = [
        drive.reply_id,
        drive.position_id,
        canopen.emergency_id(node),
        canopen.heartbeat_id(node),
        0x580 + node,
    ]
    if isinstance(drive.torque, SyncedConverter):
        found.append(drive.torque.identifier)
    return tuple(sorted(set(found)))


@contextmanager
def open_bus(
    *,
    interface: str = "socketcan",
    channel: str | None = "can0",
    bitrate: int = 500_000,
    node: int | None = None,
    drive: ElmoOptions | None = None,
) -> Iterator[can.BusABC]:
    """Open a bus for an `ElmoDrive`; it is shut down at the end.

    With SocketCAN the kernel keeps away all frames but those of `needed_identifiers`: its queue holds
    some 280 frames, and what does not fit vanishes without a word. On other interfaces python-can would
    filter in Python and swallow error frames with the rest, so there the drive does the sorting.

    Parameters
    ----------
    interface, channel : str
        As python-can names them: "socketcan" and "can0", "pcan" and "PCAN_USBBUS1", "virtual", …
    bitrate : int
        [bit/s]. SocketCAN's is set with the interface (`ip link`). Default 500 000.
    node : int, optional
        Of the drive; short for `drive=ElmoOptions(node=node)`.
    drive : ElmoOptions, optional
        With the COB-IDs. Default `ElmoOptions()`.

    Yields
    ------
    can.BusABC

    Raises
    ------
    InputError
        The interface is not known or not installed, the channel is not there, the network is down.
    """
    if node is not None:
        if drive is not None:
            raise InputError(
                "open_bus: give node or drive, not both; a drive's options have its node"
            )
        drive = ElmoOptions(node=node)
    options = drive if drive is not None else ElmoOptions()
    bus = _opened(interface, channel, bitrate, needed_identifiers(options))
    try:
        yield bus
    finally:
        bus.shutdown()


@contextmanager
def open_whole_bus(
    *, interface: str = "socketcan", channel: str | None = "can0", bitrate: int = 500_000
) -> Iterator[can.BusABC]:
    """Open a bus for those that want all its frames, e.g. emulated devices; arguments as in `open_bus`.

    Yields
    ------
    can.BusABC

    Raises
    ------
    InputError
        As in `open_bus`.
    """
    bus = _opened(interface, channel, bitrate, None)
    try:
        yield bus
    finally:
        bus.shutdown()


def _opened(
    interface: str, channel: str | None, bitrate: int, identifiers: Iterable[int] | None
) -> can.BusABC:
    if interface == "emulated":
        raise InputError(
            "interface 'emulated' is not a bus of python-can's: an emulated bench is an EmulatedBus of "
            "jointid.hardware.emulated.bus, or an EmulatorThread on interface 'virtual'"
        )
    try:
        import can
    except ModuleNotFoundError as error:
        raise InputError(
            f"interface {interface!r}: python-can is not installed; pip install python-can"
        ) from error
    if not channel:
        raise InputError(
            f"interface {interface!r}: the channel is missing; e.g. 'can0' is expected"
        )
    if not 10_000 <= bitrate <= 1_000_000:
        raise InputError(f"bitrate is {bitrate!r}; 10 000 to 1 000 000 bit/s is expected")
    if interface not in can.VALID_INTERFACES:
        raise InputError(
            f"interface {interface!r} is unknown; one of {', '.join(sorted(can.VALID_INTERFACES))} is expected"
        )
    settings: dict[str, Any] = {}
    if interface == "socketcan":
        _check_network(channel, bitrate)
        if identifiers is not None:
            settings["can_filters"] = [
                {"can_id": identifier, "can_mask": 0x7FF, "extended": False}
                for identifier in identifiers
            ]
    elif interface not in ("virtual", "udp_multicast", "socketcand"):
        settings["bitrate"] = bitrate
    try:
        return can.Bus(channel, interface=interface, **settings)
    except (can.CanError, OSError, ImportError, ValueError, RuntimeError) as error:
        raise InputError(_sentence(interface, channel, error)) from error


def _check_network(channel: str, bitrate: int) -> None:
    """Linux opens a network that is down without a word, and fails at the first frame."""
    flags = _NETWORKS / channel / "flags"
    if not _NETWORKS.is_dir():
        return
    if not flags.is_file():
        raise InputError(
            f"channel {channel!r}: there is no such network; is the adapter plugged in? "
            "`ip link` lists what there is"
        )
    if not int(flags.read_text(), 16) & _IS_UP:
        raise InputError(
            f"channel {channel!r}: the network is down; bring it up with "
            f"`sudo ip link set {channel} up type can bitrate {bitrate}`"
        )


def _sentence(interface: str, channel: str, error: Exception) -> str:
    begin = f"interface {interface!r}, channel {channel!r}"
    code = getattr(error, "errno", None)
    if code == errno.EAFNOSUPPORT:
        return f"{begin}: this machine's kernel has no CAN (`sudo modprobe can_raw` loads it where it can be had)"
    if code == errno.ENODEV:
        return f"{begin}: there is no such channel; `ip link` lists what there is"
    if code in (errno.EACCES, errno.EPERM):
        return f"{begin}: not permitted; is the user in the group that may use the device?"
    return f"{begin}: it cannot be opened: {' '.join(str(error).split()) or type(error).__name__}"
