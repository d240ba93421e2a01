"""CAN bus of a session: it receives only the necessary frames, and its errors name the remedy."""

from __future__ import annotations

import errno
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.joint.checks import suggestion

if TYPE_CHECKING:
    import can

_NETWORKS = Path("/sys/class/net")
_IS_UP = 0x1  # IFF_UP
_FD_SIZE = 72  # bytes of a CAN FD frame in Linux
_FASTEST = 8_000_000  # [bit/s], for the data of CAN FD
_HIGHEST, _ALL_BITS = 0x7FF, 0x1FFFFFFF  # identifiers of 11 and of 29 bits


@contextmanager
def open_bus(
    *,
    interface: str = "socketcan",
    channel: str | None = "can0",
    bitrate: int = 500_000,
    identifiers: Iterable[int] | None = None,
    extended: bool = False,
    fd: bool = False,
    data_bitrate: int | None = None,
) -> Iterator[can.BusABC]:
    """Open a CAN bus, and shut it down at the end.

    With SocketCAN, the kernel filters frames by `identifiers`. The kernel's queue holds about 280 frames and drops
    further frames without an error. On other interfaces, python-can would filter in Python and also drop error
    frames. There, the drive filters the frames.

    Parameters
    ----------
    interface, channel : str
        Names in python-can: "socketcan" and "can0", "pcan" and "PCAN_USBBUS1", "virtual", …
    bitrate : int
        Bit rate [bit/s]. For SocketCAN, set it with `ip link`. Default 500 000.
    identifiers : iterable of int, optional
        Identifiers of the frames to receive. Default: all frames.
    extended : bool
        Whether all `identifiers` have 29 bits. Default False: identifiers up to 7FFh have 11 bits.
    fd : bool
        Whether to allow CAN FD frames. Default False.
    data_bitrate : int, optional
        Bit rate of the data in CAN FD frames [bit/s]. For SocketCAN, set it with `ip link`. Default: `bitrate`.

    Yields
    ------
    can.BusABC

    Raises
    ------
    InputError
        The interface is unknown or not installed, the channel does not exist, or the network is down.

    Examples
    --------
    >>> with jid.hardware.open_bus(interface="virtual", channel="bench") as bus:  # or "socketcan", "can0"
    ...     print(bus.recv(0.01))
    None
    """
    check_bitrates(bitrate, fd=fd, data_bitrate=data_bitrate)
    filters = None
    if identifiers is not None:
        filters = [_filter(identifier, extended) for identifier in identifiers]
    bus = _opened(interface, channel, bitrate, filters, (data_bitrate or bitrate) if fd else None)
    try:
        yield bus
    finally:
        bus.shutdown()


def check_interface(interface: str) -> None:
    """Check that python-can knows an interface, if python-can is installed.

    Raises
    ------
    InputError
        The interface is unknown.
    """
    if interface == "emulated":
        reason = (
            "python-can has no such interface; for an emulated bench use an EmulatedBus, or an "
            "EmulatorThread on the interface 'virtual'"
        )
        raise InputError(reason, argument="interface", value=interface)
    try:
        import can
    except ModuleNotFoundError:
        return
    if interface not in can.VALID_INTERFACES:
        reason = suggestion(interface, sorted(can.VALID_INTERFACES))
        raise InputError(reason, argument="interface", value=interface)


def check_bitrates(bitrate: int, *, fd: bool, data_bitrate: int | None) -> None:
    """Check that a bus can have these bit rates.

    Raises
    ------
    InputError
        A bit rate is not possible.
    """
    if not 10_000 <= bitrate <= 1_000_000:
        raise InputError("10 000 to 1 000 000 bit/s is expected", argument="bitrate", value=bitrate)
    if data_bitrate is None:
        return
    if not fd:
        raise InputError(
            "classic CAN (fd = false) has no data bit rate",
            argument="data_bitrate",
            value=data_bitrate,
            remedy="state fd = true for CAN FD",
        )
    if not bitrate <= data_bitrate <= _FASTEST:
        raise InputError(
            f"a value from {bitrate} (bitrate) to {_FASTEST} bit/s is expected",
            argument="data_bitrate",
            value=data_bitrate,
        )


