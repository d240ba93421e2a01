"""Faults of an emulated bus and of an emulated drive, on demand."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from random import Random

import can

from jointid.base.errors import InputError

# Reasons of a motor shutdown: MF, and the emergency that the drive sends.
DRIVE_FAILURES = {
    "encoder loss": (0x4, 0x7300),
    "peak current": (0x8, 0x8311),
    "host heartbeat lost": (0x800, 0x8130),
    "under-voltage": (0x3000, 0x3120),
    "over-voltage": (0x5000, 0x3310),
    "short circuit": (0xB000, 0x2340),
    "over-temperature": (0xD000, 0x4310),
    "speed limit": (0x20000, 0x8481),
    "motor stuck": (0x200000, 0x7121),
}
BUS_FAULTS = ("drop", "delay", "duplicate", "corrupt", "down", "bus_off")


@dataclass(slots=True, kw_only=True)
class BusFault:
    """One kind of bus fault in a time interval.

    Attributes
    ----------
    kind : str
        Kind of fault. "drop", "delay", "duplicate" and "corrupt" act on frames. "down": the interface is down.
        "bus_off": the controller has left the bus, and its frames are lost.
    start, stop : float
        Start and end of the fault on the bus's clock [s].
    identifier : int, optional
        Identifier of the affected frames. Default: all frames.
    delay : float
        Delay of frames by a "delay" fault [s]. Other frames can overtake these frames.
    probability : float
        Probability that the fault affects a frame. Default 1.
    seed : int
        Seed of the random choice. Default 0.
    """

    kind: str
    start: float
    stop: float = float("inf")
    identifier: int | None = None
    delay: float = 0.0
    reported: bool = False
    probability: float = 1.0
    seed: int = 0
    _random: Random = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if self.kind not in BUS_FAULTS:
            raise InputError(
                f"choose one of {', '.join(BUS_FAULTS)}", argument="kind", value=self.kind
            )
        if not 0.0 <= self.probability <= 1.0:
            raise InputError("0 to 1 is expected", argument="probability", value=self.probability)
        self._random = Random(self.seed)

    def acts(self, now: float) -> bool:
        """Return whether the fault is active now."""
        return self.start <= now < self.stop

    def hits(self, identifier: int, now: float) -> bool:
        """Return whether the fault affects a frame sent now."""
        if not self.acts(now) or self.identifier not in (None, identifier):
            return False
        return self.probability >= 1.0 or self._random.random() < self.probability


def drive_failure(kind: str) -> tuple[int, int]:
    """Return MF and the emergency code of a failure.

    Raises
    ------
    InputError
        There is no failure of this name.
    """
    if kind not in DRIVE_FAILURES:
        raise InputError(f"choose one of {', '.join(DRIVE_FAILURES)}", argument="kind", value=kind)
    return DRIVE_FAILURES[kind]


def error_register(emergency: int) -> int:
    """Return the bits of the error register 1001h for an emergency code (CiA 301)."""
    by_class = {0x2: 0x03, 0x3: 0x05, 0x4: 0x09}  # current, voltage, temperature
    if emergency == 0x8130:
        return 0x11  # communication
    return by_class.get(emergency >> 12, 0x81)  # others: manufacturer-specific


def mangled(
    message: can.Message, faults: Sequence[BusFault], now: float, *, from_host: bool
) -> Iterator[tuple[can.Message, float]]:
    """Return the copies of a frame after the faults, each with its extra delay [s]."""
    copies = [(_copy(message), 0.0)]
    for fault in faults:
        if not fault.hits(message.arbitration_id, now):
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
        is_fd=message.is_fd,
        bitrate_switch=message.bitrate_switch,
        error_state_indicator=message.error_state_indicator,
        dlc=message.dlc,
    )
