"""A CAN bus opened for a session: only the frames that it needs, and errors that name the remedy."""

from __future__ import annotations

import errno
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError

if TYPE_CHECKING:
    import can

_NETWORKS = Path("/sys/class/net")
_IS_UP = 0x1  # IFF_UP


@contextmanager
def open_bus(
    *,
    interface: str = "socketcan",
    channel: str | None = "can0",
    bitrate: int = 500_000,
    identifiers: Iterable[int] | None = None,
) -> Iterator[can.BusABC]:
    """Open a CAN bus; it is shut down at the end.

    With SocketCAN the kernel passes on only the frames with the identifiers that are asked for: its queue
    holds some 280 frames, and drops the rest without an error. On other interfaces python-can would
    filter in Python and drop error frames too, so there the drive does the sorting.

    Parameters
    ----------
    interface, channel : str
        As python-can names them: "socketcan" and "can0", "pcan" and "PCAN_USBBUS1", "virtual", …
    bitrate : int
        [bit/s]. SocketCAN's is set with the interface (`ip link`). Default 500 000.
    identifiers : iterable of int, optional
        COB-IDs of the frames to receive. Default: all frames.

    Yields
    ------
    can.BusABC

    Raises
    ------
    InputError
        The interface is not known or not installed, the channel does not exist, the network is down.

    Examples
    --------
    >>> with jid.hardware.open_bus(interface="virtual", channel="bench") as bus:  # or "socketcan", "can0"
    ...     print(bus.recv(0.01))
    None
    """
    bus = _opened(interface, channel, bitrate, identifiers)
    try:
        yield bus
    finally:
        bus.shutdown()


def _opened(
    interface: str, channel: str | None, bitrate: int, identifiers: Iterable[int] | None
) -> can.BusABC:
    if interface == "emulated":
        raise InputError(
            "python-can has no such interface: an emulated bench is an EmulatedBus, or an EmulatorThread "
            "on the interface 'virtual'",
            argument="interface",
            value=interface,
        )
    try:
        import can
    except ModuleNotFoundError as error:
        raise InputError(
            "python-can is not installed; pip install python-can",
            argument="interface",
            value=interface,
        ) from error
    if not channel:
        raise InputError(
            "missing; a name such as 'can0' is expected", argument="channel", value=channel
        )
    if not 10_000 <= bitrate <= 1_000_000:
        raise InputError("10 000 to 1 000 000 bit/s is expected", argument="bitrate", value=bitrate)
    if interface not in can.VALID_INTERFACES:
        raise InputError(
            f"known are {', '.join(sorted(can.VALID_INTERFACES))}",
            argument="interface",
            value=interface,
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
        # Each of python-can's interfaces has errors of its own.
        raise InputError(
            _reason(error), argument="channel", value=channel, place=f"interface {interface!r}"
        ) from error


def _check_network(channel: str, bitrate: int) -> None:
    """Linux opens a network that is down without an error, and fails at the first frame."""
    flags = _NETWORKS / channel / "flags"
    if not _NETWORKS.is_dir():
        return
    if not flags.is_file():
        raise InputError(
            "there is no such network; is the adapter plugged in? `ip link` lists the networks",
            argument="channel",
            value=channel,
        )
    if not int(flags.read_text(), 16) & _IS_UP:
        raise InputError(
            "the network is down; bring it up with "
            f"`sudo ip link set {channel} up type can bitrate {bitrate}`",
            argument="channel",
            value=channel,
        )


def _reason(error: Exception) -> str:
    code = getattr(error, "errno", None)
    if code == errno.EAFNOSUPPORT:
        return "the kernel has no CAN (`sudo modprobe can_raw` loads it where it is available)"
    if code == errno.ENODEV:
        return "there is no such channel; `ip link` lists the networks"
    if code in (errno.EACCES, errno.EPERM):
        return "not permitted; is the user in the group that may use the device?"
    return f"it cannot be opened: {' '.join(str(error).split()) or type(error).__name__}"