def _filter(identifier: int, extended: bool) -> dict[str, Any]:
    """Return the filter that passes one identifier. An identifier above 7FFh has 29 bits in any case."""
    long = extended or identifier > _HIGHEST
    return {"can_id": identifier, "can_mask": _ALL_BITS if long else _HIGHEST, "extended": long}


def _opened(
    interface: str,
    channel: str | None,
    bitrate: int,
    filters: list[dict[str, Any]] | None,
    data_bitrate: int | None,
) -> can.BusABC:
    check_interface(interface)
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
    settings: dict[str, Any] = {}
    if interface == "socketcan":
        _check_network(channel, bitrate, data_bitrate)
        if filters is not None:
            settings["can_filters"] = filters
    elif interface not in ("virtual", "udp_multicast", "socketcand"):
        settings["bitrate"] = bitrate
    if data_bitrate is not None:
        settings |= _fd_settings(interface, bitrate, data_bitrate)
    try:
        return can.Bus(channel, interface=interface, **settings)
    except (can.CanError, OSError, ImportError, ValueError, RuntimeError) as error:
        # Each interface of python-can raises its own errors.
        raise InputError(
            _reason(error), argument="channel", value=channel, place=f"interface {interface!r}"
        ) from error


def _fd_settings(interface: str, bitrate: int, data_bitrate: int) -> dict[str, Any]:
    """Return the settings for CAN FD of a python-can interface."""
    import can

    if interface in ("socketcan", "udp_multicast"):
        return {"fd": True}
    if interface == "virtual":
        return {"protocol": can.CanProtocol.CAN_FD}
    if interface == "pcan":  # it accepts no bit rates
        timing = can.BitTimingFd.from_sample_point(
            f_clock=80_000_000,
            nom_bitrate=bitrate,
            nom_sample_point=80.0,
            data_bitrate=data_bitrate,
            data_sample_point=80.0,
        )
        return {"timing": timing}
    return {"fd": True, "data_bitrate": data_bitrate}


def _check_network(channel: str, bitrate: int, data_bitrate: int | None) -> None:
    """Check that the network is up. Linux opens a network that is down, and fails only at the first frame."""
    up = f"sudo ip link set {channel} up type can bitrate {bitrate}"
    if data_bitrate is not None:
        up += f" dbitrate {data_bitrate} fd on"
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
            "the network is down",
            argument="channel",
            value=channel,
            remedy=f"start it with `{up}`",
        )
    size = _NETWORKS / channel / "mtu"
    if data_bitrate is not None and size.is_file() and int(size.read_text()) < _FD_SIZE:
        down = f"sudo ip link set {channel} down"
        controller = (_NETWORKS / channel / "device").exists()
        other = f"{down} && {up}" if controller else f"sudo ip link set {channel} mtu {_FD_SIZE}"
        raise InputError(
            "CAN FD is not enabled on this network",
            argument="channel",
            value=channel,
            remedy=f"enable CAN FD with `{other}`",
        )


def _reason(error: Exception) -> str:
    code = getattr(error, "errno", None)
    if "msgpack" in str(error):
        return "python-can needs msgpack for this interface; pip install msgpack"
    if code == errno.EAFNOSUPPORT:
        return "the kernel has no CAN (if available, `sudo modprobe can_raw` loads the module)"
    if code == errno.ENODEV:
        return "there is no such channel; `ip link` lists the networks"
    if code in (errno.EACCES, errno.EPERM):
        return "access denied; is your user in the group of the device?"
    return f"it cannot be opened: {' '.join(str(error).split()) or type(error).__name__}"
