"""What can go wrong on an emulated bus, on demand."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import can

from jointid.errors import InputError

BUS_FAULTS = ("drop", "delay", "duplicate", "corrupt", "down", "bus_off")


@dataclass(slots=True, kw_only=True)
class BusFault:
    """One kind of trouble in a stretch of time.

    Attributes
    ----------
    kind : str
        "drop", "delay", "duplicate" or "corrupt" frames; "down": the interface is; "bus_off": the
        controller has left the bus, its frames vanish.
    start, stop : float
        [s] on the bus's clock.
    identifier : int, optional
        Only frames with this identifier. Default: all.
    delay : float
        [s], of "delay".
    """

    kind: str
    start: float
    stop: float = float("inf")
    identifier: int | None = None
    delay: float = 0.0
    told: bool = False

    def __post_init__(self) -> None:
        if self.kind not in BUS_FAULTS:
            raise InputError(
                f"BusFault: kind is {self.kind!r}; one of {', '.join(BUS_FAULTS)} is expected"
            )

    def acts(self, now: float) -> bool:
        """Whether it is on."""
        return self.start <= now < self.stop


def mangled(
    message: can.Message, faults: Sequence[BusFault], now: float, *, from_host: bool
) -> Iterator[tuple[can.Message, float]]:
    """What becomes of a frame: copies of it, each with its extra delay [s]."""
    copies = [(_copy(message), 0.0)]
    for fault in faults:
        if not fault.acts(now) or fault.identifier not in (None, message.arbitration_id):
            continue
        if fault.kind in ("drop", "bus_off", "down"):
            copies = []
        elif fault.kind == "delay":
            copies = [(copy, delay + fault.delay) for copy, delay in copies]
        elif fault.kind == "duplicate":
            copies += [(_copy(message), 0.0)]
        elif fault.kind == "corrupt" and not from_host:
            for copy, _ in copies:
                copy.data = bytearray(byte ^ 0xA5 for byte in copy.data)
    yield from copies


def _copy(message: can.Message) -> can.Message:
    return can.Message(
        arbitration_id=message.arbitration_id,
        data=bytes(message.data),
        is_extended_id=message.is_extended_id,
        is_remote_frame=message.is_remote_frame,
        dlc=message.dlc,
    )
