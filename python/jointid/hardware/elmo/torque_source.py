"""Source of the joint's torque sensor signal: a converter on the bus, or the drive's analog input."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, field, fields

from jointid.base.errors import InputError
from jointid.hardware.bench.table import Table


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorScaling:
    """Scaling from voltage to raw reading: full_scale · ((V − centre) / span − zero − cosine · cos(q + start)).

    The defaults are the thesis's bench: 3 V centred on 1.5 V, and a zero that varies with the position.

    Parameters
    ----------
    full_scale : float
        Raw reading at a deflection of `span`.
    centre : float
        Voltage without deflection [V].
    span : float
        Voltage difference between `centre` and full scale [V].
    zero : float
        Offset, as a share of the full scale.
    cosine : float
        Amplitude of the offset that varies with the angle, as a share of the full scale.
    start : float
        Phase of the varying offset [rad].
    """

    full_scale: float = 217.34
    centre: float = 1.5
    span: float = 1.5
    zero: float = 0.0
    cosine: float = 0.0
    start: float = 0.0

    def __post_init__(self) -> None:
        for name in ("full_scale", "span"):
            value = getattr(self, name)
            if value == 0.0 or not math.isfinite(value):
                raise InputError(
                    "a finite number that is not 0 is expected", argument=name, value=value
                )

    def reading(self, voltage: float, position: float) -> float:
        """Return the raw reading."""
        correction = self.zero + self.cosine * math.cos(position + self.start)
        return self.full_scale * ((voltage - self.centre) / self.span - correction)

    def voltage(self, reading: float, position: float) -> float:
        """Return the voltage of a raw reading [V]."""
        correction = self.zero + self.cosine * math.cos(position + self.start)
        return self.centre + self.span * (reading / self.full_scale + correction)


@dataclass(frozen=True, slots=True, kw_only=True)
class SyncedConverter:
    """A node that converts at each SYNC and sends a 32-bit sum of its conversions.

    Parameters
    ----------
    identifier : int
        COB-ID of its frame. Default 0x1C0.
    bits : int
        Resolution of the converter.
    lowest, highest : float
        Its range [V].
    conversions : int
        Number of conversions in one sum.
    scaling : SensorScaling
    """

    identifier: int = 0x1C0
    bits: int = 12
    lowest: float = 0.0
    highest: float = 3.0
    conversions: int = 128
    scaling: SensorScaling = field(default_factory=SensorScaling)

    def __post_init__(self) -> None:
        if not 0x81 <= self.identifier <= 0x7FF:
            raise InputError(
                f"0x{self.identifier:X} is not a valid identifier; 0x081 to 0x7FF is expected",
                argument="identifier",
            )
        if not 1 <= self.conversions <= 2**16:
            raise InputError(
                "1 to 65536 is expected", argument="conversions", value=self.conversions
            )
        if not 1 <= self.bits <= 24:
            raise InputError("1 to 24 is expected", argument="bits", value=self.bits)
        if not self.lowest < self.highest:
            raise InputError(
                f"a voltage below highest ({self.highest!r} V) is expected",
                argument="lowest",
                value=self.lowest,
            )

    def voltage(self, payload: bytes) -> float:
        """Return the mean voltage of a frame [V].

        Raises
        ------
        InputError
            The frame is too short.
        """
        if len(payload) < 4:
            raise InputError(
                f"a converter's frame has {len(payload)} bytes; at least 4 are expected"
            )
        total = float(struct.unpack_from("<i", payload)[0])
        share = (total + 0.5) / self.conversions / (1 << self.bits)
        return self.lowest + share * (self.highest - self.lowest)

    def clipped(self, voltage: float) -> bool:
        """Return whether a voltage is at the end of the range."""
        step = (self.highest - self.lowest) / (1 << self.bits)
        return not self.lowest + 2.0 * step < voltage < self.highest - 2.0 * step


@dataclass(frozen=True, slots=True, kw_only=True)
class AnalogInput:
    """The drive's own analog input, queried every few cycles.

    Parameters
    ----------
    number : int
        1 or 2, for AN[1] or AN[2].
    lowest, highest : float
        Range of the input [V].
    every : int
        Cycles between two queries. A query in each cycle would load bus and drive too much.
    scaling : SensorScaling
    """

    number: int = 1
    lowest: float = -10.0
    highest: float = 10.0
    every: int = 4
    scaling: SensorScaling = field(default_factory=SensorScaling)

    def __post_init__(self) -> None:
        if self.number not in (1, 2):
            raise InputError("1 or 2 is expected", argument="number", value=self.number)
        if not 1 <= self.every <= 1000:
            raise InputError("1 to 1000 is expected", argument="every", value=self.every)
        if not self.lowest < self.highest:
            raise InputError(
                f"a voltage below highest ({self.highest!r} V) is expected",
                argument="lowest",
                value=self.lowest,
            )

    def clipped(self, voltage: float) -> bool:
        """Return whether a voltage is at the end of the range."""
        margin = 1e-3 * (self.highest - self.lowest)
        return not self.lowest + margin < voltage < self.highest - margin


_SOURCES: dict[str, type | None] = {
    "converter": SyncedConverter,
    "analog": AnalogInput,
    "none": None,
}


def read_torque_source(table: Table) -> SyncedConverter | AnalogInput | None:
    """Return the source of the torque sensor's signal from the table `[session.torque]`.

    Raises
    ------
    InputError
        A key is unknown or its value cannot be used.
    """
    kind = _SOURCES[table.choice("source", "converter", _SOURCES)]
    scale = {item.name for item in fields(SensorScaling)}
    scaling = table.without(*({*table.entries} - scale)).make(SensorScaling)
    if kind is None:
        for name in table.without("source").entries:
            table.refuse(name, "this key is not expected, because source is 'none'")
        return None
    rest = table.without("source", *scale)
    if kind is SyncedConverter:
        return rest.make(SyncedConverter, scaling=scaling)
    return rest.make(AnalogInput, scaling=scaling)
