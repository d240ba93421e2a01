"""CAN bus of a bench."""

from __future__ import annotations

from dataclasses import dataclass

from jointid.hardware.can.bus import check_bitrates, check_interface


@dataclass(frozen=True, slots=True, kw_only=True)
class BusOptions:
    """Options of a CAN bus, with the names of python-can.

    Attributes
    ----------
    interface : str
        Kind of adapter: "socketcan", "pcan", "kvaser", … Default "socketcan".
    channel : str
        Name of the bus: "can0", "PCAN_USBBUS1", … Default "can0".
    bitrate : int
        Bit rate [bit/s]; for socketcan, set it with `ip link`. Default 500 000.
    fd : bool
        Whether to send and receive CAN FD frames. Default false.
    data_bitrate : int, optional
        Bit rate of the data in CAN FD frames [bit/s]. Default: `bitrate`.
    """

    interface: str = "socketcan"
    channel: str = "can0"
    bitrate: int = 500_000
    fd: bool = False
    data_bitrate: int | None = None

    def __post_init__(self) -> None:
        check_bitrates(self.bitrate, fd=self.fd, data_bitrate=self.data_bitrate)
        if self.interface != "socketcan":  # a bench without a CAN bus needs no python-can
            check_interface(self.interface)
